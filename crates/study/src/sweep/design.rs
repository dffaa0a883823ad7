//! Which settings a sweep tries: the factors, the values of each, and how they are combined into cells.
//!
//! A grid has a cell for every combination of values. A Latin hypercube (McKay, Beckman and Conover, 1979) has as many
//! cells as are asked for, whatever the number of factors: the range of each factor is cut into as many parts as there
//! are cells, and each part is used once.

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_xoshiro::SplitMix64;
use serde_json::Value;

use crate::error::Error;

/// The most cells of a sweep.
pub const MOST_CELLS: usize = 10_000;

/// A setting of the network that a sweep varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Factor {
    /// The member of the network file, as `vertifleet_core::Network::changed` takes it: `fleet.0.count`.
    pub path: String,
    /// What it may be.
    pub levels: Levels,
}

/// The values of a factor.
#[derive(Debug, Clone, PartialEq)]
pub enum Levels {
    /// These values.
    List(Vec<Value>),
    /// Any number from the first to the second; only whole ones if the third says so. For a Latin hypercube only.
    Range(f64, f64, bool),
}

/// How values are combined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Design {
    /// Every combination.
    Grid,
    /// A Latin hypercube with this many cells, drawn with this seed.
    LatinHypercube {
        /// Number of cells.
        cells: usize,
        /// Seed of the draw.
        seed: u64,
    },
}

impl Factor {
    /// Reads `PATH=VALUE,VALUE,...`, `PATH=LOW..HIGH/STEP` or, for a Latin hypercube, `PATH=LOW..HIGH`.
    ///
    /// # Errors
    /// Returns [`Error::Asked`] if the text has another form, or if a range is empty or endless.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let asked = |rule: String| Error::Asked {
            rule,
            hint: "a factor is PATH=VALUE,VALUE or PATH=LOW..HIGH/STEP, for example fleet.0.count=30..50/5",
        };
        let (path, values) = text
            .split_once('=')
            .filter(|(path, values)| !path.is_empty() && !values.is_empty())
            .ok_or_else(|| asked(format!("{text:?} is no factor")))?;
        let levels = match values.split_once("..") {
            None => Levels::List(values.split(',').map(value).collect()),
            Some((low, rest)) => {
                let range = range(low, rest);
                range.ok_or_else(|| asked(format!("{values:?} is no range with values in it")))?
            }
        };
        Ok(Self { path: path.to_owned(), levels })
    }
}

/// The range from `low` on; `rest` is its end, and perhaps a slash and a step.
fn range(low: &str, rest: &str) -> Option<Levels> {
    let (high, step) = rest.split_once('/').map_or((rest, None), |(high, step)| (high, Some(step)));
    let whole = [low, high, step.unwrap_or("1")].iter().all(|one| one.parse::<i64>().is_ok());
    let read = |text: &str| text.parse::<f64>().ok().filter(|number| number.is_finite());
    let (low, high) = (read(low)?, read(high)?);
    let Some(step) = step else {
        return (low < high).then_some(Levels::Range(low, high, whole));
    };
    let step = read(step)?;
    let steps = steps(low, high, step)?;
    let value = |at: usize| number(step.mul_add(at as f64, low), whole);
    Some(Levels::List((0..=steps).map(value).collect()))
}

/// The number of steps from `low` to `high`, if they are not too many. The end counts if it is hit but for rounding.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "just checked")]
fn steps(low: f64, high: f64, step: f64) -> Option<usize> {
    let steps = ((high - low) / step + 1e-9).floor();
    (step > 0.0 && steps >= 0.0 && steps < MOST_CELLS as f64).then_some(steps as usize)
}

/// A number as a value of a network file. Twelve digits are kept, so that 0.1 + 0.2 is 0.3.
fn number(value: f64, whole: bool) -> Value {
    #[expect(clippy::cast_possible_truncation, reason = "a whole number of a user")]
    if whole {
        return Value::from(value.round() as i64);
    }
    let rounded: f64 = format!("{value:.12e}").parse().expect("a number just written");
    Value::from(rounded)
}

/// A value as it is typed: a number, true or false, a list in brackets, or else a text.
fn value(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|_| Value::from(text))
}

impl Design {
    /// The settings of every cell, in the order of the factors.
    ///
    /// # Errors
    /// Returns [`Error::Asked`] if there are no factors or too many cells, if a path comes twice, or if a grid has a
    /// range without steps.
    pub fn cells(self, factors: &[Factor]) -> Result<Vec<Vec<Value>>, Error> {
        let asked = |rule: String, hint| Err(Error::Asked { rule, hint });
        if factors.is_empty() {
            return asked("no setting is varied".to_owned(), "name one with --vary");
        }
        for (at, factor) in factors.iter().enumerate() {
            if factors[..at].iter().any(|before| before.path == factor.path) {
                let rule = format!("{:?} is varied twice", factor.path);
                return asked(rule, "give all of its values at once");
            }
        }
        match self {
            Self::Grid => grid(factors),
            Self::LatinHypercube { cells, .. } if !(2..=MOST_CELLS).contains(&cells) => asked(
                format!("a Latin hypercube has 2 to {MOST_CELLS} cells, found {cells}"),
                "ask for more cells or fewer",
            ),
            Self::LatinHypercube { cells, seed } => Ok(latin_hypercube(factors, cells, seed)),
        }
    }
}

/// Every combination; the last factor changes first.
fn grid(factors: &[Factor]) -> Result<Vec<Vec<Value>>, Error> {
    let mut cells = vec![Vec::new()];
    for factor in factors {
        let Levels::List(values) = &factor.levels else {
            return Err(Error::Asked {
                rule: format!("{:?} has a range without steps", factor.path),
                hint: "add a step, as in 30..50/5, or draw a Latin hypercube with --latin",
            });
        };
        if cells.len() * values.len() > MOST_CELLS {
            return Err(Error::Asked {
                rule: format!("the grid has more than {MOST_CELLS} cells"),
                hint: "use fewer values, or draw a Latin hypercube with --latin",
            });
        }
        let with = |cell: &Vec<Value>| {
            let cell = cell.clone();
            values.iter().map(move |value| [cell.clone(), vec![value.clone()]].concat())
        };
        cells = cells.iter().flat_map(with).collect();
    }
    Ok(cells)
}

fn latin_hypercube(factors: &[Factor], cells: usize, seed: u64) -> Vec<Vec<Value>> {
    let mut random = SplitMix64::seed_from_u64(seed);
    let mut settings = vec![Vec::new(); cells];
    for factor in factors {
        let mut parts: Vec<usize> = (0..cells).collect();
        parts.shuffle(&mut random);
        for (cell, part) in settings.iter_mut().zip(parts) {
            // The middle of the part: a draw within it would add nothing but noise.
            let share = (part as f64 + 0.5) / cells as f64;
            cell.push(match &factor.levels {
                Levels::List(values) => values[part * values.len() / cells].clone(),
                &Levels::Range(low, high, whole) => number((high - low).mul_add(share, low), whole),
            });
        }
    }
    settings
}

#[cfg(test)]
mod tests {
    use serde_json::json;
    use vertifleet_core::Coded;

    use super::{Design, Factor, Levels};

    fn factor(text: &str) -> Factor {
        Factor::parse(text).unwrap_or_else(|error| panic!("{text}: {error}"))
    }

    #[test]
    fn values_are_lists_or_steps() {
        let list = |text: &str| match factor(text).levels {
            Levels::List(values) => json!(values),
            Levels::Range(..) => panic!("a range"),
        };
        assert_eq!(list("fleet.0.count=30,40"), json!([30, 40]));
        assert_eq!(list("fleet.0.count=30..50/10"), json!([30, 40, 50]));
        assert_eq!(list("tariffs.fare_level=0.8..1.1/0.1"), json!([0.8, 0.9, 1.0, 1.1]));
        assert_eq!(list("vertiports.*.busy=true"), json!([true]));
        assert_eq!(list("operations.end=18:00:00"), json!(["18:00:00"]));
        assert_eq!(list("operations.end=18:00:00,19:00:00"), json!(["18:00:00", "19:00:00"]));
        assert_eq!(factor("a=1..2").levels, Levels::Range(1.0, 2.0, true));
        assert_eq!(factor("a=1.0..2").levels, Levels::Range(1.0, 2.0, false));
    }

    #[test]
    fn what_is_no_factor_is_refused() {
        for text in [
            "",
            "fleet.0.count",
            "=3",
            "a=",
            "a=1..2/0",
            "a=2..1/1",
            "a=1..1e9/1",
            "a=2..1",
            "a=1..nan",
            "a=1..",
        ] {
            let error = Factor::parse(text).expect_err(text);
            assert_eq!(error.code().to_string(), "V407", "{text}: {error}");
        }
    }

    #[test]
    fn a_grid_has_every_combination_once() {
        let cells = Design::Grid.cells(&[factor("a=1,2"), factor("b=x,y,z")]).expect("a grid");
        let expected = json!([[1, "x"], [1, "y"], [1, "z"], [2, "x"], [2, "y"], [2, "z"]]);
        assert_eq!(json!(cells), expected);
        for factors in [vec![], vec![factor("a=1..2")], vec![factor("a=1"), factor("a=2")]] {
            assert!(Design::Grid.cells(&factors).is_err(), "{factors:?}");
        }
    }

    #[test]
    fn a_latin_hypercube_uses_every_part_of_every_range_once() {
        let factors = [factor("a=0.0..10"), factor("b=0..99"), factor("c=x,y")];
        let design = Design::LatinHypercube { cells: 10, seed: 3 };
        let cells = design.cells(&factors).expect("a hypercube");
        let column = |at: usize| {
            let mut values: Vec<f64> =
                cells.iter().map(|cell| cell[at].as_f64().expect("a number")).collect();
            values.sort_by(f64::total_cmp);
            values
        };
        let parts: Vec<f64> = (0..10).map(|part| f64::from(part) + 0.5).collect();
        assert_eq!(column(0), parts);
        assert_eq!(column(1).first(), Some(&5.0));
        assert_eq!(cells.iter().filter(|cell| cell[2] == json!("x")).count(), 5);
        assert_eq!(design.cells(&factors).expect("again"), cells, "a seed means one design");
    }
}
