//! The certificate: prices prove a bound, in whole numbers, whoever found them.
//!
//! Let aircraft pay for the stands that they take and for the passengers that they carry, and give every stand and every
//! passenger its price back once. A schedule that keeps to the limits pays no more than is given back. So what is given back,
//! plus the most that each aircraft can earn for itself at these prices, is at least what any schedule earns (Lagrangian
//! relaxation; docs/src/concepts/bound.md has the proof). The most that an aircraft can earn is a longest path through
//! vertiports and whole seconds, found from the end of the day back to its start; flights and holds last exactly as long
//! there as in the simulator.

use super::network::{Flight, Network};
use super::prices::{Excess, Prices};

/// What prices prove, and what each aircraft would do at them. Evaluated again and again without a new allocation.
#[derive(Debug, Clone)]
pub(super) struct Certificate {
    /// What a stand has cost from the first slice until each slice begins and the last one ends, by slice, then vertiport.
    paid: Vec<i64>,
    /// What it is worth to be ready, *less* what the stand has cost since the day began, so that what an aircraft pays from
    /// one second to another is one subtraction; by layer, vertiport, second of the day.
    ///
    /// A day has at most 5,762 slices (36 hours in minutes, 1,440 more where periods begin, and 2,161 where slots of delays
    /// do), an aircraft flies at most 2,161 times, a flight earns at most 1,000 x 10^12, and a stand costs at most 10^14 a slice: all is below 2^62.
    worth_less_paid: Vec<i64>,
    /// The best for each second of a piece of a slice.
    best: Vec<i64>,
}

impl Certificate {
    /// Room for the evaluations of a network.
    pub(super) fn new(network: &Network) -> Self {
        let places = network.layers.len() * network.size();
        Self {
            paid: Vec::with_capacity((network.slices.len() + 1) * network.size()),
            worth_less_paid: vec![0; places * network.slices.day_s() as usize],
            best: Vec::with_capacity(network.shortest_s as usize),
        }
    }

    /// Works out what `prices` prove: no schedule earns more than so many micro-dollars.
    pub(super) fn evaluate(&mut self, network: &Network, prices: &Prices) -> i128 {
        self.pay(network, prices);
        let day_s = network.slices.day_s() as usize;
        let mut worths = std::mem::take(&mut self.worth_less_paid);
        for (layer, worths) in worths.chunks_exact_mut(day_s * network.size()).enumerate() {
            for slice in (0..network.slices.len()).rev() {
                self.work_out_slice(network, prices, layer, slice, worths);
            }
        }
        self.worth_less_paid = worths;
        self.fleet(network) + given_back(network, prices)
    }

    /// What being ready is worth, micro-dollars; `second` counts from the first take-off time.
    pub(super) fn worth(&self, network: &Network, layer: usize, at: usize, second: usize) -> i64 {
        let slice = network.slices.containing(network.slices.start_s(0) + small(second));
        self.worth_less_paid(network, layer, at, second) + self.paid(network, slice, at)
    }

    fn pay(&mut self, network: &Network, prices: &Prices) {
        self.paid.clear();
        self.paid.resize(network.size(), 0);
        for (at, price) in prices.stand.iter().enumerate() {
            self.paid.push(self.paid[at] + price);
        }
    }

    fn paid(&self, network: &Network, slice: usize, at: usize) -> i64 {
        self.paid[slice * network.size() + at]
    }

    /// Past the last take-off time there is nothing to earn, and the stand is paid for until the last slice ends.
    fn worth_less_paid(&self, network: &Network, layer: usize, at: usize, second: usize) -> i64 {
        let day_s = network.slices.day_s() as usize;
        if second >= day_s {
            return -self.paid(network, network.slices.len(), at);
        }
        self.worth_less_paid[(layer * network.size() + at) * day_s + second]
    }

    /// Works out one slice of a layer from the slices after it.
    fn work_out_slice(
        &mut self,
        network: &Network,
        prices: &Prices,
        layer: usize,
        slice: usize,
        worths: &mut [i64],
    ) {
        let slices = &network.slices;
        let first = (slices.start_s(slice) - slices.start_s(0)) as usize;
        let mut past = (slices.start_s(slice + 1) - slices.start_s(0)) as usize;
        while past > first {
            // No flight and no hold begins and ends in the same piece: all that a piece needs is known.
            let begin = first.max(past.saturating_sub(network.shortest_s as usize));
            for from in 0..network.size() {
                let mut best = std::mem::take(&mut self.best);
                best.clear();
                best.resize(past - begin, i64::MIN);
                let stays = self.paid(network, slice, from);
                self.raise(
                    &mut best,
                    network,
                    worths,
                    from,
                    begin + network.hold_s as usize,
                    stays,
                );
                for flight in network.flights(slice, layer, from) {
                    let to = flight.to.at();
                    let flies = earnings(network, prices, flight) + self.paid(network, slice, to);
                    self.raise(
                        &mut best,
                        network,
                        worths,
                        to,
                        begin + flight.block_s as usize,
                        flies,
                    );
                }
                let day_s = slices.day_s() as usize;
                let known = &mut worths[from * day_s..][begin..past];
                for (known, best) in known.iter_mut().zip(&best) {
                    *known = best - stays;
                }
                if network.layers[layer].waits_freely {
                    let own = &mut worths[from * day_s..][..day_s];
                    let over = -self.paid(network, slices.len(), from);
                    let afterwards = own.get(past).copied().unwrap_or(over);
                    wait_freely(&mut own[begin..past], afterwards);
                }
                self.best = best;
            }
            past = begin;
        }
    }

    /// Raises each entry of `best` to what another choice is worth: `gain`, and the worth at `to` from `ready` on.
    fn raise(
        &self,
        best: &mut [i64],
        network: &Network,
        worths: &[i64],
        to: usize,
        ready: usize,
        gain: i64,
    ) {
        let day_s = network.slices.day_s() as usize;
        let worths = worths[to * day_s..][..day_s].get(ready..).unwrap_or(&[]);
        let (in_time, late) = best.split_at_mut(worths.len().min(best.len()));
        for (best, worth) in in_time.iter_mut().zip(worths) {
            *best = (*best).max(gain + worth);
        }
        let over = gain - self.paid(network, network.slices.len(), to);
        for best in late {
            *best = (*best).max(over);
        }
    }

    /// What the whole fleet earns for itself; nothing has been paid when the day begins.
    fn fleet(&self, network: &Network) -> i128 {
        let starts = network.layers.iter().flat_map(|layer| &layer.starts);
        let worths = self.worth_less_paid.iter().step_by(network.slices.day_s() as usize);
        starts.zip(worths).map(|(&count, &worth)| i128::from(count) * i128::from(worth)).sum()
    }

    /// What is wanted too much or too little if each aircraft takes the way that is worth most to it, at the prices that
    /// were evaluated last. Among equal ways the first flight in file order goes first, a hold last; who
    /// may wait freely waits as long as that is as good.
    pub(super) fn excess(&self, network: &Network, prices: &Prices, excess: &mut Excess) {
        *excess = Excess::of_nobody(network);
        for (layer, kind) in network.layers.iter().enumerate() {
            for (at, &count) in kind.starts.iter().enumerate().filter(|(_, count)| **count > 0) {
                self.walk(network, prices, layer, at, f64::from(count), excess);
            }
        }
    }

    /// Until when an aircraft that may wait freely does so: as long as being ready is worth as much later.
    fn waits_until(&self, network: &Network, layer: usize, at: usize, mut second: usize) -> usize {
        let day_s = network.slices.day_s() as usize;
        let worth = |second| self.worth_less_paid(network, layer, at, second);
        while network.layers[layer].waits_freely
            && second < day_s
            && worth(second) == worth(second + 1)
        {
            second += 1;
        }
        second
    }

    /// The first flight in file order that is worth as much as being ready at a place, second and slice is.
    fn best_flight<'a>(
        &self,
        network: &'a Network,
        prices: &Prices,
        layer: usize,
        (at, second, slice): (usize, usize, usize),
    ) -> Option<&'a Flight> {
        let here = self.worth_less_paid(network, layer, at, second) + self.paid(network, slice, at);
        network.flights(slice, layer, at).iter().find(|flight| {
            let (to, ready) = (flight.to.at(), second + flight.block_s as usize);
            let goes_on = self.worth_less_paid(network, layer, to, ready);
            here == earnings(network, prices, flight) + self.paid(network, slice, to) + goes_on
        })
    }

    /// Follows the best way of `count` aircraft that start at `at`.
    fn walk(
        &self,
        network: &Network,
        prices: &Prices,
        layer: usize,
        mut at: usize,
        count: f64,
        excess: &mut Excess,
    ) {
        let slices = &network.slices;
        let (mut second, mut slice) = (0, 0);
        while slice < slices.len() {
            let leaves = self.waits_until(network, layer, at, second);
            if leaves > second {
                second = leaves;
            } else if let Some(flight) =
                self.best_flight(network, prices, layer, (at, second, slice))
            {
                excess.demand[flight.cell as usize] += count * f64::from(flight.passengers);
                at = flight.to.at();
                second += flight.block_s as usize;
            } else {
                second += network.hold_s as usize;
            }
            let until = slices.containing(slices.start_s(0).saturating_add(small(second)));
            for taken in slice..until {
                excess.stand[taken * network.size() + at] += count;
            }
            slice = until;
        }
    }
}

/// Being ready is worth no less than being ready a second later at the same place: less what stands have cost, waiting costs
/// nothing. `later` is the worth after the last of these seconds.
fn wait_freely(worths: &mut [i64], mut later: i64) {
    for worth in worths.iter_mut().rev() {
        later = later.max(*worth);
        *worth = later;
    }
}

/// What a flight earns at most after it has paid for its passengers.
fn earnings(network: &Network, prices: &Prices, flight: &Flight) -> i64 {
    let cell = flight.cell as usize;
    let a_passenger = network.margin[cell] - prices.demand[cell];
    i64::from(flight.passengers) * a_passenger - flight.energy_cost
}

/// What all stands and all passengers cost together.
fn given_back(network: &Network, prices: &Prices) -> i128 {
    let stands = network.stands.iter().cycle().zip(&prices.stand);
    let all = stands.chain(network.demand.iter().zip(&prices.demand));
    all.map(|(&count, &price)| i128::from(count) * i128::from(price)).sum()
}

fn small(second: usize) -> u32 {
    u32::try_from(second).expect("a day's seconds, and those of one flight more")
}
