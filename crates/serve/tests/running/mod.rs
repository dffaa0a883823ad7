//! A service that runs in this process, on a port of its own.

use std::net::{Ipv4Addr, SocketAddr};
use std::path::Path;
use std::sync::mpsc;
use std::thread::JoinHandle;

use vertifleet_core::Stop;
use vertifleet_serve::{Error, Location, Settings, serve};

/// A running service. It stops when it is dropped.
pub(crate) struct Running {
    pub(crate) url: String,
    stop: Stop,
    thread: Option<JoinHandle<Result<(), Error>>>,
}

impl Running {
    /// Starts a service with its data in a folder.
    pub(crate) fn start(folder: &Path) -> Self {
        let listen = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
        let settings = Settings { listen, location: Location::Folder(folder.to_owned()) };
        let stop = Stop::default();
        let heard = stop.clone();
        let (listens, address) = mpsc::channel();
        let run = move || {
            let ready = move |address| listens.send(address).expect("the test waits for it");
            serve(&settings, ready, &heard)
        };
        let thread = std::thread::spawn(run);
        let address: SocketAddr = address.recv().expect("it starts");
        Self { url: format!("http://{address}"), stop, thread: Some(thread) }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.stop.request();
        let outcome = self.thread.take().expect("it has not been stopped before").join();
        if !std::thread::panicking() {
            outcome.expect("no panic").expect("no error");
        }
    }
}
