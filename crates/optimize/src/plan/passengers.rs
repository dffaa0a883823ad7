//! The passengers whom the flights of a schedule carry. The margin of one flight more or less is
//! exact for any order in which flights are entered.
//!
//! Those of a pair and period are min(demand, seats of its flights) in total, whichever flight they
//! board. Where passengers wait into the next period, flights of its first seconds take those who
//! have waited first, so what a flight carries depends on the flights of the period before, and a
//! flight more or less changes what later ones carry.

use super::day::Day;

/// The passengers of every pair and period.
#[derive(Debug, Clone)]
pub(super) enum Passengers {
    /// On a day on which they do not wait: demand less seats flown, by cell; negative where seats
    /// stay empty.
    Leave(Vec<i64>),
    Wait(Waiting),
}

/// The passengers of a day on which they wait.
#[derive(Debug, Clone)]
pub(super) struct Waiting {
    demand: Vec<i64>,
    /// By cell: seats flown while passengers of the period before wait, and later.
    seats: Vec<Seats>,
    /// By cell: those of its period who have not been carried when it ends.
    left_over: Vec<i64>,
    /// Memory for the cells that a change has an effect on.
    changed: Vec<(usize, i64)>,
}

#[derive(Debug, Clone, Copy, Default)]
struct Seats {
    early: i64,
    late: i64,
}

/// The flights of a pair that take off at one time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Departure {
    /// The [cell](Day::cell) of their pair and period.
    pub(super) cell: usize,
    pub(super) period: usize,
    pub(super) take_off_s: u32,
}

impl Departure {
    /// Whether the flights take off while passengers of the period before may wait.
    #[inline]
    pub(super) fn is_early(self, day: &Day) -> bool {
        let Self { period, take_off_s, .. } = self;
        period > 0 && take_off_s < day.period_starts_s[period] + day.passenger_wait_s
    }
}

impl Passengers {
    /// Those who are not carried, by cell.
    pub(super) fn left(&self, day: &Day) -> Vec<u32> {
        let whole = |left: i64| u32::try_from(left.max(0)).expect("no more than there were");
        match self {
            Self::Leave(left) => left.iter().map(|&left| whole(left)).collect(),
            Self::Wait(waiting) => waiting.left(day).map(whole).collect(),
        }
    }

    /// The passengers of a day without flights.
    pub(super) fn of(day: &Day, demand: &[u32]) -> Self {
        let demand: Vec<i64> = demand.iter().map(|&passengers| passengers.into()).collect();
        if day.passenger_wait_s == 0 {
            return Self::Leave(demand);
        }
        let (seats, left_over) = (vec![Seats::default(); demand.len()], demand.clone());
        Self::Wait(Waiting { demand, seats, left_over, changed: Vec::new() })
    }

    /// The amount that one more flight with this number of seats would bring beyond the costs of
    /// its passengers, dollars.
    #[inline]
    pub(super) fn margin_usd(&self, day: &Day, departure: Departure, seats: i64) -> f64 {
        match self {
            Self::Leave(left) => {
                left[departure.cell].clamp(0, seats) as f64 * day.margin_usd(departure.cell)
            }
            Self::Wait(waiting) => waiting.change_usd(day, departure, seats, |_, _| ()),
        }
    }

    /// Adds `seats` to the flights of a pair, or removes them if negative. Returns by how much the
    /// margin of all passengers grows, dollars.
    pub(super) fn add(&mut self, day: &Day, departure: Departure, seats: i64) -> f64 {
        match self {
            Self::Leave(left) => {
                let left = &mut left[departure.cell];
                let before = *left;
                *left -= seats;
                (before.max(0) - (*left).max(0)) as f64 * day.margin_usd(departure.cell)
            }
            Self::Wait(waiting) => waiting.add(day, departure, seats),
        }
    }
}

impl Waiting {
    /// Those of each cell who are left over when its period ends, less those whom flights of the
    /// next one carry.
    fn left(&self, day: &Day) -> impl Iterator<Item = i64> {
        let next = self.seats.iter().skip(day.vertiports * day.vertiports);
        let early = next.map(|seats| seats.early).chain(std::iter::repeat(0));
        self.left_over.iter().zip(early).map(|(&left_over, early)| left_over - left_over.min(early))
    }

    fn add(&mut self, day: &Day, departure: Departure, seats: i64) -> f64 {
        let mut changed = std::mem::take(&mut self.changed);
        changed.clear();
        let usd = self.change_usd(day, departure, seats, |cell, left| changed.push((cell, left)));
        for &(cell, left_over) in &changed {
            self.left_over[cell] = left_over;
        }
        self.changed = changed;
        self.seats[departure.cell].add(day, departure, seats);
        usd
    }

    /// By how much the margin of all passengers grows with `seats` more, dollars. Calls `see` with
    /// each cell on which this has an effect, and those of it who are then left over.
    fn change_usd(
        &self,
        day: &Day,
        departure: Departure,
        seats: i64,
        mut see: impl FnMut(usize, i64),
    ) -> f64 {
        let pairs = day.vertiports * day.vertiports;
        let mut cell = departure.cell;
        let waited = cell.checked_sub(pairs).map_or(0, |before| self.left_over[before]);
        let (mut waited_now, mut waited_then) = (waited, waited);
        let mut seats_then = self.seats[cell];
        seats_then.add(day, departure, seats);
        let mut usd = 0.0;
        loop {
            let now = self.carried(cell, waited_now, self.seats[cell]);
            let then = self.carried(cell, waited_then, seats_then);
            usd += (then.passengers - now.passengers) as f64 * day.margin_usd(cell);
            see(cell, then.left_over);
            (waited_now, waited_then) = (now.left_over, then.left_over);
            cell += pairs;
            if waited_now == waited_then || cell >= self.seats.len() {
                return usd;
            }
            seats_then = self.seats[cell];
        }
    }

    /// The passengers on the flights of a cell, of whom `waited` wanted to fly in the period
    /// before.
    fn carried(&self, cell: usize, waited: i64, seats: Seats) -> Carried {
        let of_before = waited.min(seats.early);
        let early = self.demand[cell].min(seats.early - of_before);
        let late = (self.demand[cell] - early).min(seats.late);
        Carried {
            passengers: of_before + early + late,
            left_over: self.demand[cell] - early - late,
        }
    }
}

/// The loads of the flights of a pair and period, and the passengers of the period who are left
/// over.
struct Carried {
    passengers: i64,
    left_over: i64,
}

impl Seats {
    fn add(&mut self, day: &Day, departure: Departure, seats: i64) {
        if departure.is_early(day) {
            self.early += seats;
        } else {
            self.late += seats;
        }
    }
}
