//! The console: pages and scripts, which need no token. The data behind them does.

use std::sync::Arc;

use axum::Router;
use axum::extract::Path;
use axum::http::uri::Scheme;
use axum::http::{HeaderName, HeaderValue, Uri, header};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use bytes::Bytes;
use tower_http::compression::CompressionLayer;
use vertifleet_console::asset;

use crate::error::Error;

/// The console and its settings.
#[derive(Debug, Clone)]
pub(crate) struct Console {
    page: Bytes,
    /// The content security policy of its pages.
    policy: HeaderValue,
}

impl Console {
    /// The console, with the operator's base map in place of the bundled one: a style of MapLibre,
    /// or a file of `PMTiles`. The resources of a style must have its origin, since pages may load
    /// from no other.
    ///
    /// # Errors
    /// Returns [`Error::BadBasemap`] if the address is not an HTTP address.
    pub(crate) fn new(basemap: Option<&str>) -> Result<Self, Error> {
        let page = asset("index.html").expect("a test sees that there is a page").bytes;
        let Some(address) = basemap else {
            let policy = HeaderValue::try_from(policy("")).expect("plain words are a header");
            return Ok(Self { page: Bytes::from_owner(page), policy });
        };
        let bad =
            |rule: &str| Error::BadBasemap { address: address.to_owned(), rule: rule.to_owned() };
        let origin = origin(address).map_err(bad)?;
        let policy = HeaderValue::try_from(policy(&format!(" {origin}")))
            .map_err(|_| bad("it must be plain text"))?;
        let named = address.replace('&', "&amp;").replace('"', "&quot;").replace('<', "&lt;");
        let named = format!("<meta name=\"vertifleet-basemap\" content=\"{named}\" />\n  </head>");
        let page =
            std::str::from_utf8(&page).expect("a page is text").replacen("</head>", &named, 1);
        Ok(Self { page: page.into(), policy })
    }

    /// The paths of the console.
    pub(crate) fn router<S: Clone + Send + Sync + 'static>(self) -> Router<S> {
        let console = Arc::new(self);
        let page = {
            let console = Arc::clone(&console);
            async move || {
                console.answer("text/html; charset=utf-8", "no-cache", console.page.clone())
            }
        };
        let file = async move |Path(name): Path<String>| {
            let path = format!("assets/{name}");
            let file = asset(&path).ok_or_else(|| Error::not_found("path", &path))?;
            let for_ever = "public, max-age=31536000, immutable";
            Ok::<_, Error>(console.answer(
                file.content_type,
                for_ever,
                Bytes::from_owner(file.bytes),
            ))
        };
        Router::new()
            .route("/", get(page))
            .route("/assets/{*file}", get(file))
            .layer(CompressionLayer::new())
    }

    fn answer(&self, content_type: &'static str, keep: &'static str, bytes: Bytes) -> Response {
        let headers: [(HeaderName, HeaderValue); 4] = [
            (header::CONTENT_TYPE, HeaderValue::from_static(content_type)),
            (header::CACHE_CONTROL, HeaderValue::from_static(keep)),
            (header::CONTENT_SECURITY_POLICY, self.policy.clone()),
            (header::REFERRER_POLICY, HeaderValue::from_static("no-referrer")),
        ];
        (headers, bytes).into_response()
    }
}

/// Whether a path is one of the console's, which needs no token.
pub(crate) fn is_open(path: &str) -> bool {
    path == "/" || path.starts_with("/assets/")
}

/// The content security policy of the pages, the same as in `web/security.ts`: their own files and
/// the service's answers. `map` is the origin of a base map on another host.
fn policy(map: &str) -> String {
    format!(
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:{map}; font-src 'self'; \
         connect-src 'self'{map}; worker-src 'self'; manifest-src 'self'; base-uri 'none'; form-action 'none'; \
         frame-ancestors 'none'"
    )
}

/// The scheme, the host and the port of an HTTP address, or what is wrong with it.
fn origin(address: &str) -> Result<String, &'static str> {
    let rule = "it must be an address such as https://tiles.example.com/style.json";
    let uri: Uri = address.parse().map_err(|_| rule)?;
    let scheme = uri.scheme().filter(|scheme| [Scheme::HTTP, Scheme::HTTPS].contains(scheme));
    let (scheme, authority) = scheme.zip(uri.authority()).ok_or(rule)?;
    let is_plain = |mark: char| mark.is_ascii_alphanumeric() || ".-:[]".contains(mark);
    if !authority.as_str().chars().all(is_plain) {
        return Err("its host must be a plain name or number, without a user");
    }
    Ok(format!("{scheme}://{authority}"))
}
