//! Which flights the passengers of a part of the market buy: those that leave them the most after
//! they have paid.
//!
//! Where all flights of a cell have one price, that is a formula. Otherwise it is enumerated: the
//! cheapest flights for every number of seats, and, where passengers wait, the best of every period
//! by the number of those who were left behind in the one before.

use super::{Bought, Market, Part, compact};

/// The most passengers of a cell for whom flights of several sizes are enumerated. With more, there
/// are enough flights for fractions of flights to make little difference.
pub(super) const MOST_ENUMERATED: u32 = 300;
/// The same of two periods together where passengers wait, which takes time in proportion to the
/// square. Enumerating the 80 of `paper` made its bound 15 times as slow and 0.05 % tighter.
pub(super) const MOST_WAITING: u32 = 60;
/// The price of what cannot be bought. The sum of a few of them is in `i64`.
const UNAFFORDABLE: i64 = i64::MAX / 8;

/// The cheapest flights for any number of seats.
struct Offers {
    /// The position of the price, the seats and the price of each size of flights.
    flights: Vec<(u32, usize, i64)>,
    /// By seats, micro-dollars.
    cost: Vec<i64>,
}

impl Offers {
    /// Adds the cheapest flights with at least this number of seats.
    fn flights_for(&self, mut seats: usize, bought: &mut Bought) {
        while seats > 0 {
            let cheapest = self.flights.iter().find(|&&(_, of_flight, price)| {
                self.cost[seats] == price + self.cost[seats.saturating_sub(of_flight)]
            });
            let &(position, of_flight, _) = cheapest.expect("these seats can be bought");
            match bought.iter_mut().find(|(other, _)| *other == position) {
                Some((_, number)) => *number += 1.0,
                None => bought.push((position, 1.0)),
            }
            seats = seats.saturating_sub(of_flight);
        }
    }
}

/// The choices of the passengers of a cell.
#[derive(Debug, Clone, Copy, Default)]
struct Choice {
    /// Those who board and have waited, and the others who board.
    waited: usize,
    others: usize,
    /// The seats that are bought early in the period. The rest is bought late.
    early_seats: usize,
    /// Those who wait for the next period.
    left: usize,
}

impl Choice {
    fn boarding(self) -> usize {
        self.waited + self.others
    }
}

/// The best of a cell and of all later ones, by the number who have waited for it.
struct PeriodPlan {
    surplus: Vec<i64>,
    choices: Vec<Choice>,
    early: Offers,
    late: Offers,
}

impl Market {
    /// The surplus of a block, if `one_more` passenger of a cell wants to fly, and the flights that
    /// are bought for it.
    pub(in crate::bound) fn buy(
        &self,
        block: usize,
        prices: &[i64],
        one_more: Option<usize>,
    ) -> (i128, Bought) {
        let cells: Vec<usize> = self.cells_of(block).collect();
        let passengers: Vec<u32> = cells
            .iter()
            .map(|&cell| self.passengers[cell].saturating_add((one_more == Some(cell)).into()))
            .collect();
        if self.has_one_price_a_cell() {
            return self.buy_alike(block, passengers[0], prices[block]);
        }
        // One more passenger never changes the method, so that its worth is not a difference of two
        // methods.
        let waiting = |period: usize| {
            let before = period.checked_sub(1).map_or(0, |before| self.passengers[cells[before]]);
            before.saturating_add(self.passengers[cells[period]])
        };
        let most = if self.waits { MOST_WAITING } else { MOST_ENUMERATED };
        if (0..cells.len()).any(|period| waiting(period) > most) {
            return self.buy_fractions(&cells, &passengers, prices);
        }
        let (mut seen, mut after) = (Vec::with_capacity(cells.len()), vec![0; 1]);
        for period in (0..cells.len()).rev() {
            let before = if period > 0 { passengers[period - 1] } else { 0 };
            let own = passengers[period];
            after.resize(own as usize + 1, 0);
            let plan = self.best_by_waiting(cells[period], (before, own), &after, prices);
            after.clone_from(&plan.surplus);
            seen.push(plan);
        }
        seen.reverse();
        let surplus = i128::from(after[0]);
        let (mut bought, mut waiting) = (Bought::new(), 0);
        for plan in &seen {
            let choice = plan.choices[waiting];
            plan.early.flights_for(choice.early_seats, &mut bought);
            plan.late.flights_for(choice.boarding() - choice.early_seats, &mut bought);
            waiting = choice.left;
        }
        (surplus, bought)
    }

    /// The surplus of a cell whose flights all have one price, and the flights that are bought.
    fn buy_alike(&self, cell: usize, passengers: u32, price: i64) -> (i128, Bought) {
        if !self.is_offered[cell] {
            return (0, Bought::new());
        }
        let alike = self.alike_for(cell, passengers);
        let full = if price <= alike.brings { passengers / u32::from(self.seats[0]) } else { 0 };
        let last = u32::from(price < alike.last_brings);
        (alike.surplus(price), vec![(compact(cell), f64::from(full + last))])
    }

    /// The best that passengers of a cell can do, by the number of those who have waited for it.
    /// `after` is the surplus of later periods by the number who wait for the next.
    fn best_by_waiting(
        &self,
        cell: usize,
        (before, own): (u32, u32),
        after: &[i64],
        prices: &[i64],
    ) -> PeriodPlan {
        let (before, own) = (before as usize, own as usize);
        let early = self.offers(cell, Part::Early, before + own, prices);
        let late_seats = if self.waits { own } else { 0 };
        let late = self.offers(cell, Part::Late, late_seats, prices);
        let margin = self.margin[cell];
        let infeasible = (i64::MIN, Choice::default());
        let mut best = vec![infeasible; before + 1];
        for boarding in 0..=before + own {
            // At least as many seats are bought early as passengers board who have waited.
            let (mut cost, mut bought) = (UNAFFORDABLE, 0);
            let least = (boarding + 1).saturating_sub(late.cost.len());
            let mut looked_at = boarding + 1;
            for waited in (0..=before.min(boarding)).rev() {
                while looked_at > waited.max(least) {
                    looked_at -= 1;
                    let both = early.cost[looked_at] + late.cost[boarding - looked_at];
                    if both < cost {
                        (cost, bought) = (both, looked_at);
                    }
                }
                let others = boarding - waited;
                if others <= own && cost < UNAFFORDABLE {
                    let left = own - others;
                    let brings =
                        i64::try_from(boarding).expect("few passengers are enumerated") * margin;
                    let surplus = brings - cost + after[left];
                    if surplus > best[waited].0 {
                        best[waited] =
                            (surplus, Choice { waited, others, early_seats: bought, left });
                    }
                }
            }
        }
        // Passengers who have waited need not board.
        for waited in 1..=before {
            if best[waited].0 <= best[waited - 1].0 {
                best[waited] = best[waited - 1];
            }
        }
        let (surplus, choices) = best.into_iter().unzip();
        PeriodPlan { surplus, choices, early, late }
    }

    /// The cheapest flights of a cell for any number of seats.
    fn offers(&self, cell: usize, part: Part, seats: usize, prices: &[i64]) -> Offers {
        let first = self.first_of(cell, part);
        let positions = first..first + self.seats.len();
        let offered = positions.filter(|&position| self.is_offered[position]);
        let flights: Vec<(u32, usize, i64)> = offered
            .map(|position| {
                let seats = self.seats[position - first].into();
                (compact(position), seats, prices[position])
            })
            .collect();
        let mut cost = Vec::with_capacity(seats + 1);
        cost.push(0);
        for seats in 1..=seats {
            let with = |&(_, of_flight, price): &(u32, usize, i64)| {
                price + cost[seats.saturating_sub(of_flight)]
            };
            cost.push(flights.iter().map(with).min().unwrap_or(UNAFFORDABLE));
        }
        Offers { flights, cost }
    }

    /// The surplus if every passenger may buy a seat for a fraction of the price of a flight, which
    /// is no less than that of whole flights: a flight is divided among as many passengers as can
    /// board it.
    pub(super) fn buy_fractions(
        &self,
        cells: &[usize],
        passengers: &[u32],
        prices: &[i64],
    ) -> (i128, Bought) {
        let (mut surplus, mut bought) = (0, Bought::new());
        for period in 0..cells.len() {
            let next = (period + 1 < cells.len()).then_some((period + 1, Part::Early));
            let parts = [Some((period, Part::Early)), Some((period, Part::Late)), next];
            let mut best = (0, None);
            for (flown, part) in parts.into_iter().flatten() {
                let own = passengers[flown];
                let before = flown.checked_sub(1).filter(|_| part == Part::Early);
                let boarding = own.saturating_add(before.map_or(0, |before| passengers[before]));
                for (class, &seats) in self.seats.iter().enumerate() {
                    let position = self.first_of(cells[flown], part) + class;
                    let share = boarding.min(seats.into());
                    if self.is_offered[position] && share > 0 {
                        let brings =
                            i64::from(share) * self.margin[cells[flown]] - prices[position];
                        let all = i128::from(brings) * i128::from(passengers[period]);
                        let all = (all + i128::from(share) - 1).div_euclid(i128::from(share));
                        if all > best.0 {
                            best = (all, Some((position, share)));
                        }
                    }
                }
            }
            surplus += best.0;
            if let Some((position, share)) = best.1 {
                let flights = f64::from(passengers[period]) / f64::from(share);
                bought.push((compact(position), flights));
            }
        }
        (surplus, bought)
    }
}
