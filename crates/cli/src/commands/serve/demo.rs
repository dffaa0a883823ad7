//! `vertifleet serve --demo`: days that a simulated operator plays, to be watched.

use std::net::SocketAddr;
use std::sync::Arc;
use std::thread;

use anstream::eprintln;
use vertifleet_core::{DaySeed, Network, Stop};
use vertifleet_serve::{Error, Location, Operation, operate, serve};

use super::settings;
use crate::args::ServeArguments;
use crate::failure::Failure;
use crate::interrupt::stop_on_interrupt;

/// Seconds of the day per second.
const SPEED: f64 = 60.0;

/// Runs a service whose data is deleted at its end, and an operator that plays one day after
/// another.
pub(super) fn run(arguments: &ServeArguments) -> Result<(), Failure> {
    let stop = stop_on_interrupt()?;
    let failed =
        |cause: std::io::Error| Error::Store { cause: format!("a folder for the demo: {cause}") };
    let folder = tempfile::tempdir().map_err(failed)?;
    let settings = settings(arguments, Location::Folder(folder.path().to_owned()));
    let heard = stop.clone();
    let mut operator = None;
    let listens = |address: SocketAddr| {
        eprintln!(
            "listening on http://{address}, with days of New York at {SPEED} times their speed"
        );
        operator = Some(thread::spawn(move || operate_days(address, &heard)));
    };
    serve(&settings, listens, &stop)?;
    match operator.map(thread::JoinHandle::join) {
        Some(Err(panic)) => std::panic::resume_unwind(panic),
        Some(Ok(outcome)) => outcome,
        None => Ok(()),
    }
}

/// Operates one day after the other until it is stopped.
fn operate_days(address: SocketAddr, stop: &Stop) -> Result<(), Failure> {
    let network = Network::shipped("new-york").expect("a shipped network");
    for seed in 1.. {
        let day = Arc::new(network.draw(DaySeed::comparison(seed)?));
        let time_zone = network.time_zone().map(str::to_owned);
        let operation = Operation::new(&format!("http://{address}"), day, "gcaps-x");
        let operation = Operation { time_zone, speed: Some(SPEED), ..operation };
        match operate(&operation, stop, |_, _| ()) {
            Ok(Some(_)) => {}
            Ok(None) => break,
            // The service may stop during a request.
            Err(_) if stop.is_requested() => break,
            Err(error) => {
                stop.request();
                return Err(error.into());
            }
        }
    }
    Ok(())
}
