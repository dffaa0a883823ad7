//! How studies and played days are presented.
//!
//! Each function of this crate turns the results of one kind of study into a [`Report`]: a
//! headline, tables, figures and perhaps a replay. A report has one form for a terminal
//! ([`Report::text`]), one for notebooks ([`Report::tables_html`]), one as a page
//! ([`Report::page`]), one in Markdown ([`Report::markdown`]), and one as a folder ([`folder`]).
//! This crate computes nothing: all numbers come from `vertifleet-study`, which does not depend on
//! it.

mod account;
mod account_tables;
mod board;
mod comparison;
mod comparison_headline;
mod evaluation;
mod explanation;
mod figure;
pub mod folder;
mod markdown;
mod network;
mod page;
mod replay;
mod report;
mod size;
mod size_headline;
mod sweep;
mod sweep_headline;
mod sweep_tables;
mod terminal;

pub use account::{DAY_PAGE, account};
pub use board::board;
pub use comparison::{comparison, comparison_folder};
pub use evaluation::evaluation;
pub use explanation::{EXPLANATION_PAGE, explanation};
pub use figure::Figure;
pub use network::network;
pub use page::REPLAY_FRAME_SCRIPT;
pub use replay::json as replay_json;
pub use report::{DataFile, Files, Place, Report, Section, Table};
pub use size::size;
pub use sweep::sweep;
