//! `rolling`: at every decision, tries out the best choices at the day's prices, and takes the one after which the fleet
//! stands best.
//!
//! A rolling horizon in two parts. To the end of the day, the fleet's programme is solved anew every quarter of an hour from
//! where it stands, is in the air and on charge, with its stands and passengers priced out ([`DayPrices`]). For the next
//! hour, each of a few choices is played out in the simulator, everybody else choosing by prices; what the fleet has earned
//! and is worth by then decides. Nothing looks at a clock, so the same day has the same outcome everywhere.

use vertifleet_core::VertiportIx;
use vertifleet_policy::{DayMemory, DayPrices, Policy, PolicyError, Shortlist, tried_out_usd};
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
    shortlist: Shortlist,
}

impl Policy for Rolling {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        let prices = self.day.of_day(*view, decision, || DayPrices::of(*view, decision.time));
        prices.keep_up(*view, decision.time);
        let tried = self.shortlist.rank(prices, *view, decision, (MOST_TRIED, TOO_BAD_USD));
        if let [(_, only)] = *tried {
            return Ok(only);
        }
        let mut best = (f64::NEG_INFINITY, decision.at);
        for &(priced_usd, to) in tried {
            // Each says what the choice is worth to the fleet: one looks at everybody for an hour, one at the aircraft alone.
            let usd = priced_usd
                + tried_out_usd(prices, (*view, decision), to, HORIZON_S, |view, decision| {
                    prices.best_choice(view, decision)
                });
            if usd > best.0 {
                best = (usd, to);
            }
        }
        Ok(best.1)
    }
}
