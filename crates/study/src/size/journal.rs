//! What is kept of every design as soon as it is known, so that a search that ends early goes on
//! where it was.

use serde::{Deserialize, Serialize};
use vertifleet_core::OutputKind;
use vertifleet_sim::DayTotals;

use super::ceiling::Cut;
use super::space::Design;

/// The name of the journal in the folder of a search.
pub const JOURNAL: &str = "designs.jsonl";
pub(super) const FORMAT: &str = "vertifleet-size-designs/1";

/// The beginning of every journal, in any version of the format.
pub const JOURNAL_KIND: OutputKind = OutputKind {
    name: "search for a design",
    skipped: 0,
    opening: "{\"format\":\"vertifleet-size-designs/",
};

/// A line of the journal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Part {
    /// How far each dimension is above its lowest number: for a bound how many things, else how
    /// many steps.
    pub(super) design: Design,
    /// What was found out.
    pub(super) found: Finding,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Finding {
    /// A bound on the mean of what is wanted, for all designs.
    Bound(Cut),
    /// The numbers of the days that were searched on.
    Days(Vec<DayTotals>),
    /// The numbers of the days that follow them.
    Again(Vec<DayTotals>),
}
