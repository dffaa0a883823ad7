//! The figures of a comparison as SVG: learning curves (Fig. 3 and on validation days), reward
//! (Fig. 4), profit (Fig. 5), share of the bound, and differences day by day.
//!
//! Every figure names its marks in words. Its series differ by marker, dash or place as well as by
//! colour, so that it can be read in grey. Colours are set twice: as attributes, for the separate
//! SVG file, and as classes, which the style sheet of a page may override for a dark background.

mod box_plot;
mod day_differences;
mod designs;
mod heat_map;
mod key;
mod learning_curves;
mod profiles;
mod response;
mod tornado;

use std::borrow::Cow;

use vertifleet_study::ComparisonReport;
use vertifleet_study::board::SuiteBoard;
use vertifleet_study::size::SizeReport;
use vertifleet_study::sweep::SweepReport;

/// A picture with the text that a page shows with it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Figure {
    /// File name without ending, for example `figure-5-profit`.
    pub slug: Cow<'static, str>,
    /// How to read the picture, in a sentence or two.
    pub caption: String,
    /// The picture: a complete SVG document.
    pub svg: String,
}

/// Every figure that the summary has numbers for, in the order of the report.
pub(crate) fn of_comparison(summary: &ComparisonReport) -> Vec<Figure> {
    let figures = [
        Some(box_plot::daily_profit(summary)),
        box_plot::bound_share(summary),
        Some(box_plot::episode_reward(summary)),
        day_differences::figure(summary),
        learning_curves::on_training_days(summary),
        learning_curves::on_validation_days(summary),
    ];
    figures.into_iter().flatten().collect()
}

/// The figures of a sweep.
pub(crate) fn of_sweep(report: &SweepReport) -> Vec<Figure> {
    let figures = [response::curves(report), heat_map::figure(report), tornado::figure(report)];
    figures.into_iter().flatten().collect()
}

/// The figure of a suite of a board.
pub(crate) fn of_board(board: &SuiteBoard) -> Figure {
    profiles::figure(board)
}

/// The figures of a search for a design.
pub(crate) fn of_size(report: &SizeReport) -> Vec<Figure> {
    vec![designs::figure(report)]
}

#[cfg(test)]
#[path = "figure_tests.rs"]
mod tests;
