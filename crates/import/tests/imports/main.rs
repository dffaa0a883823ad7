//! The guarantees of an import: networks from every kind of file, the same on every machine, and
//! errors that name the remedy.

mod any_input;
mod errors;
mod made;
mod network_file;
mod parquet_types;
mod planner;
mod real_files;
mod trips;
mod warnings;
