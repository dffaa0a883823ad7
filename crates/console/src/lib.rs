//! The console and the replay page, as they are built from `web/` and kept in `web/dist`.
//!
//! They are part of the program, so that a user needs neither Node.js nor the network to look at a
//! day.
//!
//! ```
//! let page = vertifleet_console::asset("index.html").expect("the console has a page");
//! assert_eq!(page.content_type, "text/html; charset=utf-8");
//! ```

mod replay;

use std::borrow::Cow;

use rust_embed::RustEmbed;

pub use replay::{REPLAY_OPENING, replay_page, replay_script_and_style};

#[derive(RustEmbed)]
#[folder = "../../web/dist"]
struct Dist;

/// A file of the console.
#[derive(Debug, Clone)]
pub struct Asset {
    /// Its bytes.
    pub bytes: Cow<'static, [u8]>,
    /// What they are.
    pub content_type: &'static str,
    /// Whether its name carries a hash of its bytes, so that it never changes.
    pub is_immutable: bool,
}

/// The file of the console at a path such as `index.html` or `assets/index-1a2b3c.js`.
pub fn asset(path: &str) -> Option<Asset> {
    let content_type = content_type(path)?;
    let file = Dist::get(path)?;
    let is_immutable = path.starts_with("assets/");
    Some(Asset { bytes: file.data, content_type, is_immutable })
}

fn content_type(path: &str) -> Option<&'static str> {
    let (_, ending) = path.rsplit_once('.')?;
    Some(match ending {
        "html" => "text/html; charset=utf-8",
        "js" | "mjs" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "svg" => "image/svg+xml",
        "json" => "application/json",
        "woff2" => "font/woff2",
        "png" => "image/png",
        "txt" => "text/plain; charset=utf-8",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_has_a_type_and_the_page_names_only_files_that_are_there() {
        let page = asset("index.html").expect("the console has a page");
        let page = std::str::from_utf8(&page.bytes).expect("text");
        let named: Vec<&str> =
            page.split('"').filter_map(|text| text.strip_prefix("/assets/")).collect();
        assert!(!named.is_empty(), "{page}");
        for name in named {
            assert!(
                asset(&format!("assets/{name}")).is_some_and(|file| file.is_immutable),
                "{name}"
            );
        }
        for path in Dist::iter() {
            assert!(content_type(&path).is_some(), "{path}");
        }
    }
}
