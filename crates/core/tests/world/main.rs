//! The guarantees of the project's files: reading, checking, drawing and writing networks and days.

mod any_input;
mod beyond;
mod demand_differences;
mod drawing;
mod energy;
mod errors;
mod files;
mod hopeless_demand;
mod hourly;
mod means;
mod outputs;
mod planning;
mod sources;
mod whole_lists;
