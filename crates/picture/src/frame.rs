//! The fleet at one moment as a small picture, for videos and for environments.

use vertifleet_core::{Scenario, VertiportIx};

use crate::canvas::{Anchor, Canvas, Lettering, Look, Stroke};
use crate::map::{Area, Map, room};
use crate::moment::{Moment, Whereabouts};
use crate::numbers::{dollars, grouped};
use crate::palette::Paint;

/// Width and height of a frame in pixels.
pub const FRAME: (u32, u32) = (640, 480);

const HEADER: f64 = 40.0;
const FOOTER: f64 = 24.0;

/// A map of the fleet as SVG, [`FRAME`] in size. `deciding` is the vertiport of the aircraft that
/// decides, if one does.
pub fn frame(day: &Scenario, moment: &Moment, deciding: Option<VertiportIx>) -> String {
    let (width, height) = (f64::from(FRAME.0), f64::from(FRAME.1));
    let mut canvas = Canvas::bare(width, height, &day.name);
    let area = Area { left: 0.0, top: HEADER, width, height: height - HEADER - FOOTER };
    let map = Map::of(day, area);
    header(&mut canvas, day, moment, width);
    let radius = if map.is_named() { 11.0 } else { 5.0 };
    flights(&mut canvas, &map, moment, radius);
    for at in VertiportIx::all(day.vertiports.len()) {
        vertiport(&mut canvas, &map, (day, moment), at, radius);
    }
    if let Some(at) = deciding {
        let ring = Stroke::solid(Paint::Series(1), 2.4);
        canvas.circle(map.at(at), radius + 4.0, Look::outlined(ring));
    }
    footer(&mut canvas, width, height);
    canvas.into_svg()
}

fn header(canvas: &mut Canvas, day: &Scenario, moment: &Moment, width: f64) {
    let name = crate::canvas::shortened(&day.name, 28);
    canvas.text((12.0, 24.0), Lettering { size: 15.0, ..Lettering::LABEL.bold() }, &name);
    let time = moment.time.to_string();
    canvas.text(
        (250.0, 24.0),
        Lettering { size: 15.0, ..Lettering::LABEL },
        &time[..time.len() - 3],
    );
    let so_far = format!(
        "{} · {} flights · {} passengers",
        dollars(moment.profit_usd),
        grouped(f64::from(moment.flights), 0),
        grouped(moment.passengers as f64, 0)
    );
    let right = Lettering { size: 13.0, ..Lettering::SMALL }.anchored(Anchor::End);
    canvas.text((width - 12.0, 24.0), right, &so_far);
    canvas.line((0.0, HEADER - 4.0), (width, HEADER - 4.0), Stroke::solid(Paint::Grid, 1.0));
}

fn flights(canvas: &mut Canvas, map: &Map, moment: &Moment, radius: f64) {
    let size = 0.6 * radius + 1.4;
    for place in &moment.aircraft {
        if let Whereabouts::Flying { from, to, .. } = *place {
            canvas.line(map.at(from), map.at(to), Stroke::solid(Paint::Grid, 1.0));
        }
    }
    for place in &moment.aircraft {
        if let Whereabouts::Flying { from, to, share, load } = *place {
            let outline = Some(Stroke::solid(Paint::Series(0), 1.2));
            let fill = if load > 0.0 {
                (Paint::Series(0), 0.25 + 0.75 * load)
            } else {
                (Paint::Ground, 1.0)
            };
            map.arrow(canvas, (from, to, share), size, Look { fill: Some(fill), stroke: outline });
        }
    }
}

/// A vertiport with the share of its stands that are taken, the number of aircraft on them and on
/// their way to it, and its waiting passengers.
fn vertiport(
    canvas: &mut Canvas,
    map: &Map,
    (day, moment): (&Scenario, &Moment),
    at: VertiportIx,
    radius: f64,
) {
    let one = &day.vertiports[at.at()];
    let stands = room(one);
    let (standing, coming) = (moment.standing[at.at()], moment.coming[at.at()]);
    let taken = f64::from(standing + coming) / f64::from(stands.max(1));
    map.disc(canvas, at, radius, taken);
    map.name(canvas, day, at, radius);
    if map.is_named() {
        let (x, y) = map.at(at);
        let small = Lettering::SMALL.anchored(Anchor::Middle);
        let text = format!("{standing}+{coming} of {stands}");
        canvas.text_on_lines((x, y + radius + 14.0), small, &text);
        let waiting = format!("{} wait", grouped(f64::from(moment.waiting[at.at()]), 0));
        let paint = Lettering { paint: Paint::Series(1), ..small };
        canvas.text_on_lines((x, y + radius + 28.0), paint, &waiting);
    }
}

fn footer(canvas: &mut Canvas, width: f64, height: f64) {
    let text = "disc: stands taken, standing + coming of all · arrow: a flight, hollow if empty · ring: decides now";
    let small = Lettering { size: 11.0, ..Lettering::SMALL }.anchored(Anchor::Middle);
    canvas.text((width / 2.0, height - 8.0), small, text);
}
