//! Played days in the formats of other programs.
