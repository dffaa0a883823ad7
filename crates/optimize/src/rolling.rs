//! `rolling`: at every decision, tries out the best choices at the day's prices, and takes the one after which the fleet
//! stands best.
//!
//! A rolling horizon in two parts. To the end of the day, the fleet's programme is solved anew every quarter of an hour from
//! where it stands, is in the air and on charge, with its stands and passengers priced out ([`DayPrices`]). For the next
//! hour, each of a few choices is played out in the simulator, everybody else choosing by prices; what the fleet has earned
//! and is worth by then decides. Nothing looks at a clock, so the same day has the same outcome everywhere.

use vertifleet_core::{AircraftIx, Time, VertiportIx};
use vertifleet_policy::{DayMemory, DayPrices, Policy, PolicyError};
use vertifleet_sim::{Decision, View};

/// Choices that are tried out. More of them earned no more on days of `paper`.
const MOST_TRIED: usize = 3;
/// A choice so much worse than the best one at the prices is not tried, dollars.
const TOO_BAD_USD: f64 = 30.0;
/// How far a choice is played out, seconds. Half an hour and two hours earned as much; to the end of the day, chance
/// decides, and days earned less than without trying.
const HORIZON_S: u32 = 3_600;

/// Prices the rest of the day and tries its choices out. Remembers one day at a time.
#[derive(Debug, Clone, Default)]
pub struct Rolling {
    day: DayMemory<DayPrices>,
    /// Choices, and what they are worth at the prices.
    ranked: Vec<(f64, VertiportIx)>,
}

impl Policy for Rolling {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        let prices = self.day.of_day(*view, decision, || DayPrices::of(*view, decision.time));
        prices.keep_up(*view, decision.time);
        self.ranked.clear();
        let choices = view.feasible(decision);
        self.ranked.extend(choices.iter().map(|to| (prices.choice_usd(*view, decision, to), to)));
        // A stable sort: among equals the vertiport listed first.
        self.ranked.sort_by(|one, other| other.0.total_cmp(&one.0));
        let least_usd = self.ranked[0].0 - TOO_BAD_USD;
        let tried = self.ranked.iter().take(MOST_TRIED).filter(|choice| choice.0 >= least_usd);
        if tried.clone().count() == 1 {
            return Ok(self.ranked[0].1);
        }
        let mut best = (f64::NEG_INFINITY, decision.at);
        for &(priced_usd, to) in tried {
            // Each says what the choice is worth to the fleet: one looks at everybody for an hour, one at the aircraft alone.
            let usd = priced_usd + tried_out_usd(prices, *view, decision, to);
            if usd > best.0 {
                best = (usd, to);
            }
        }
        Ok(best.1)
    }
}

/// What the fleet has earned and is worth an hour after a choice, dollars.
fn tried_out_usd(prices: &DayPrices, view: View<'_>, decision: &Decision, to: VertiportIx) -> f64 {
    let mut imagined = view.imagined();
    let until = decision.time + HORIZON_S;
    imagined.apply(to).expect("only feasible choices are tried");
    while let Some(next) = imagined.next_decision() {
        if next.time > until {
            return imagined.ledger().profit_usd()
                + fleet_worth_usd(prices, imagined.view(), next.time);
        }
        let choice = prices.best_choice(imagined.view(), &next);
        imagined.apply(choice).expect("prices choose from the mask");
    }
    imagined.ledger().profit_usd()
}

/// What it is worth that every aircraft is where it is, less the rent of its stand until it is ready, dollars.
fn fleet_worth_usd(prices: &DayPrices, view: View<'_>, now: Time) -> f64 {
    let worth_usd = |aircraft: AircraftIx| {
        let (place, ready) = (view.places()[aircraft.at()], view.ready_at(aircraft));
        prices.worth_usd(view.kind(aircraft), place, ready) - prices.rent_usd(place, now, ready)
    };
    AircraftIx::all(view.places().len()).map(worth_usd).sum()
}
