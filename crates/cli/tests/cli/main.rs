//! Tests of the program as its users run it.

mod board;
mod commands;
mod common;
mod compare_bound;
mod container;
#[cfg(unix)]
mod contents;
mod docs;
mod evaluate;
#[cfg(unix)]
mod full_disk;
mod guide;
mod guide_figures;
#[cfg(unix)]
mod interrupt;
#[cfg(unix)]
mod killed;
#[cfg(unix)]
mod misuse;
#[cfg(unix)]
mod misuses;
mod own_days;
mod own_network;
#[cfg(unix)]
mod piped_files;
mod planning;
mod serve_data;
#[cfg(unix)]
mod serve_demo;
#[cfg(target_os = "linux")]
mod serve_full_disk;
#[cfg(unix)]
mod serve_hostile;
#[cfg(unix)]
mod serve_killed;
mod serve_spans;
mod service;
mod size;
#[cfg(unix)]
mod sweep_killed;
