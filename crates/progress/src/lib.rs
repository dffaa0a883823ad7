//! Shows the progress of long work on the terminal.

mod bar;
mod days;
mod search;

pub use bar::Bar;
pub use days::Bars;
pub use search::SearchBar;
