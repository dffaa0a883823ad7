//! `rolling`: plans the rest of the day anew whenever an aircraft decides, and flies the first flight of that plan.
//!
//! A rolling horizon whose end is the day's: the forecast reaches that far, and shorter horizons earned less. The plan is
//! [`plan_ahead`]'s, from the fleet as it stands, is in the air and on charge, and with the demand that the view forecasts; it
//! goes on from the plan before, which is all that the policy remembers. Aircraft that decide at one instant share a plan.
//! Planning takes a number of steps and never looks at a clock, so the same day has the same outcome everywhere.

use vertifleet_core::{Time, VertiportIx};
use vertifleet_policy::{Policy, PolicyError, draw};
use vertifleet_sim::{Decision, View};

use crate::plan::{Outlook, plan_ahead};

/// Steps of search where there is no plan to go on from: in the morning, or when a day is taken up in its middle.
const FIRST_STEPS: u64 = 4_000;
/// Steps of search where there is one. 500 earned 0.4 % less on days of `paper`.
const STEPS: u64 = 1_000;
/// What chance follows, beside day and decision.
const SEED: u64 = 0;

/// Plans ahead at every decision. Remembers one day at a time: asked about several by turns, it plans each decision as
/// though it took the day up there.
#[derive(Debug, Clone, Default)]
pub struct Rolling {
    latest: Option<Latest>,
}

/// The latest plan, and what it was made for.
#[derive(Debug, Clone)]
struct Latest {
    day_seed: u64,
    /// Index of the decision that follows the one just taken.
    next: u32,
    made_at: Time,
    outlook: Outlook,
}

impl Latest {
    /// A plan from `decision` on, continuing the one before if there is one that fits.
    fn made(decision: &Decision, view: View<'_>, before: Option<&Outlook>) -> Self {
        let day_seed = view.day_seed();
        let steps = if before.is_some() { STEPS } else { FIRST_STEPS };
        let seed = draw(SEED, day_seed, decision.index);
        let outlook = plan_ahead(view, before, steps, seed);
        Self { day_seed, next: decision.index, made_at: decision.time, outlook }
    }

    /// Whether the decision before this one of the same day was taken by this plan.
    fn leads_to(&self, decision: &Decision, view: View<'_>) -> bool {
        self.day_seed == view.day_seed() && self.next == decision.index
    }

    fn choice(&self, decision: &Decision) -> VertiportIx {
        self.outlook.choice(decision.aircraft, decision.at, decision.time)
    }

    /// Whether the plan was made at this instant and can still be followed.
    fn holds(&self, decision: &Decision, view: View<'_>) -> bool {
        self.made_at == decision.time && view.feasible(decision).contains(self.choice(decision))
    }
}

impl Policy for Rolling {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        // A day's first decision follows none, so nothing of another day is ever taken over.
        let before = self
            .latest
            .take()
            .filter(|latest| decision.index > 0 && latest.leads_to(decision, *view));
        let mut latest = match before {
            Some(latest) if latest.holds(decision, *view) => latest,
            before => {
                let before = before.as_ref().map(|latest| &latest.outlook);
                Latest::made(decision, *view, before)
            }
        };
        // A plan does not know of separate chargers, and may count on a place that is not free.
        let mask = view.feasible(decision);
        let choice = Some(latest.choice(decision)).filter(|&choice| mask.contains(choice));
        latest.next = decision.index + 1;
        self.latest = Some(latest);
        Ok(choice.unwrap_or(decision.at))
    }
}
