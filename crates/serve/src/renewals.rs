//! Recomputes prices in the background while the service is busy, and with less effort: until then,
//! decisions use the old ones. While it is not busy, a decision recomputes them, so that a day that
//! is dispatched alone ends as in the simulator, to the last digit.

use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use vertifleet_policy::{Policy, PriceMemory};
use vertifleet_sim::{Decision, Simulation};

use crate::clock::LastTime;

/// How long the service counts as busy after a decision had to wait.
const BUSY: Duration = Duration::from_secs(1);

/// A thread that recomputes prices, one day after the other.
#[derive(Debug)]
pub(crate) struct Renewals {
    queue: mpsc::Sender<Renewal>,
    /// When a decision last had to wait for others.
    awaited: LastTime,
}

/// The prices of a day that are to be recomputed.
struct Renewal {
    memory: PriceMemory,
    day: Simulation,
    decision: Decision,
    found: mpsc::Sender<PriceMemory>,
}

impl Renewals {
    /// Starts the thread. It ends when this is dropped.
    pub(crate) fn start() -> Self {
        let (queue, asked) = mpsc::channel::<Renewal>();
        thread::spawn(move || {
            for Renewal { mut memory, day, decision, found } in asked {
                memory.refresh_briefly(day.view(), &decision);
                // The policy may have recomputed them in the meantime.
                let _ = found.send(memory);
            }
        });
        Self { queue, awaited: LastTime::default() }
    }

    /// This, if the service is busy: a decision is waiting for others, or was a moment ago.
    pub(crate) fn if_busy(&self, is_awaited: bool) -> Option<&Self> {
        if is_awaited {
            self.awaited.is_now();
        }
        self.awaited.was_within(BUSY).then_some(self)
    }
}

/// The prices of a policy that are being recomputed, if any are.
#[derive(Debug, Default)]
pub(crate) struct Renewing(Option<mpsc::Receiver<PriceMemory>>);

impl Renewing {
    /// Call this before each decision. It applies prices that were recomputed, and if the service
    /// is busy, starts to recompute old ones in the background.
    pub(crate) fn before(
        &mut self,
        policy: &mut dyn Policy,
        day: &Simulation,
        decision: &Decision,
        busy: Option<&Renewals>,
    ) {
        let Some(memory) = policy.price_memory() else { return };
        if let Some(Ok(found)) = self.0.as_ref().map(mpsc::Receiver::try_recv) {
            *memory = found;
            self.0 = None;
        }
        memory.keep_old(false);
        let Some(renewals) = busy.filter(|_| memory.is_merely_old(day.view(), decision)) else {
            // The decision recomputes prices if they are due, so that those computed before it are
            // of no use.
            self.0 = None;
            return;
        };
        if self.0.is_none() {
            let (found, pending) = mpsc::channel();
            let (memory, day, decision) = (memory.clone(), day.clone(), *decision);
            // Without the thread, which only a panic ends, the decision recomputes them.
            if renewals.queue.send(Renewal { memory, day, decision, found }).is_ok() {
                self.0 = Some(pending);
            }
        }
        memory.keep_old(self.0.is_some());
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use vertifleet_core::{DaySeed, Network};
    use vertifleet_policy::{BidPricePolicy, Policy as _, play};
    use vertifleet_sim::Simulation;

    use super::{Renewals, Renewing};

    fn day() -> Simulation {
        let network = Network::shipped("paper").expect("it is shipped");
        Simulation::new(Arc::new(network.draw(DaySeed::validation(2).expect("a seed"))))
    }

    /// Plays a day and returns its profit. `is_busy` returns for each decision whether the service
    /// is busy; recomputed prices arrive before the tenth decision after that.
    fn profit_usd(is_busy: impl Fn(u32) -> bool) -> f64 {
        let (renewals, mut renewing) = (Renewals::start(), Renewing::default());
        let (mut policy, mut day) = (BidPricePolicy::default(), day());
        let mut kept = 0;
        while let Some(decision) = day.next_decision() {
            let busy = is_busy(decision.index).then_some(&renewals);
            renewing.before(&mut policy, &day, &decision, busy);
            let choice = policy.choose(&decision, &day.view()).expect("it has an answer");
            day.apply(choice).expect("it is feasible");
            kept += u32::from(renewing.0.is_some());
            if kept == 10
                && let Some(pending) = renewing.0.take()
            {
                *policy.price_memory().expect("it has prices") =
                    pending.recv().expect("they are found");
                kept = 0;
            }
        }
        day.totals().profit_usd
    }

    #[test]
    fn a_day_ends_as_in_the_simulator_while_the_service_is_not_busy() {
        let mut simulated = day();
        play(&mut simulated, &mut BidPricePolicy::default(), |_| ()).expect("it is played");
        let simulated_usd = simulated.totals().profit_usd;
        assert_eq!(profit_usd(|_| false).to_bits(), simulated_usd.to_bits());
        // While it is busy, the day is still played, nearly as well.
        for busy_usd in [profit_usd(|_| true), profit_usd(|decision| decision.is_multiple_of(3))] {
            assert!(busy_usd > 0.98 * simulated_usd, "{busy_usd} of {simulated_usd}");
        }
    }
}
