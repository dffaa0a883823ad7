//! Panels of a picture: an area with a heading, and scales of time and of counts.

use std::fmt::Write as _;

use vertifleet_core::{Scenario, Time};

use crate::axis::Scale;
use crate::canvas::{Anchor, Canvas, Lettering, Look, Stroke, pixels};
use crate::map::Area;
use crate::numbers::grouped;
use crate::palette::Paint;

const HOUR_S: u32 = 3_600;
/// Room for the label of an hour, pixels.
const LABEL_WIDTH: f64 = 42.0;

/// A heading above an area.
pub(crate) fn heading(canvas: &mut Canvas, area: Area, text: &str) {
    let lettering = Lettering { size: 13.0, ..Lettering::LABEL.bold() };
    canvas.text((area.left, area.top - 8.0), lettering, text);
}

/// The pixels of times in an area.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Clock {
    area: Area,
    start_s: u32,
    end_s: u32,
}

impl Clock {
    /// A scale from the start of operations to `end`.
    pub(crate) fn of(day: &Scenario, end: Time, area: Area) -> Self {
        let start_s = day.operations.start.seconds();
        Self { area, start_s, end_s: end.seconds().max(start_s + 1) }
    }

    pub(crate) fn area(&self) -> Area {
        self.area
    }

    pub(crate) fn end(&self) -> Time {
        Time::from_seconds(self.end_s)
    }

    pub(crate) fn pixel(&self, time: Time) -> f64 {
        let passed = f64::from(time.seconds().saturating_sub(self.start_s));
        let share = passed / f64::from(self.end_s - self.start_s);
        self.area.left + share.min(1.0) * self.area.width
    }

    /// Lines at full hours, with labels below the area.
    pub(crate) fn draw(&self, canvas: &mut Canvas) {
        let hours = f64::from(self.end_s - self.start_s) / f64::from(HOUR_S);
        let fits = |every: &usize| self.area.width / hours * *every as f64 >= LABEL_WIDTH;
        let every = [1, 2, 3, 4, 6, 12].into_iter().find(fits).unwrap_or(24);
        let first = self.start_s.div_ceil(HOUR_S);
        for hour in (first..=self.end_s / HOUR_S).step_by(every) {
            let x = self.pixel(Time::from_seconds(hour * HOUR_S));
            let stroke = Stroke::solid(Paint::Grid, 1.0);
            canvas.line((x, self.area.top), (x, self.area.bottom()), stroke);
            let label = Lettering { size: 11.0, ..Lettering::SMALL }.anchored(Anchor::Middle);
            canvas.text((x, self.area.bottom() + 14.0), label, &format!("{hour}:00"));
        }
    }
}

/// Counts upward in an area, with lines at round values.
pub(crate) fn counts(canvas: &mut Canvas, area: Area, values: impl Iterator<Item = f64>) -> Scale {
    let most = values.fold(0.0, f64::max);
    // Without aircraft the scale is empty and ends at 1.
    let most = if most > 0.0 { most } else { 1.0 };
    let scale = Scale::from_zero([most].into_iter(), area.bottom(), area.top, 4);
    for tick in scale.ticks() {
        let y = scale.pixel(tick);
        canvas.line((area.left, y), (area.right(), y), Stroke::solid(Paint::Grid, 1.0));
        let label = Lettering { size: 11.0, ..Lettering::SMALL }.anchored(Anchor::End);
        canvas.text((area.left - 6.0, y + 4.0), label, &grouped(tick, scale.decimals(1.0)));
    }
    scale
}

/// Rectangles that look alike, written as one path.
#[derive(Debug, Default)]
pub(crate) struct Blocks(String);

impl Blocks {
    pub(crate) fn add(&mut self, (x, y): (f64, f64), (width, height): (f64, f64)) {
        let (x, y, width, height) = (pixels(x), pixels(y), pixels(width), pixels(height));
        write!(self.0, "M{x} {y}h{width}v{height}h-{width}z").expect("memory takes everything");
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn draw(&self, canvas: &mut Canvas, look: Look) {
        if !self.is_empty() {
            canvas.path(&self.0, look);
        }
    }
}

/// Marks with their names, side by side below an area.
pub(crate) fn key(canvas: &mut Canvas, (mut x, y): (f64, f64), entries: &[(Look, &str)]) {
    for (look, name) in entries {
        canvas.rectangle((x, y - 9.0), (12.0, 10.0), *look);
        canvas.text((x + 18.0, y), Lettering { size: 11.0, ..Lettering::SMALL }, name);
        x += 18.0 + crate::canvas::text_width(name, 11.0) + 18.0;
    }
}
