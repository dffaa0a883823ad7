//! Which settings a sweep tries: the factors, the values of each, and how they are combined into
//! cells.
//!
//! A grid has a cell for every combination of values. A Latin hypercube (McKay, Beckman and
//! Conover, 1979) has as many cells as are asked for, whatever the number of factors: the range of
//! each factor is cut into as many parts as there are cells, and each part is used once.

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_xoshiro::SplitMix64;
use serde_json::Value;
use vertifleet_core::split_path;

use crate::error::Error;

/// The most cells of a sweep.
pub const MOST_CELLS: usize = 10_000;

/// A setting of the network that a sweep varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Factor {
    /// The member of the network file, as `vertifleet_core::Network::changed` takes it:
    /// `fleet.0.count`.
    pub path: String,
    /// What it may be.
    pub levels: Levels,
}

/// The values of a factor.
#[derive(Debug, Clone, PartialEq)]
pub enum Levels {
    /// These values.
    List(Vec<Value>),
    /// Any number from the first to the second; only whole ones if the third says so. For a Latin
    /// hypercube only.
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
    /// Reads `PATH=VALUE,VALUE,...`, `PATH=LOW..HIGH/STEP` or, for a Latin hypercube,
    /// `PATH=LOW..HIGH`. A value that begins with a bracket, a brace or a quote is JSON, and may
    /// hold commas and dots.
    ///
    /// # Errors
    /// Returns [`Error::Asked`] if the text has another form, or if a range is empty or endless.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let asked = |rule: String| Error::Asked {
            rule,
            hint: "a factor is PATH=VALUE,VALUE or PATH=LOW..HIGH/STEP, for example fleet.0.count=30..50/5; a list is in brackets, as JSON",
        };
        let (path, values) = split_path(text)
            .filter(|(path, values)| !path.is_empty() && !values.is_empty())
            .ok_or_else(|| asked(format!("{text:?} is no factor")))?;
        let dots = values.split_once("..").filter(|(low, _)| !is_json(low) && !low.contains(','));
        let levels = match dots {
            None => Levels::List(list(values).map_err(asked)?),
            Some((low, rest)) => range(low, rest)
                .map_err(|wrong| asked(format!("{values:?} is no range: {wrong}")))?,
        };
        Ok(Self { path: path.to_owned(), levels })
    }
}

/// Whether a value is written as JSON: a list, a table, or a text in quotes.
fn is_json(text: &str) -> bool {
    text.starts_with(['[', '{', '"'])
}

/// The values of a list, which commas part. The error says what is wrong.
fn list(text: &str) -> Result<Vec<Value>, String> {
    let mut values = Vec::new();
    let mut rest = text;
    loop {
        let (value, after) = if is_json(rest) { json(rest)? } else { plain(rest)? };
        values.push(value);
        match after.strip_prefix(',') {
            Some(next) => rest = next,
            None if after.is_empty() => return Ok(values),
            None => return Err(format!("{after:?} follows a value, where a comma was expected")),
        }
    }
}

/// The value in JSON with which a text begins, and what comes after it.
fn json(text: &str) -> Result<(Value, &str), String> {
    let mut values = serde_json::Deserializer::from_str(text).into_iter();
    match values.next() {
        Some(Ok(value)) => Ok((value, &text[values.byte_offset()..])),
        Some(Err(error)) => Err(format!("{text:?} begins as JSON and is none: {error}")),
        None => Err(format!("{text:?} is no value")),
    }
}

/// The value up to the next comma, and what comes after it.
fn plain(text: &str) -> Result<(Value, &str), String> {
    let (value, after) = text.split_at(text.find(',').unwrap_or(text.len()));
    if value.contains("..") {
        return Err(format!("{value:?} is a range, which cannot stand among other values"));
    }
    Ok((serde_json::from_str(value).unwrap_or_else(|_| Value::from(value)), after))
}

/// The range from `low` on; `rest` is its end, and perhaps a slash and a step. The error says what
/// is wrong.
fn range(low: &str, rest: &str) -> Result<Levels, String> {
    let (high, step) = rest.split_once('/').map_or((rest, None), |(high, step)| (high, Some(step)));
    let whole = [low, high, step.unwrap_or("1")].iter().all(|one| one.parse::<i64>().is_ok());
    let read = |text: &str| {
        let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
        number.ok_or_else(|| format!("{text:?} is no number"))
    };
    let (from, to) = (read(low)?, read(high)?);
    if from > to {
        return Err(format!("it goes backwards, from {low} to {high}"));
    }
    let Some(step) = step else {
        let is_one = || format!("both ends are {low}, write that one value");
        return (from < to).then_some(Levels::Range(from, to, whole)).ok_or_else(is_one);
    };
    let by = read(step)?;
    if by <= 0.0 {
        return Err(format!("its step must be above 0, found {step}"));
    }
    // The end counts if it is hit but for rounding.
    let steps = ((to - from) / by + 1e-9).floor();
    if steps >= MOST_CELLS as f64 {
        return Err(format!("it has more than {MOST_CELLS} values"));
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "just checked")]
    let steps = steps as usize;
    let value = |at: usize| number(by.mul_add(at as f64, from), whole);
    Ok(Levels::List((0..=steps).map(value).collect()))
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

impl Design {
    /// The settings of every cell, in the order of the factors.
    ///
    /// # Errors
    /// Returns [`Error::Asked`] if there are too many cells, if a path comes twice, if a grid has a
    /// range without steps, or if a Latin hypercube has no factors.
    pub fn cells(self, factors: &[Factor]) -> Result<Vec<Vec<Value>>, Error> {
        let asked = |rule: String, hint| Err(Error::Asked { rule, hint });
        if factors.is_empty() && self != Self::Grid {
            return asked(
                "no setting is varied".to_owned(),
                "name one and its values, as in fleet.0.count=30..50/5",
            );
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
                hint: "add a step, as in 30..50/5, or draw a Latin hypercube (--latin CELLS; latin=CELLS in Python)",
            });
        };
        if cells.len() * values.len() > MOST_CELLS {
            return Err(Error::Asked {
                rule: format!("the grid has more than {MOST_CELLS} cells"),
                hint: "use fewer values, or draw a Latin hypercube (--latin CELLS; latin=CELLS in Python)",
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
                // Each whole number has a separate part of the range, the first and the last too.
                &Levels::Range(low, high, true) => {
                    number((high - low + 1.0).mul_add(share, low).floor(), true)
                }
                &Levels::Range(low, high, false) => number((high - low).mul_add(share, low), false),
            });
        }
    }
    settings
}

/// A value as people write it: a text without quotes.
pub fn format_value(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::{Just, Strategy, any, prop_assert_eq, prop_oneof, proptest};
    use serde_json::{Value, json};
    use vertifleet_core::Coded;

    use super::{Design, Factor, Levels};

    fn factor(text: &str) -> Factor {
        Factor::parse(text).unwrap_or_else(|error| panic!("{text}: {error}"))
    }

    #[test]
    fn what_is_wrong_with_a_range_is_said() {
        for (range, wrong) in [
            ("5..2", "backwards, from 5 to 2"),
            ("5..2/1", "backwards"),
            ("a..4", "\"a\" is no number"),
            ("1..9/x", "\"x\" is no number"),
            ("1..9/0", "above 0, found 0"),
            ("1..9/-1", "above 0, found -1"),
            ("3..3", "write that one value"),
            ("0..1e300/1", "more than"),
            ("0..inf", "\"inf\" is no number"),
        ] {
            let error = Factor::parse(&format!("fleet.0.count={range}")).expect_err(range);
            assert!(error.to_string().contains(wrong), "{range}: {error}");
        }
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
    fn values_in_brackets_hold_commas() {
        let list = |text: &str| match factor(text).levels {
            Levels::List(values) => json!(values),
            Levels::Range(..) => panic!("a range"),
        };
        assert_eq!(list("closures=[]"), json!([[]]));
        assert_eq!(list("a=[1,2],[3],4,x"), json!([[1, 2], [3], 4, "x"]));
        assert_eq!(list(r#"a="1,2","[..",x"#), json!(["1,2", "[..", "x"]));
        assert_eq!(
            list(r#"closures=[],[{"start":"07:00:00","end":"09:00:00","vertiports":["V1","V2"]}]"#),
            json!([[], [{"start": "07:00:00", "end": "09:00:00", "vertiports": ["V1", "V2"]}]])
        );
        assert_eq!(list(r#"a=1,["x..y"]"#), json!([1, ["x..y"]]));
        assert_eq!(list("a=1,,2"), json!([1, "", 2]), "an empty text is a text");
    }

    /// Values as JSON has them, lists and tables within each other included.
    fn values() -> impl Strategy<Value = Value> {
        let plain = prop_oneof![
            any::<i32>().prop_map(Value::from),
            any::<bool>().prop_map(Value::from),
            Just(json!(0.25)),
            "[ -~]{0,6}".prop_map(Value::from),
        ];
        plain.prop_recursive(3, 12, 3, |inner| {
            prop_oneof![
                vec(inner.clone(), 0..4).prop_map(Value::from),
                vec(("[a-z,\"\\[\\]]{1,4}", inner), 0..3)
                    .prop_map(|members| Value::Object(members.into_iter().collect())),
            ]
        })
    }

    proptest! {
        #[test]
        fn values_that_are_written_as_json_are_read_as_they_are(values in vec(values(), 1..5)) {
            let texts: Vec<String> = values.iter().map(Value::to_string).collect();
            let read = Factor::parse(&format!("a={}", texts.join(","))).expect("a list");
            prop_assert_eq!(read.levels, Levels::List(values));
        }

        #[test]
        fn any_text_is_a_factor_or_refused_with_its_code(text in "[ -~]{0,24}") {
            if let Err(error) = Factor::parse(&format!("a={text}")) {
                prop_assert_eq!(error.code().to_string(), "V407");
            }
        }
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
            "a=[1,2",
            "a=[1,2]3",
            "a=[1,2] ,3",
            "a=\"x",
            "a={b:1}",
            "a=1,[x]",
            "a=1,2..3",
            "a=[1],2..3",
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
        assert_eq!(json!(Design::Grid.cells(&[]).expect("nothing is varied")), json!([[]]));
        for factors in [vec![factor("a=1..2")], vec![factor("a=1"), factor("a=2")]] {
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
        let design = Design::LatinHypercube { cells: 10, seed: 4 };
        let mut whole: Vec<Value> =
            design.cells(&[factor("d=4..8")]).expect("a hypercube").concat();
        whole.sort_by_key(Value::as_i64);
        assert_eq!(json!(whole), json!([4, 4, 5, 5, 6, 6, 7, 7, 8, 8]), "all as often");
        let design = Design::LatinHypercube { cells: 10, seed: 3 };
        assert_eq!(cells.iter().filter(|cell| cell[2] == json!("x")).count(), 5);
        assert_eq!(design.cells(&factors).expect("again"), cells, "a seed means one design");
    }
}
