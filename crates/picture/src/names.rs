//! Names of vertiports on a map, each where it covers neither a vertiport nor another name.

use vertifleet_core::{Scenario, VertiportIx};

use crate::canvas::{Anchor, Canvas, Point, text_width};
use crate::map::Map;

/// Pixels between a disc and its name.
const GAP: f64 = 5.0;
/// Height of capital letters, as a share of the size of a text.
const CAPITALS: f64 = 0.75;

/// A rectangle: left, top, right, bottom.
type Extent = [f64; 4];

/// Draws the names of all vertiports, whose discs have this radius, if there is room for names at
/// all. A name stands above its disc if nothing is there, otherwise below, right or left of it.
pub(crate) fn draw(canvas: &mut Canvas, map: &Map, day: &Scenario, radius: f64) {
    if !map.is_named() {
        return;
    }
    let all = || VertiportIx::all(day.vertiports.len());
    let names: Vec<String> = all().map(|at| Map::short_name(day, at)).collect();
    let discs: Vec<(Point, f64)> = all()
        .map(|at| map.at(at))
        .zip(names.iter().map(|name| text_width(name, Map::NAME.size)))
        .collect();
    for ((anchor, point), name) in placed(&discs, radius).into_iter().zip(&names) {
        canvas.text_on_lines(point, Map::NAME.anchored(anchor), name);
    }
}

/// Where the names stand of discs with these centres, whose names have these widths.
fn placed(discs: &[(Point, f64)], radius: f64) -> Vec<(Anchor, Point)> {
    let disc = |&((x, y), _): &(Point, f64)| [x - radius, y - radius, x + radius, y + radius];
    let mut taken: Vec<Extent> = discs.iter().map(disc).collect();
    let place = |&(centre, width): &(Point, f64)| {
        let places = places(centre, radius);
        let is_free = |place: &&(Anchor, Point)| {
            let covered = extent(**place, width);
            taken.iter().all(|other| !overlap(&covered, other))
        };
        let place = *places.iter().find(is_free).unwrap_or(&places[0]);
        taken.push(extent(place, width));
        place
    };
    discs.iter().map(place).collect()
}

/// Where the name of a vertiport may stand, the best place first.
fn places((x, y): Point, radius: f64) -> [(Anchor, Point); 4] {
    let away = radius + GAP;
    let height = CAPITALS * Map::NAME.size;
    [
        (Anchor::Middle, (x, y - away)),
        (Anchor::Middle, (x, y + away + height)),
        (Anchor::Start, (x + away, y + height / 2.0)),
        (Anchor::End, (x - away, y + height / 2.0)),
    ]
}

/// The area that a text of this width covers, with its line at the point.
fn extent((anchor, (x, y)): (Anchor, Point), width: f64) -> Extent {
    let left = match anchor {
        Anchor::Start => x,
        Anchor::Middle => x - width / 2.0,
        Anchor::End => x - width,
    };
    [left, y - CAPITALS * Map::NAME.size, left + width, y]
}

fn overlap(one: &Extent, other: &Extent) -> bool {
    one[0] < other[2] && other[0] < one[2] && one[1] < other[3] && other[1] < one[3]
}

#[cfg(test)]
mod tests {
    use super::{GAP, extent, overlap, placed, places};

    const RADIUS: f64 = 7.0;
    const WIDTH: f64 = 30.0;

    #[test]
    fn a_name_stands_beside_its_disc() {
        let disc = [93.0, 93.0, 107.0, 107.0];
        for place in places((100.0, 100.0), RADIUS) {
            let [left, top, right, bottom] = extent(place, WIDTH);
            let gaps = [disc[0] - right, left - disc[2], disc[1] - bottom, top - disc[3]];
            let gap = gaps.into_iter().fold(f64::NEG_INFINITY, f64::max);
            assert!((gap - GAP).abs() < 1e-9, "{place:?}");
        }
    }

    #[test]
    fn names_of_neighbours_cover_neither_each_other_nor_a_disc() {
        for (east, south) in [(0.0, 16.0), (0.0, -16.0), (20.0, 0.0), (3.0, 25.0), (40.0, 40.0)] {
            let centres = [(100.0, 100.0), (100.0 + east, 100.0 + south)];
            let placed = placed(&centres.map(|centre| (centre, WIDTH)), RADIUS);
            let [one, other] = [0, 1].map(|at| extent(placed[at], WIDTH));
            assert!(!overlap(&one, &other), "{east} {south}: {placed:?}");
            for (x, y) in centres {
                let disc = [x - RADIUS, y - RADIUS, x + RADIUS, y + RADIUS];
                assert!(!overlap(&one, &disc) && !overlap(&other, &disc), "{east} {south}");
            }
        }
    }
}
