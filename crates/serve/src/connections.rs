//! Accepts connections, with or without TLS, and serves HTTP on each.

mod addresses;
mod strict_lines;

use std::net::SocketAddr;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::net::{TcpListener, TcpSocket, TcpStream};
use tokio::sync::{Semaphore, watch};
use tokio::time::{sleep, timeout};
use tokio_rustls::TlsAcceptor;
use tokio_rustls::rustls::ServerConfig;
use tokio_rustls::rustls::crypto::ring;
use tokio_rustls::rustls::pki_types::pem::PemObject as _;
use tokio_rustls::rustls::pki_types::{CertificateDer, PrivateKeyDer};

use self::addresses::Addresses;
use self::strict_lines::StrictLines;
use crate::error::Error;
use crate::limits::Limits;

/// Time limit of the TLS handshake.
const HANDSHAKE: Duration = Duration::from_secs(10);
/// Length of the queue of connections to accept. A client whose connection does not fit retries
/// only after a second.
const BACKLOG: u32 = 4_096;
/// Largest head of a request, bytes; it is in memory before its sender is known.
const LONGEST_HEAD: usize = 64 << 10;
/// Time until the next try when no connection can be accepted, for example because too many files
/// are open.
const PAUSE: Duration = Duration::from_millis(100);

/// The settings of a connection.
#[derive(Clone)]
struct Way {
    router: Router,
    tls: Option<TlsAcceptor>,
    head: Duration,
    stopping: watch::Receiver<bool>,
}

/// Listens at an address.
///
/// # Errors
/// Returns the operating system's error if the address cannot be used.
pub(crate) fn listen(address: SocketAddr) -> std::io::Result<TcpListener> {
    let socket = if address.is_ipv4() { TcpSocket::new_v4()? } else { TcpSocket::new_v6()? };
    // On Unix, a restarted service gets its address back at once; elsewhere this option would let
    // two programs listen at one address.
    #[cfg(unix)]
    socket.set_reuseaddr(true)?;
    socket.bind(address)?;
    socket.listen(BACKLOG)
}

/// Accepts connections until the service stops, and returns when the last of them has ended. A
/// connection from an address that already has `limits.connections_per_address` is closed.
pub(crate) async fn take(
    listener: TcpListener,
    router: Router,
    tls: Option<TlsAcceptor>,
    limits: Limits,
    stopping: watch::Receiver<bool>,
) {
    let most = limits.connections_here();
    let addresses = Addresses::new(limits.connections_per_address);
    let turns = Arc::new(Semaphore::new(most));
    let mut heard = stopping.clone();
    let way = Way { router, tls, head: limits.head, stopping };
    let taking = async {
        loop {
            let turn = Arc::clone(&turns).acquire_owned().await.expect("it is never closed");
            match listener.accept().await {
                Ok((socket, from)) => {
                    let Some(place) = addresses.take(from.ip()) else {
                        tracing::debug!(%from, "an address has too many connections");
                        continue;
                    };
                    let way = way.clone();
                    tokio::spawn(async move {
                        way.open(socket).await;
                        drop((turn, place));
                    });
                }
                Err(error) => {
                    tracing::warn!(%error, "a connection cannot be taken");
                    sleep(PAUSE).await;
                }
            }
        }
    };
    tokio::select! {
        () = taking => {}
        _ = heard.wait_for(|&stops| stops) => {}
    }
    // All turns are free when the last connection has ended.
    drop(turns.acquire_many(u32::try_from(most).unwrap_or(u32::MAX)).await);
}

impl Way {
    async fn open(self, socket: TcpStream) {
        // An answer is one small write, which must not be delayed.
        if let Err(error) = socket.set_nodelay(true) {
            tracing::debug!(%error, "a socket has gone");
        }
        match &self.tls {
            None => self.speak(socket).await,
            Some(tls) => match timeout(HANDSHAKE, tls.accept(socket)).await {
                Ok(Ok(stream)) => self.speak(stream).await,
                Ok(Err(error)) => tracing::debug!(%error, "no handshake"),
                Err(_) => tracing::debug!("a handshake took too long"),
            },
        }
    }

    async fn speak(&self, stream: impl AsyncRead + AsyncWrite + Unpin + Send) {
        let service = TowerToHyperService::new(self.router.clone());
        let connection = http1::Builder::new()
            .timer(TokioTimer::new())
            .header_read_timeout(self.head)
            .max_buf_size(LONGEST_HEAD)
            .serve_connection(TokioIo::new(StrictLines::new(stream)), service);
        tokio::pin!(connection);
        let mut stopping = self.stopping.clone();
        let ended = tokio::select! {
            ended = connection.as_mut() => ended,
            () = async { drop(stopping.wait_for(|&stops| stops).await) } => {
                connection.as_mut().graceful_shutdown();
                connection.await
            }
        };
        if let Err(error) = ended {
            tracing::debug!(%error, "a connection has ended");
        }
    }
}

/// Reads a certificate with its chain and its key, both in PEM files.
///
/// # Errors
/// Returns [`Error::BadCertificate`] if a file cannot be read, or if the two do not belong
/// together.
pub(crate) fn acceptor(certificate: &Path, key: &Path) -> Result<TlsAcceptor, Error> {
    let bad = |file: &Path, rule: String| Error::BadCertificate { file: file.to_owned(), rule };
    let chain: Vec<CertificateDer<'static>> = CertificateDer::pem_file_iter(certificate)
        .and_then(Iterator::collect)
        .map_err(|error| bad(certificate, error.to_string()))?;
    if chain.is_empty() {
        return Err(bad(certificate, "there is no certificate in it".to_owned()));
    }
    let secret = PrivateKeyDer::from_pem_file(key).map_err(|error| bad(key, error.to_string()))?;
    let config = ServerConfig::builder_with_provider(Arc::new(ring::default_provider()))
        .with_safe_default_protocol_versions()
        .map_err(|error| bad(certificate, error.to_string()))?
        .with_no_client_auth()
        .with_single_cert(chain, secret)
        .map_err(|error| bad(certificate, error.to_string()))?;
    Ok(TlsAcceptor::from(Arc::new(config)))
}
