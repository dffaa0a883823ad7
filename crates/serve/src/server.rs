//! The running server: listens until it is asked to stop.

use std::fs::{File, TryLockError};
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use tokio::net::TcpListener;
use tokio::sync::watch;
use vertifleet_core::Stop;

use crate::api::router;
use crate::days::Days;
use crate::error::Error;
use crate::service::Service;
use crate::store::{Location, Store};

/// How often the request to stop is looked for.
const LOOK: Duration = Duration::from_millis(50);
/// After a request to stop, requests that are being carried out have this long to end.
const PATIENCE: Duration = Duration::from_secs(10);

/// How the service runs.
#[derive(Debug, Clone)]
pub struct Settings {
    /// Where it listens.
    pub listen: SocketAddr,
    /// Where its data lies.
    pub location: Location,
    /// Whether a proxy that speaks TLS stands before it.
    pub behind_proxy: bool,
}

/// Runs the service until it is asked to stop. `ready` is called with the address once it listens. Requests that are
/// being carried out are finished first.
///
/// # Errors
/// Returns [`Error::CannotListen`] if the address cannot be used, and the errors of the store.
pub fn serve(
    settings: &Settings,
    ready: impl FnOnce(SocketAddr),
    stop: &Stop,
) -> Result<(), Error> {
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .build()
        .map_err(|cause| Error::Store { cause: cause.to_string() })?;
    let outcome = runtime.block_on(async {
        let store = Store::open(&settings.location).await?;
        // Held until the service stops. The operating system lets go of it even if the service is killed.
        let _lock = lock(&settings.location)?;
        let service = Arc::new(Service::new(Days::new(store)).await?);
        check_protection(settings, &service).await?;
        let cannot = |cause| Error::CannotListen { address: settings.listen.to_string(), cause };
        let listener = TcpListener::bind(settings.listen).await.map_err(cannot)?;
        ready(listener.local_addr().map_err(cannot)?);
        let stopping = service.stopping.clone();
        tokio::spawn(pass_on(stop.clone(), stopping.clone()));
        let mut heard = stopping.subscribe();
        let stopped = async move { drop(heard.wait_for(|&stops| stops).await) };
        let serving = axum::serve(listener, router(service)).with_graceful_shutdown(stopped);
        let mut heard = stopping.subscribe();
        tokio::select! {
            ended = serving.into_future() => ended.map_err(cannot),
            () = async {
                drop(heard.wait_for(|&stops| stops).await);
                tokio::time::sleep(PATIENCE).await;
            } => Ok(()),
        }
    });
    // A policy that still thinks is not waited for.
    runtime.shutdown_timeout(LOOK);
    outcome
}

/// Takes the folder of the data for this service alone.
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

/// Refuses an address that others can reach, unless a proxy encrypts what they say and tokens tell who they are.
async fn check_protection(settings: &Settings, service: &Service) -> Result<(), Error> {
    if settings.listen.ip().is_loopback() {
        return Ok(());
    }
    let unprotected =
        |missing| Error::Unprotected { address: settings.listen.to_string(), missing };
    if !settings.behind_proxy {
        return Err(unprotected("what is said there is not encrypted"));
    }
    if !service.access.is_guarded().await? {
        return Err(unprotected("there is no token in force"));
    }
    Ok(())
}

/// Passes the request to stop on to everything that waits.
async fn pass_on(stop: Stop, stopping: watch::Sender<bool>) {
    while !stop.is_requested() {
        tokio::time::sleep(LOOK).await;
    }
    stopping.send_replace(true);
}
