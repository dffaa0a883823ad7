//! Tests of the reports of studies.

mod comparison;
mod day;
mod explain;
mod made_up;
mod size;
mod sweep;
