//! Seeds of days. Training, validation and comparison have disjoint ranges, so that they never
//! share a day.
//!
//! | purpose | seeds | made from |
//! |---|---|---|
//! | comparison | 0 .. 2^40 | the user's `--seed`, counted up for each further day |
//! | validation | 2^40 .. 2^41 | the number of the validation day |
//! | training | 2^41 .. 2^53 | the seed of the training run and the number of the day in it |

use std::fmt;
use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::{Error, Scenario, limits};

const VALIDATION: u64 = 1 << 40;
const TRAINING: u64 = 1 << 41;
/// Number of days of a training run; each run has this many consecutive seeds.
const RUN_DAYS: u64 = 1 << 28;
/// Number of training runs that fit between `TRAINING` and 2^53.
const RUNS: u64 = 1 << 24;

const _: () = assert!(TRAINING + RUNS * RUN_DAYS <= limits::SEED_LIMIT, "all runs fit below 2^53");

/// The purpose that a day is drawn for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Purpose {
    /// Days that results are reported on, chosen by the user's `--seed`.
    #[default]
    Comparison,
    /// Days on which models and settings are chosen.
    Validation,
    /// Days that models learn from.
    Training,
}

impl Purpose {
    /// All purposes, the strictest first.
    pub const ALL: [Self; 3] = [Self::Comparison, Self::Validation, Self::Training];

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Comparison => "comparison",
            Self::Validation => "validation",
            Self::Training => "training",
        }
    }

    /// The stricter of two purposes: comparison before validation before training. A day of both
    /// must not be used for anything that one of them forbids.
    #[must_use]
    pub fn stricter(self, other: Self) -> Self {
        let both = [self, other];
        Self::ALL.into_iter().find(|purpose| both.contains(purpose)).expect("it is one of all")
    }

    /// The purpose with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|purpose| purpose.name() == name)
    }

    /// The seeds of this purpose, which no other purpose has.
    pub const fn seeds(self) -> Range<u64> {
        match self {
            Self::Comparison => 0..VALIDATION,
            Self::Validation => VALIDATION..TRAINING,
            Self::Training => TRAINING..limits::SEED_LIMIT,
        }
    }
}

/// The seed of one day, below 2^53. It alone determines the day that
/// [`Network::draw`](crate::Network::draw) returns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct DaySeed(u64);

impl DaySeed {
    /// The day that the user's `--seed` names.
    ///
    /// # Errors
    /// [`Error::SeedOutOfRange`] if the seed is 2^40 or more.
    pub fn comparison(seed: u64) -> Result<Self, Error> {
        within("the seed", seed, VALIDATION)?;
        Ok(Self(seed))
    }

    /// Validation day number `index`.
    ///
    /// # Errors
    /// [`Error::SeedOutOfRange`] if `index` is 2^40 or more.
    pub fn validation(index: u64) -> Result<Self, Error> {
        within("the number of the validation day", index, TRAINING - VALIDATION)?;
        Ok(Self(VALIDATION + index))
    }

    /// Day number `day` of the training run with this seed.
    ///
    /// # Errors
    /// [`Error::SeedOutOfRange`] if the run's seed is 2^24 or more, or the day 2^28 or more.
    pub fn training(run_seed: u32, day: u64) -> Result<Self, Error> {
        within("the training run's seed", run_seed.into(), RUNS)?;
        within("the number of the training day", day, RUN_DAYS)?;
        Self::training_number(u64::from(run_seed) * RUN_DAYS + day)
    }

    /// Training day number `number`, counted through the days of all runs.
    ///
    /// # Errors
    /// [`Error::SeedOutOfRange`] if `number` is [`TRAINING_DAYS`](Self::TRAINING_DAYS) or more.
    pub fn training_number(number: u64) -> Result<Self, Error> {
        within("the number of the training day", number, Self::TRAINING_DAYS)?;
        Ok(Self(TRAINING + number))
    }

    /// Day number `number` of a purpose, counted from 0.
    ///
    /// # Errors
    /// [`Error::SeedOutOfRange`] if the purpose has no such day.
    pub fn of_purpose(purpose: Purpose, number: u64) -> Result<Self, Error> {
        match purpose {
            Purpose::Comparison => Self::comparison(number),
            Purpose::Validation => Self::validation(number),
            Purpose::Training => Self::training_number(number),
        }
    }

    /// Number of training days of all runs together.
    pub const TRAINING_DAYS: u64 = RUNS * RUN_DAYS;

    /// The seed that a day was drawn from, according to its file. It is within bounds for a checked
    /// day.
    pub(crate) fn of(day: &Scenario) -> Self {
        Self(day.seed)
    }

    /// The seed as a number, as in the scenario file.
    #[inline]
    pub const fn get(self) -> u64 {
        self.0
    }

    /// The purpose that the seed belongs to. A day of it may have a stricter one, that of its
    /// network ([`Day::purpose`](crate::Day::purpose)).
    pub fn purpose(self) -> Purpose {
        purpose_of(self.0)
    }
}

impl fmt::Display for DaySeed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// The purpose that a seed belongs to.
pub(crate) fn purpose_of(seed: u64) -> Purpose {
    match seed {
        ..VALIDATION => Purpose::Comparison,
        VALIDATION..TRAINING => Purpose::Validation,
        TRAINING.. => Purpose::Training,
    }
}

fn within(member: &str, value: u64, limit: u64) -> Result<(), Error> {
    if value < limit {
        return Ok(());
    }
    Err(Error::SeedOutOfRange { member: member.to_owned(), limit, found: value.to_string() })
}
