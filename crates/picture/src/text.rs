//! The fleet at one moment as text for a terminal.

use std::fmt::Write as _;

use vertifleet_core::{Scenario, VertiportIx};

use crate::map::room;
use crate::moment::Moment;
use crate::numbers::grouped;

/// A table of the vertiports: aircraft that stand there and are on their way to it, its stands, and
/// its waiting passengers. The vertiport of the aircraft that decides is marked. There is no line
/// end after the last line.
pub fn text(day: &Scenario, moment: &Moment, deciding: Option<VertiportIx>) -> String {
    let mut text = format!(
        "{} {}  profit {} $  {} flights  {} passengers\n",
        day.name,
        moment.time,
        grouped(moment.profit_usd, 0),
        grouped(f64::from(moment.flights), 0),
        grouped(moment.passengers as f64, 0)
    );
    let letters = day.vertiports.iter().map(|one| one.id.chars().count());
    let width = letters.max().unwrap_or(0).max("vertiport".len());
    let _ = write!(text, "  {:width$}  standing  coming  stands  waiting", "vertiport");
    for at in VertiportIx::all(day.vertiports.len()) {
        let one = &day.vertiports[at.at()];
        let stands = room(one);
        let mark = if deciding == Some(at) { '>' } else { ' ' };
        let _ = write!(
            text,
            "\n{mark} {:width$}  {:>8}  {:>6}  {stands:>6}  {:>7}",
            one.id,
            moment.standing[at.at()],
            moment.coming[at.at()],
            moment.waiting[at.at()],
        );
    }
    text
}
