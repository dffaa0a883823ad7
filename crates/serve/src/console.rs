//! The console: pages and scripts that anybody may have, since the data behind them needs a token as ever.

use axum::Router;
use axum::extract::Path;
use axum::http::{HeaderName, HeaderValue, header};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use tower_http::compression::CompressionLayer;
use vertifleet_console::asset;

use crate::error::Error;

/// What the pages may load, the same as `web/security.ts` has it: their own files, and what the service answers.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; \
    font-src 'self'; connect-src 'self'; worker-src 'self'; manifest-src 'self'; base-uri 'none'; form-action 'none'; \
    frame-ancestors 'none'";

/// The paths of the console.
pub(crate) fn router<S: Clone + Send + Sync + 'static>() -> Router<S> {
    let file = |Path(file): Path<String>| async move { answer(&format!("assets/{file}")) };
    Router::new()
        .route("/", get(|| async { answer("index.html") }))
        .route("/assets/{*file}", get(file))
        .layer(CompressionLayer::new())
}

/// Whether a path is one of the console's, which needs no token.
pub(crate) fn is_open(path: &str) -> bool {
    path == "/" || path.starts_with("/assets/")
}

fn answer(path: &str) -> Result<Response, Error> {
    let file = asset(path).ok_or_else(|| Error::not_found("path", path))?;
    let keep = if file.is_immutable { "public, max-age=31536000, immutable" } else { "no-cache" };
    let headers: [(HeaderName, HeaderValue); 4] = [
        (header::CONTENT_TYPE, HeaderValue::from_static(file.content_type)),
        (header::CACHE_CONTROL, HeaderValue::from_static(keep)),
        (header::CONTENT_SECURITY_POLICY, HeaderValue::from_static(POLICY)),
        (header::REFERRER_POLICY, HeaderValue::from_static("no-referrer")),
    ];
    Ok((headers, file.bytes).into_response())
}
