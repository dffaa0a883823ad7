//! Made-up results of five policies, the same on every machine, for tests and the sample report.

use vertifleet_sim::DayTotals;
use vertifleet_study::{
    ComparisonRecords, DayRecord, LatencySummary, LearningCurve, NetworkOrigin, PolicyRecord,
    ValidationCurves,
};

/// The results that a made-up policy gets.
struct Outline {
    name: &'static str,
    description: &'static str,
    profit_usd: f64,
    noise_usd: f64,
    flights: u32,
    decision_ns: LatencySummary,
}

const fn latency(median_ns: u64, p99_ns: u64) -> LatencySummary {
    LatencySummary { median_ns, p99_ns }
}

const POLICIES: [Outline; 5] = [
    Outline {
        name: "random",
        description: "a feasible vertiport, each with the same chance (Feas-RND)",
        profit_usd: 31_900.0,
        noise_usd: 900.0,
        flights: 341,
        decision_ns: latency(48, 95),
    },
    Outline {
        name: "greedy",
        description: "the highest profit per hour from take-off to ready",
        profit_usd: 37_800.0,
        noise_usd: 420.0,
        flights: 352,
        decision_ns: latency(310, 640),
    },
    Outline {
        name: "prices",
        description: "what is worth most at the prices of the day",
        profit_usd: 38_150.0,
        noise_usd: 450.0,
        flights: 350,
        decision_ns: latency(4_210, 8_900),
    },
    Outline {
        name: "mlp",
        description: "plain layers on the same inputs (MLP-RL)",
        profit_usd: 35_400.0,
        noise_usd: 800.0,
        flights: 349,
        decision_ns: latency(61_200, 88_000),
    },
    Outline {
        name: "gcaps",
        description: "graph capsule network and attention decoder (GCAPS-RL)",
        profit_usd: 38_420.0,
        noise_usd: 480.0,
        flights: 355,
        decision_ns: latency(112_300, 158_000),
    },
];

/// A study of five policies on this many days of the network `paper`.
pub(crate) fn study(days: usize) -> ComparisonRecords {
    let mut noise = Noise(1);
    let seasons: Vec<f64> = (0..days).map(|_| 1_300.0 * noise.next_normal()).collect();
    let policies = POLICIES.iter().map(|outline| PolicyRecord {
        name: outline.name.to_owned(),
        description: outline.description.to_owned(),
        days: seasons
            .iter()
            .zip(0..)
            .map(|(&season, day)| record(outline, day, season, &mut noise))
            .collect(),
        sees: vertifleet_study::Sees::Present,
        weights_sha256: None,
        training_seed: None,
        decision_ns: Some(outline.decision_ns),
    });
    let policies = policies.collect();
    let mut runs = |name, end, start, seeds: usize| ValidationCurves {
        name,
        runs: (0..seeds).map(|_| curve("", end, start, &mut noise).points).collect(),
    };
    let trainings =
        vec![runs("gcaps".to_owned(), 0.293, 0.255, 3), runs("mlp".to_owned(), 0.272, 0.250, 1)];
    ComparisonRecords {
        network: "paper".to_owned(),
        network_origin: NetworkOrigin::Shipped,
        seed: Some(1),
        split: vertifleet_core::Purpose::Comparison,
        days_from: None,
        days,
        bound_step_s: None,
        command: format!(
            "vertifleet compare --network paper --policies random,greedy,prices,mlp,gcaps --days {days} --seed 1 --report out"
        ),
        policies,
        curves: vec![
            curve("gcaps", 0.291, 0.252, &mut noise),
            curve("mlp", 0.270, 0.249, &mut noise),
        ],
        trainings,
        replayed: Vec::new(),
    }
}

fn record(outline: &Outline, day: u64, season: f64, noise: &mut Noise) -> DayRecord {
    let profit_usd = outline.profit_usd + season + outline.noise_usd * noise.next_normal();
    let potential_usd = 131_000.0 + 2.0 * season;
    let jitter = (day % 7) as u32;
    let flights = outline.flights + jitter;
    DayRecord {
        day: format!("paper-{}", day + 1),
        seed: day + 1,
        totals: DayTotals {
            profit_usd,
            revenue_usd: profit_usd * 1.9,
            passenger_cost_usd: profit_usd * 0.8,
            energy_cost_usd: profit_usd * 0.1,
            flight_cost_usd: 0.0,
            aircraft_cost_usd: 0.0,
            site_cost_usd: 0.0,
            energy_kwh: profit_usd * 0.5,
            potential_usd,
            reward: profit_usd / potential_usd,
            flights,
            repositioning_flights: 9 + jitter,
            holds: 44 - jitter,
            decisions: flights + 44 - jitter,
            passengers: u64::from(flights * 4 - 60),
            spilled_passengers: 29_000,
            load_factor: f64::from(flights * 4 - 60) / f64::from(flights * 4),
        },
        upper_bound_usd: None,
        choices: Vec::new(),
    }
}

fn curve(name: &str, end: f64, start: f64, noise: &mut Noise) -> LearningCurve {
    let points = (1..=100u32).map(|point| {
        let rise = 1.0 - (-f64::from(point) / 22.0).exp();
        let reward = start + (end - start) * rise + 0.0025 * noise.next_normal() * (1.3 - rise);
        (u64::from(point) * 20_000, reward)
    });
    LearningCurve { name: name.to_owned(), points: points.collect() }
}

/// SplitMix64: a few lines that never change, unlike a crate's generator.
struct Noise(u64);

impl Noise {
    fn next_uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A sum of twelve uniform values minus six, which is close enough to normal and uses no
    /// function that differs by platform.
    fn next_normal(&mut self) -> f64 {
        (0..12).map(|_| self.next_uniform()).sum::<f64>() - 6.0
    }
}
