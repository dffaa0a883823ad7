//! The guarantees of an import: networks from every kind of file, the same on every machine, and
//! errors that name the remedy.

mod any_input;
mod demand_tables;
mod errors;
mod foreign_formats;
mod made;
mod network_file;
mod other_units;
mod parquet_types;
#[cfg(unix)]
mod pipes;
mod planner;
mod real_files;
mod strange_trips;
mod trips;
mod warnings;
