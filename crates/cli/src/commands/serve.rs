//! `vertifleet serve`: runs the dispatch service.

use std::process::ExitCode;

use anstream::eprintln;
use vertifleet_serve::{Location, Settings, serve};

use crate::args::ServeArguments;
use crate::failure::Failure;
use crate::interrupt::stop_on_interrupt;

pub(crate) fn run(arguments: &ServeArguments) -> Result<ExitCode, Failure> {
    let stop = stop_on_interrupt()?;
    let location = match &arguments.database {
        Some(url) => Location::Postgres(url.clone()),
        None => Location::Folder(arguments.data.clone()),
    };
    let settings = Settings { listen: arguments.listen, location };
    serve(&settings, |address| eprintln!("listening on http://{address}"), &stop)?;
    Ok(ExitCode::SUCCESS)
}
