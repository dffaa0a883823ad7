//! Without tokens the service trusts every program on its machine, and browsers there show pages of
//! the whole world. Such a page can send requests to this machine. With a domain name that resolves
//! to this machine, it could even read the answers. So requests must name this machine, and those
//! of a page must come from a page of this machine.

use std::net::IpAddr;

use axum::http::{HeaderMap, Uri, header};

use crate::error::Error;

/// Checks a request without a token. `host` is the host that it names.
///
/// # Errors
/// Returns [`Error::ForeignPage`].
pub(super) fn check(host: &str, headers: &HeaderMap) -> Result<(), Error> {
    if !is_this_machine(host) {
        return Err(Error::ForeignPage { what: "names the host", named: shortened(host) });
    }
    let Some(origin) = headers.get(header::ORIGIN) else { return Ok(()) };
    let origin = origin.to_str().unwrap_or("of no text");
    let uri: Option<Uri> = origin.parse().ok();
    if uri.as_ref().and_then(Uri::host).is_some_and(is_this_machine) {
        return Ok(());
    }
    Err(Error::ForeignPage { what: "comes from a page of", named: shortened(origin) })
}

/// Whether a host, with or without a port, names this machine from every machine.
fn is_this_machine(host: &str) -> bool {
    let name = match host.rsplit_once(':') {
        Some((name, port)) if port.bytes().all(|byte| byte.is_ascii_digit()) => name,
        _ => host,
    };
    let number = name.strip_prefix('[').and_then(|name| name.strip_suffix(']')).unwrap_or(name);
    number.parse::<IpAddr>().map_or_else(
        |_| {
            let name = name.to_ascii_lowercase();
            name == "localhost" || name.ends_with(".localhost")
        },
        |address| address.is_loopback(),
    )
}

fn shortened(text: &str) -> String {
    text.chars().take(100).collect()
}

#[cfg(test)]
mod tests {
    use axum::http::{HeaderMap, HeaderValue, header};

    use super::check;

    fn may(host: &str, origin: Option<&'static str>) -> bool {
        let origin = origin.map(|origin| (header::ORIGIN, HeaderValue::from_static(origin)));
        check(host, &HeaderMap::from_iter(origin)).is_ok()
    }

    #[test]
    fn requests_without_a_token_name_this_machine_and_come_from_its_pages() {
        for host in [
            "localhost",
            "LOCALHOST:8080",
            "127.0.0.1:8080",
            "127.9.0.1",
            "[::1]:80",
            "a.localhost",
        ] {
            assert!(may(host, None), "{host}");
        }
        for host in [
            "",
            "evil.example",
            "evil.example:8080",
            "10.0.0.1",
            "localhost.evil.example",
            "::ffff:1.2.3.4",
        ] {
            assert!(!may(host, None), "{host}");
        }
        for origin in ["http://127.0.0.1:8080", "http://localhost:5173", "https://[::1]"] {
            assert!(may("localhost:8080", Some(origin)), "{origin}");
        }
        for origin in ["http://evil.example", "https://localhost.evil.example:8080", "null", ""] {
            assert!(!may("localhost:8080", Some(origin)), "{origin}");
        }
    }
}
