//! What the pages of studies and of days have in common: one page that opens offline, follows the
//! reader's light or dark setting, and prints.
//!
//! The template escapes every text that it is given; only the figures and the style sheet, which
//! the program itself makes, are inserted as they are. The page loads nothing: style and figures
//! are inside, and links point to files beside the page.

use maud::{DOCTYPE, Markup, PreEscaped, html};
use vertifleet_picture::numbers::typeset;

use crate::figure::Figure;
use crate::statistics::Estimate;

/// A page with this title and body.
pub(crate) fn document(title: &str, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) }
                style { (PreEscaped(style())) }
            }
            body { main { (body) } }
        }
    };
    page.into_string()
}

fn style() -> String {
    let figures = vertifleet_picture::palette::style_sheet();
    format!(
        "{}@media screen and (prefers-color-scheme:dark){{{figures}}}\n",
        include_str!("page/style.css")
    )
}

/// The only script of a page of this crate: an address that leads to a moment of the replay leads
/// to the frame of the replay, which is loaded when it is looked at. A server of the page names it
/// in the policy of what the page may run.
pub const REPLAY_FRAME_SCRIPT: &str =
    "if (/[#&]at=/.test(location.hash)) document.querySelector('iframe.replay').scrollIntoView()";

/// The page of a replay in a frame of its own, which keeps its style and its scripts apart from the
/// page.
pub(crate) fn replay_frame(page: &str) -> Markup {
    html! {
        iframe.replay title="Replay" loading="lazy" srcdoc=(page) {}
        script { (PreEscaped(REPLAY_FRAME_SCRIPT)) }
    }
}

/// A mean with its interval.
pub(crate) fn estimate(estimate: &Estimate, written: impl Fn(f64) -> String) -> Markup {
    html! {
        (typeset(&written(estimate.mean)))
        @if let Some(half_width) = estimate.half_width_95 { small { " ± " (written(half_width)) } }
    }
}

/// A figure with its caption.
pub(crate) fn picture(figure: &Figure) -> Markup {
    html! {
        figure {
            (PreEscaped(&figure.svg))
            figcaption { (figure.caption) }
        }
    }
}

/// Links to the files of the figures, each after a semicolon.
pub(crate) fn links(figures: &[Figure]) -> Markup {
    html! {
        @for figure in figures {
            "; " a href={ (figure.slug) ".svg" } { (figure.slug) } " (" a href={ (figure.slug) ".png" } { "PNG" } ")"
        }
    }
}
