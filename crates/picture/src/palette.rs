//! Colours by their use, for light and dark backgrounds; dashes and markers for figures in grey.

use std::fmt::Write as _;

/// The use of a stroke or a fill.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Paint {
    /// The background of the picture.
    Ground,
    /// Titles, labels of things, and marks that matter.
    Ink,
    /// Scales, keys and notes.
    Muted,
    /// The lines that values are read by.
    Grid,
    /// A policy, by its position.
    Series(usize),
}

/// A colour on a light background and on a dark one.
struct Tone {
    light: &'static str,
    dark: &'static str,
}

const GROUND: Tone = Tone { light: "#ffffff", dark: "#15191e" };
const INK: Tone = Tone { light: "#1c252e", dark: "#e6eaee" };
const MUTED: Tone = Tone { light: "#5c6a77", dark: "#9aa7b3" };
const GRID: Tone = Tone { light: "#e2e6ea", dark: "#2c343c" };
const SERIES: [Tone; 8] = [
    Tone { light: "#1d5fa6", dark: "#74aef0" },
    Tone { light: "#d3700a", dark: "#f2a65a" },
    Tone { light: "#17876a", dark: "#52caa6" },
    Tone { light: "#7a58ad", dark: "#b79fe6" },
    Tone { light: "#bb3a72", dark: "#ee8bb7" },
    Tone { light: "#7d6f17", dark: "#d0bd57" },
    Tone { light: "#4c6075", dark: "#a3b5c7" },
    Tone { light: "#2b93c9", dark: "#84cff3" },
];

/// The dash patterns of lines in the order of the series; the first is a solid line.
const DASHES: [Option<&str>; 5] = [None, Some("7 4"), Some("2 3"), Some("10 3 2 3"), Some("14 4")];

impl Paint {
    /// The colour on a light background, as in a separate SVG file.
    pub fn colour(self) -> &'static str {
        self.tone().light
    }

    /// The name of the class by which a page changes this paint.
    pub fn class(self) -> String {
        match self {
            Self::Ground => "ground".to_owned(),
            Self::Ink => "ink".to_owned(),
            Self::Muted => "muted".to_owned(),
            Self::Grid => "grid".to_owned(),
            Self::Series(position) => format!("series-{}", position % SERIES.len()),
        }
    }

    fn tone(self) -> &'static Tone {
        match self {
            Self::Ground => &GROUND,
            Self::Ink => &INK,
            Self::Muted => &MUTED,
            Self::Grid => &GRID,
            Self::Series(position) => &SERIES[position % SERIES.len()],
        }
    }
}

/// The dash pattern of a series' line.
pub fn dash(position: usize) -> Option<&'static str> {
    DASHES[position % DASHES.len()]
}

/// The style rules that give figures inside a page their colours on a dark background.
pub fn style_sheet() -> String {
    let paints = [Paint::Ground, Paint::Ink, Paint::Muted, Paint::Grid];
    let mut rules = String::new();
    for paint in paints.into_iter().chain((0..SERIES.len()).map(Paint::Series)) {
        let (class, colour) = (paint.class(), paint.tone().dark);
        let _ = write!(rules, ".fill-{class}{{fill:{colour}}}.stroke-{class}{{stroke:{colour}}}");
    }
    rules
}
