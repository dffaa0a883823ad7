//! The running server: listens until it is asked to stop.

use std::net::SocketAddr;
use std::sync::Arc;

use tokio::net::TcpListener;

use crate::api::router;
use crate::days::Days;
use crate::error::Error;
use crate::service::Service;
use crate::store::{Location, Store};

/// How the service runs.
#[derive(Debug, Clone)]
pub struct Settings {
    /// Where it listens.
    pub listen: SocketAddr,
    /// Where its data lies.
    pub location: Location,
}

/// Runs the service until `stop` ends. `ready` is called with the address once it listens.
///
/// # Errors
/// Returns [`Error::CannotListen`] if the address cannot be used, and the errors of the store.
pub fn serve(
    settings: &Settings,
    ready: impl FnOnce(SocketAddr) + Send,
    stop: impl Future<Output = ()> + Send + 'static,
) -> Result<(), Error> {
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .build()
        .map_err(|cause| Error::Store { cause: cause.to_string() })?;
    runtime.block_on(async {
        let store = Store::open(&settings.location).await?;
        let service = Arc::new(Service::new(Days::new(store)));
        let cannot = |cause| Error::CannotListen { address: settings.listen.to_string(), cause };
        let listener = TcpListener::bind(settings.listen).await.map_err(cannot)?;
        ready(listener.local_addr().map_err(cannot)?);
        axum::serve(listener, router(service)).with_graceful_shutdown(stop).await.map_err(cannot)
    })
}
