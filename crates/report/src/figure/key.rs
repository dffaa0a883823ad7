//! The places of the names in a key: side by side, in as many rows as they need.

use vertifleet_picture::canvas::{Point, text_width};

/// The left end of every row.
const LEFT: f64 = 16.0;
/// The middle of the first row.
const TOP: f64 = 72.0;
const ROW: f64 = 22.0;

/// The position at which each name's mark begins, and the middle of the last row. A mark has the
/// width `mark`, the picture the width `width`.
pub(super) fn places(names: &[String], mark: f64, width: f64) -> (Vec<Point>, f64) {
    let (mut x, mut y) = (LEFT, TOP);
    let mut places = Vec::with_capacity(names.len());
    for name in names {
        let room = mark + text_width(name, 13.0) + 24.0;
        if x > LEFT && x + room > width {
            (x, y) = (LEFT, y + ROW);
        }
        places.push((x, y));
        x += room;
    }
    (places, y)
}
