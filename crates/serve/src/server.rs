//! The running server: listens until it is stopped.

use std::fs::{File, TryLockError};
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use tokio::sync::watch;
use vertifleet_core::Stop;

use crate::api::router;
use crate::connections::{acceptor, listen, take};
use crate::console::Console;
use crate::error::Error;
use crate::limits::Limits;
use crate::network_folder::network_file_system;
use crate::service::Service;
use crate::spans::Spans;
use crate::store::{Location, Store};

/// Interval at which the request to stop is checked.
const POLL_INTERVAL: Duration = Duration::from_millis(50);
/// After a request to stop, requests in progress have this long to end.
const SHUTDOWN_TIMEOUT: Duration = Duration::from_secs(10);

/// The settings of the service.
#[derive(Debug, Clone)]
pub struct Settings {
    /// The address to listen on.
    pub listen: SocketAddr,
    /// The location of its data.
    pub location: Location,
    /// The protection of connections against eavesdropping.
    pub protection: Protection,
    /// Its limits.
    pub limits: Limits,
    /// The collector of OpenTelemetry that spans of requests are sent to, for example
    /// `http://127.0.0.1:4318`.
    pub collector: Option<String>,
    /// The address of a base map that the console shows in the place of the bundled one: a style of
    /// `MapLibre`, or a file of `PMTiles`.
    pub basemap: Option<String>,
}

/// The protection of connections against eavesdropping.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Protection {
    /// None, which is permitted on this machine alone.
    None,
    /// A proxy in front of the service uses TLS.
    Proxy,
    /// The service uses TLS.
    Tls {
        /// The certificate with its chain, a PEM file.
        certificate: PathBuf,
        /// The key, a PEM file.
        key: PathBuf,
    },
}

/// Runs the service until it is stopped. `ready` is called with the address once it listens.
/// Requests in progress are finished first.
///
/// # Errors
/// Returns [`Error::CannotListen`] if the address cannot be used, [`Error::Unprotected`] if others
/// can reach it and nothing protects it, [`Error::BadCertificate`], [`Error::BadCollector`],
/// [`Error::BadBasemap`], and the errors of the store.
pub fn serve(
    settings: &Settings,
    ready: impl FnOnce(SocketAddr),
    stop: &Stop,
) -> Result<(), Error> {
    let console = Console::new(settings.basemap.as_deref())?;
    let spans = settings.collector.as_deref().map(Spans::to).transpose()?.map(Arc::new);
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .build()
        .map_err(|cause| Error::Store { cause: cause.to_string() })?;
    let outcome = runtime.block_on(async {
        let tls = match &settings.protection {
            Protection::Tls { certificate, key } => Some(acceptor(certificate, key)?),
            Protection::None | Protection::Proxy => None,
        };
        let store = Store::open(&settings.location).await?;
        let closing = store.clone();
        // Held until the service stops. The operating system releases it even if the service is
        // killed.
        let _lock = lock(&settings.location)?;
        warn_of_network(&settings.location);
        let mut service = Service::new(store, settings.limits).await?;
        service.spans.clone_from(&spans);
        let service = Arc::new(service);
        check_protection(settings, &service).await?;
        let cannot = |cause| Error::CannotListen { address: settings.listen.to_string(), cause };
        let listener = listen(settings.listen).map_err(cannot)?;
        ready(listener.local_addr().map_err(cannot)?);
        let stopping = service.stopping.clone();
        tokio::spawn(pass_on(stop.clone(), stopping.clone()));
        tokio::spawn(follow_others(Arc::clone(&service)));
        let router = router(service, console);
        let mut limits = settings.limits;
        if settings.protection == Protection::Proxy {
            // All connections come from the proxy.
            limits.connections_per_address = limits.connections;
        }
        let serving = take(listener, router, tls, limits, stopping.subscribe());
        let mut heard = stopping.subscribe();
        tokio::select! {
            () = serving => {}
            () = async {
                drop(heard.wait_for(|&stops| stops).await);
                tokio::time::sleep(SHUTDOWN_TIMEOUT).await;
            } => {}
        }
        // No more requests may be answered, and each waiting write has been stored or never will
        // be.
        let _ = tokio::time::timeout(SHUTDOWN_TIMEOUT, closing.close()).await;
        Ok(())
    });
    // Do not wait for a policy that is still being evaluated.
    runtime.shutdown_timeout(POLL_INTERVAL);
    if let Some(spans) = spans {
        spans.flush();
    }
    outcome
}

/// Locks the folder of the data for this service.
fn lock(location: &Location) -> Result<Option<File>, Error> {
    let Location::Folder(folder) = location else { return Ok(None) };
    let failed = |cause| Error::Store { cause: format!("{}: {cause}", folder.display()) };
    let file = File::create(folder.join("serve.lock")).map_err(failed)?;
    match file.try_lock() {
        Ok(()) => Ok(Some(file)),
        Err(TryLockError::WouldBlock) => Err(Error::InUse { folder: folder.clone() }),
        Err(TryLockError::Error(cause)) => Err(failed(cause)),
    }
}

/// Warns if the data are on a file system of another machine.
fn warn_of_network(location: &Location) {
    if let Location::Folder(folder) = location
        && let Some(kind) = network_file_system(folder)
    {
        tracing::warn!(
            folder = %folder.display(),
            kind,
            "the data are on a file system of another machine, on which SQLite cannot lock them: \
             another program that uses the folder may damage them; use a local disk or --database"
        );
    }
}

/// Refuses an address that others can reach, unless connections are encrypted and there are tokens.
async fn check_protection(settings: &Settings, service: &Service) -> Result<(), Error> {
    // A proxy admits the whole world, even if the service listens locally.
    if settings.listen.ip().is_loopback() && settings.protection != Protection::Proxy {
        return Ok(());
    }
    let unprotected =
        |missing| Error::Unprotected { address: settings.listen.to_string(), missing };
    if settings.protection == Protection::None {
        return Err(unprotected("connections are not encrypted"));
    }
    if !service.access.is_guarded().await? {
        return Err(unprotected("there is no valid token"));
    }
    Ok(())
}

/// Follows the changes of other services to the same days until this one stops.
async fn follow_others(service: Arc<Service>) {
    let mut stopping = service.stopping.subscribe();
    tokio::select! {
        () = service.days.follow_others() => {}
        _ = stopping.wait_for(|&stops| stops) => {}
    }
}

/// Passes the request to stop on to all waiting tasks.
async fn pass_on(stop: Stop, stopping: watch::Sender<bool>) {
    while !stop.is_requested() {
        tokio::time::sleep(POLL_INTERVAL).await;
    }
    stopping.send_replace(true);
}
