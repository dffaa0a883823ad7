//! One day of a network, drawn from a seed: demand by Eq. 1 and start positions (§V.A).
//!
//! Each of the two has a random stream of its own, so that a change in how one is drawn leaves the other as it was. The
//! generator and the normal distribution are plain arithmetic, the same on every machine, and counts are rounded.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::{DaySeed, Matrix, Network, Scenario, Vertiport, VertiportIx};

/// What a day's random streams are for; the numbers are part of what a seed means.
#[derive(Debug, Clone, Copy)]
enum Stream {
    Demand = 1,
    StartPositions = 2,
}

impl Stream {
    fn of(self, seed: DaySeed) -> ChaCha8Rng {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.get().to_le_bytes());
        let mut random = ChaCha8Rng::from_seed(key);
        random.set_stream(self as u64);
        random
    }
}

impl Network {
    /// The day that this seed stands for, called `{network}-{seed}`. The same seed always gives the same day.
    pub fn draw(&self, seed: DaySeed) -> Scenario {
        let mut day = self.idle_day.clone().into_day();
        day.name = format!("{}-{seed}", self.name);
        day.seed = seed.get();
        self.draw_demand(&mut day.demand, &mut Stream::Demand.of(seed));
        let mut positions = StartPositions::of(&day.vertiports);
        let mut random = Stream::StartPositions.of(seed);
        for aircraft in &mut day.aircraft {
            aircraft.at = positions.next(&mut random);
        }
        // Demand is within bounds for any network that was accepted, and positions respect the stands.
        Scenario::checked(day)
    }

    /// Whether this network draws exactly this day from the day's seed: one that has been changed since does not, even
    /// if it still bears the name.
    pub fn draws(&self, day: &Scenario) -> bool {
        self.draw(DaySeed::of(day)) == *day
    }

    /// Q(i, j, t): the nearest whole number to a draw from Eq. 1, not below 0.
    fn draw_demand(&self, demand: &mut [Matrix<u32>], random: &mut ChaCha8Rng) {
        for (period, table) in demand.iter_mut().enumerate() {
            for from in VertiportIx::all(table.size()) {
                for to in VertiportIx::all(table.size()) {
                    if let Some(level) = self.demand.level(period, from, to) {
                        let deviation: f64 = StandardNormal.sample(random);
                        table[(from, to)] = whole_passengers(level.mean + level.sd * deviation);
                    }
                }
            }
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "not negative, and means and sds are bounded"
)]
fn whole_passengers(drawn: f64) -> u32 {
    drawn.round().max(0.0) as u32
}

/// The stands that are still free while aircraft are placed one after another.
struct StartPositions {
    /// Vertiports with a stand left, in order, with the number of stands left.
    free: Vec<(VertiportIx, u16)>,
}

impl StartPositions {
    fn of(vertiports: &[Vertiport]) -> Self {
        let stands = vertiports.iter().map(|vertiport| vertiport.stands);
        Self { free: VertiportIx::all(vertiports.len()).zip(stands).collect() }
    }

    /// Takes a stand at a vertiport chosen uniformly among those that have one left.
    fn next(&mut self, random: &mut ChaCha8Rng) -> VertiportIx {
        let chosen = random.random_range(0..self.free.len());
        let (vertiport, stands) = &mut self.free[chosen];
        let vertiport = *vertiport;
        *stands -= 1;
        if *stands == 0 {
            self.free.remove(chosen);
        }
        vertiport
    }
}
