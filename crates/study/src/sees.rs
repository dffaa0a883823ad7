//! What a policy may look at when it decides: its information class. Only policies of one class
//! compete on equal terms.

use std::fmt;

use serde::{Deserialize, Serialize};

/// The information class of a competitor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sees {
    /// What is there at the decision: demand of the current period, the fleet, stands, prices.
    Present,
    /// The present, the forecast of later demand, and what is known ahead.
    Forecast,
    /// Everything that will happen.
    WholeDay,
    /// Not recorded, as in comparisons that an earlier version saved.
    #[default]
    Unknown,
}

impl fmt::Display for Sees {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Present => "present",
            Self::Forecast => "forecast",
            Self::WholeDay => "whole day",
            Self::Unknown => "n/a",
        })
    }
}
