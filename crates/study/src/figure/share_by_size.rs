//! The share of the bound against the size of the network: one panel over aircraft and one over vertiports, with a
//! mark for each network and policy.
//!
//! Policies differ by the shape of their marks as well as by the colour. A ring in the background colour separates
//! marks that overlap.

use vertifleet_picture::axis::Scale;
use vertifleet_picture::canvas::{Anchor, Canvas, Lettering, Stroke, shortened};
use vertifleet_picture::numbers::{counted, grouped, minutes, typeset};
use vertifleet_picture::palette::Paint;

use super::Figure;
use super::key;
use crate::generalisation::{GeneralisationReport, NetworkShare};

const WIDTH: f64 = 760.0;
const LEFT: f64 = 56.0;
const RIGHT: f64 = 24.0;
/// The distance from the left end of a mark of the key to its name.
const KEY_MARK: f64 = 18.0;
const PANEL_HEIGHT: f64 = 250.0;
/// The distance from the bottom of a panel to the top of the next.
const BETWEEN: f64 = 72.0;
const BOTTOM: f64 = 52.0;
const LONGEST_NAME: usize = 22;

/// The quantity on the horizontal axis of a panel.
struct Size {
    axis: &'static str,
    of: fn(&NetworkShare) -> usize,
}

const SIZES: [Size; 2] = [
    Size { axis: "aircraft", of: |network| network.aircraft },
    Size { axis: "vertiports", of: |network| network.vertiports },
];

/// The figure with both panels.
pub(crate) fn share_by_size(summary: &GeneralisationReport) -> Figure {
    let names: Vec<String> =
        summary.policies.iter().map(|policy| shortened(&policy.name, LONGEST_NAME)).collect();
    let (places, last_row) = key::places(&names, KEY_MARK, WIDTH);
    let top = last_row + 42.0;
    let height = top + 2.0 * PANEL_HEIGHT + BETWEEN + BOTTOM;
    let subtitle = format!(
        "A day each of {}; the bound with slices of {}",
        counted(summary.networks.len(), "random network", "random networks"),
        minutes(summary.bound_step_s)
    );
    let mut canvas =
        Canvas::new(WIDTH, height, "Share of the bound by size of the network", &subtitle);
    for (position, name) in names.iter().enumerate() {
        let (x, y) = places[position];
        canvas.marker((x + 6.0, y), position);
        canvas.text((x + KEY_MARK, y + 4.0), Lettering::LABEL, name);
    }
    for (panel, size) in SIZES.iter().enumerate() {
        draw_panel(&mut canvas, summary, size, top + panel as f64 * (PANEL_HEIGHT + BETWEEN));
    }
    Figure {
        slug: "figure-share-by-size",
        caption: "One mark is one policy on the day of one network; the marks of a network stand above each other. Above the line \
                  nothing is possible: it is the bound that is proven for each day."
            .to_owned(),
        svg: canvas.into_svg(),
    }
}

fn draw_panel(canvas: &mut Canvas, summary: &GeneralisationReport, size: &Size, top: f64) {
    let floor = top + PANEL_HEIGHT;
    let networks = || summary.networks.iter();
    let shares = networks().flat_map(|network| &network.results).map(|outcome| outcome.bound_share);
    let x =
        Scale::around(networks().map(|network| (size.of)(network) as f64), LEFT, WIDTH - RIGHT, 8);
    let y = Scale::around(shares.map(|share| 100.0 * share).chain([100.0]), floor, top, 6);
    draw_axes(canvas, &x, &y, size.axis, top, floor);
    // Marks are drawn policy by policy: where marks overlap, those of the policy named later are visible.
    for (position, _) in summary.policies.iter().enumerate() {
        for network in networks() {
            let share = 100.0 * network.results[position].bound_share;
            canvas.marker((x.pixel((size.of)(network) as f64), y.pixel(share)), position);
        }
    }
}

fn draw_axes(canvas: &mut Canvas, x: &Scale, y: &Scale, name: &str, top: f64, floor: f64) {
    let small = |anchor| Lettering::SMALL.anchored(anchor);
    canvas.text((16.0, top - 10.0), Lettering::SMALL, "share of the bound, %");
    let decimals = y.decimals(1.0);
    for tick in y.ticks() {
        let height = y.pixel(tick);
        canvas.line((LEFT, height), (WIDTH - RIGHT, height), Stroke::solid(Paint::Grid, 1.0));
        let label = typeset(&grouped(tick, decimals));
        canvas.text((LEFT - 8.0, height + 4.0), small(Anchor::End), &label);
    }
    let bound = y.pixel(100.0);
    let dashed = Stroke { paint: Paint::Ink, width: 1.4, dash: Some("6 4") };
    canvas.line((LEFT, bound), (WIDTH - RIGHT, bound), dashed);
    canvas.text((WIDTH - RIGHT, bound - 6.0), small(Anchor::End), "bound");
    let decimals = x.decimals(1.0);
    for tick in x.ticks() {
        let place = x.pixel(tick);
        canvas.line((place, floor), (place, floor + 4.0), Stroke::solid(Paint::Muted, 1.0));
        let label = format!("{tick:.decimals$}");
        canvas.text((place, floor + 18.0), small(Anchor::Middle), &label);
    }
    canvas.line((LEFT, floor), (WIDTH - RIGHT, floor), Stroke::solid(Paint::Muted, 1.0));
    let middle = f64::midpoint(LEFT, WIDTH - RIGHT);
    canvas.text((middle, floor + 38.0), small(Anchor::Middle), name);
}
