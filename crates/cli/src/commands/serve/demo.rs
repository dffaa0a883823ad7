//! `vertifleet serve --demo`: days that a simulated operator plays, to be looked at.

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

/// Seconds of a day that pass in a second.
const SPEED: f64 = 60.0;

/// Runs a service whose data goes when it ends, and an operator whose days never end.
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

/// Operates one day after the other, until it is to stop.
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
            // The service may stop while it is asked.
            Err(_) if stop.is_requested() => break,
            Err(error) => {
                stop.request();
                return Err(error.into());
            }
        }
    }
    Ok(())
}
