//! Who decides: the [`Policy`] trait, the rules that need no learning, and how a day is played with one.

mod draw;
mod greedy;
mod lookahead;
mod play;
mod policy;
mod random;
mod replay;

pub use draw::draw;
pub use greedy::Greedy;
pub use lookahead::Lookahead;
pub use play::{PlayError, play};
pub use policy::{Policy, PolicyError};
pub use random::Random;
pub use replay::Replay;
