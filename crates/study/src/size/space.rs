//! The designs that are searched: for each aircraft type, stand or charger that may vary, a range
//! of numbers.

use serde_json::Value;
use vertifleet_core::{Coded, Network, TypeIx, VertiportIx};

use super::ceiling::Headroom;
use super::goal::Goal;
use crate::error::Error;
use crate::sweep::{Factor, Levels};

/// A number of each thing that may vary: how many steps it is above the lowest, by dimension.
pub(super) type Design = Vec<u32>;

/// A thing that designs have different numbers of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Dimension {
    /// The member of the network file.
    pub(super) path: String,
    pub(super) what: DimensionKind,
    /// The lowest number.
    pub(super) low: u32,
    /// From one number to the next.
    pub(super) step: u32,
    /// How many steps the highest number is above the lowest.
    pub(super) steps: u32,
    /// The number that the network file has.
    pub(super) now: u32,
}

/// What a dimension counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DimensionKind {
    Aircraft(TypeIx),
    Stands(VertiportIx),
    Chargers(VertiportIx),
}

impl Dimension {
    /// Whether it counts aircraft, and not places for them.
    pub(super) fn is_aircraft(&self) -> bool {
        matches!(self.what, DimensionKind::Aircraft(_))
    }

    /// The number at some steps above the lowest.
    pub(super) fn number(&self, steps: u32) -> u32 {
        self.low + self.step * steps
    }

    /// The steps at which the number is nearest to this one.
    pub(super) fn nearest(&self, number: u32) -> u32 {
        (number.saturating_sub(self.low) + self.step / 2).div_euclid(self.step).min(self.steps)
    }
}

/// All designs, and the network that they change.
#[derive(Debug, Clone)]
pub(super) struct Space {
    /// The network with the settings that are the same in every design.
    pub(super) network: Network,
    pub(super) dimensions: Vec<Dimension>,
    /// What does not vary: aircraft by type, stands and chargers by vertiport.
    fixed: Counts,
}

/// How many there are of each thing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Counts {
    /// Aircraft by type.
    pub(super) aircraft: Vec<u32>,
    pub(super) stands: Vec<u32>,
    pub(super) chargers: Vec<u32>,
}

impl Counts {
    fn of(network: &Network) -> Self {
        let mut aircraft = vec![0; network.aircraft_types().len()];
        for one in &network.mean_day().aircraft {
            aircraft[one.kind.at()] += 1;
        }
        let vertiports = network.vertiports().iter();
        Self {
            aircraft,
            stands: vertiports.clone().map(|one| one.stands.into()).collect(),
            chargers: vertiports.map(|one| one.chargers.map_or(0, u32::from)).collect(),
        }
    }

    fn of_what(&mut self, what: DimensionKind) -> &mut u32 {
        match what {
            DimensionKind::Aircraft(kind) => &mut self.aircraft[kind.at()],
            DimensionKind::Stands(at) => &mut self.stands[at.at()],
            DimensionKind::Chargers(at) => &mut self.chargers[at.at()],
        }
    }

    /// Stands and chargers together, by vertiport.
    pub(super) fn places(&self) -> Vec<u32> {
        self.stands.iter().zip(&self.chargers).map(|(stands, chargers)| stands + chargers).collect()
    }
}

impl Space {
    /// Reads which members vary. A factor with one value is a setting of all designs. Without a
    /// factor that varies, the goal says what does: up to twice the numbers of the file.
    ///
    /// # Errors
    /// Returns [`Error::Asked`] if something else than aircraft, stands or chargers varies or its
    /// numbers are not whole and evenly spaced, and the errors of [`Network::changed`].
    pub(super) fn new(network: &Network, factors: &[Factor], goal: Goal) -> Result<Self, Error> {
        let (settings, varied): (Vec<&Factor>, Vec<&Factor>) =
            factors.iter().partition(|factor| setting(factor).is_some());
        let changes =
            settings.into_iter().map(|one| (&one.path, setting(one).expect("just found")));
        let network = network.changed(changes)?;
        let mut dimensions = Vec::new();
        for factor in varied {
            let (low, step, steps) = numbers(factor)?;
            for dimension in dimensions_of(&network, &factor.path)? {
                dimensions.retain(|one: &Dimension| one.path != dimension.path);
                dimensions.push(Dimension { low, step, steps, ..dimension });
            }
        }
        if dimensions.is_empty() {
            dimensions = default_dimensions(&network, goal)?;
        }
        let mut fixed = Counts::of(&network);
        for dimension in &dimensions {
            *fixed.of_what(dimension.what) -= dimension.now;
        }
        let space = Self { network, dimensions, fixed };
        if space.is_empty() {
            return Err(Error::Asked {
                rule: "no design has an aircraft, a stand for each, and a place to fly to"
                    .to_owned(),
                hint: "let the fleet be smaller, or let vertiports have more stands",
            });
        }
        Ok(space)
    }

    /// The design that is nearest to the network file.
    pub(super) fn start(&self) -> Design {
        self.dimensions.iter().map(|one| one.nearest(one.now)).collect()
    }

    /// Whether no design is the network file as it is.
    pub(super) fn leaves_file_out(&self) -> bool {
        let start = self.start();
        self.dimensions.iter().zip(start).any(|(one, steps)| one.number(steps) != one.now)
    }

    /// The design with the highest number of everything.
    pub(super) fn largest(&self) -> Design {
        self.dimensions.iter().map(|one| one.steps).collect()
    }

    /// How many there are of each thing in a design.
    pub(super) fn counts(&self, design: &[u32]) -> Counts {
        let mut counts = self.fixed.clone();
        for (dimension, &steps) in self.dimensions.iter().zip(design) {
            *counts.of_what(dimension.what) += dimension.number(steps);
        }
        counts
    }

    /// Whether a design has an aircraft, a stand for each, and a place more, without which none can
    /// ever fly.
    pub(super) fn is_possible(&self, design: &[u32]) -> bool {
        let counts = self.counts(design);
        let [aircraft, stands, places] = [
            counts.aircraft.iter().sum::<u32>(),
            counts.stands.iter().sum(),
            counts.places().iter().sum(),
        ];
        aircraft > 0 && aircraft <= stands && aircraft < places
    }

    /// How many there are of each thing above its lowest number in a design.
    pub(super) fn above(&self, design: &[u32]) -> Vec<u32> {
        self.dimensions.iter().zip(design).map(|(one, &steps)| one.step * steps).collect()
    }

    /// The same designs with all numbers between those that are searched.
    pub(super) fn with_all_numbers(&self) -> Self {
        let all =
            |one: &Dimension| Dimension { step: 1, steps: one.step * one.steps, ..one.clone() };
        Self { dimensions: self.dimensions.iter().map(all).collect(), ..self.clone() }
    }

    /// The rule that aircraft fill at most a share of the stands.
    pub(super) fn room(&self, filled: f64) -> Headroom {
        let lowest = self.counts(&vec![0; self.dimensions.len()]);
        let takes = |one: &Dimension| match one.what {
            DimensionKind::Aircraft(_) => 1.0,
            DimensionKind::Stands(_) => -filled,
            DimensionKind::Chargers(_) => 0.0,
        };
        let sum = |numbers: &[u32]| f64::from(numbers.iter().sum::<u32>());
        Headroom {
            takes: self.dimensions.iter().map(takes).collect(),
            there_is: filled * sum(&lowest.stands) - sum(&lowest.aircraft),
        }
    }

    /// Whether no design is possible, because the smallest fleet is larger than all stands or the
    /// largest one is none.
    fn is_empty(&self) -> bool {
        let extreme = |most_aircraft: bool| -> Design {
            let steps =
                |one: &Dimension| if one.is_aircraft() == most_aircraft { one.steps } else { 0 };
            self.dimensions.iter().map(steps).collect()
        };
        let (largest_fleet, most_stands) =
            (self.counts(&extreme(true)), self.counts(&extreme(false)));
        let fewest = most_stands.aircraft.iter().sum::<u32>().max(1);
        let places: u32 = most_stands.places().iter().sum();
        let is_too_full = fewest > most_stands.stands.iter().sum() || fewest >= places;
        largest_fleet.aircraft.iter().sum::<u32>() == 0 || is_too_full
    }

    /// The numbers of a design, by dimension.
    pub(super) fn numbers(&self, design: &[u32]) -> Vec<u32> {
        self.dimensions.iter().zip(design).map(|(one, &steps)| one.number(steps)).collect()
    }

    /// The network of a design.
    ///
    /// # Errors
    /// Returns the errors of [`Network::changed`], such as more stands than the format allows.
    pub(super) fn network(&self, design: &[u32]) -> Result<Network, Error> {
        let values: Vec<Value> = self.numbers(design).into_iter().map(Value::from).collect();
        let paths = self.dimensions.iter().map(|one| &one.path);
        Ok(self.network.changed(paths.zip(&values))?)
    }

    /// What the aircraft, stands and chargers of a design cost, dollars a day.
    pub(super) fn fixed_cost_usd(&self, design: &[u32]) -> f64 {
        let more = self.dimensions.iter().zip(design).zip(self.costs_of_one_usd());
        let more = more.map(|((dimension, &steps), each)| {
            each * (f64::from(dimension.number(steps)) - f64::from(dimension.now))
        });
        self.network.fixed_cost_usd() + more.sum::<f64>()
    }

    /// What one more costs by dimension, dollars a day.
    pub(super) fn costs_of_one_usd(&self) -> Vec<f64> {
        let day = self.network.mean_day();
        let cost = |one: &Dimension| match one.what {
            DimensionKind::Aircraft(_) => day.aircraft_cost_usd,
            DimensionKind::Stands(at) => day.vertiports[at.at()].stand_cost_usd,
            DimensionKind::Chargers(at) => day.vertiports[at.at()].charger_cost_usd,
        };
        self.dimensions.iter().map(cost).collect()
    }
}

/// The value of a factor that does not vary.
fn setting(factor: &Factor) -> Option<&Value> {
    match &factor.levels {
        Levels::List(values) if values.len() == 1 => values.first(),
        _ => None,
    }
}

/// The lowest number of a factor, the step to the next, and the number of steps.
fn numbers(factor: &Factor) -> Result<(u32, u32, u32), Error> {
    let asked = || Error::Asked {
        rule: format!("the numbers of {:?} are not whole and evenly spaced", factor.path),
        hint: "a design counts things: give a range, as in fleet.0.count=20..60 or vertiports.*.stands=2..10/2",
    };
    let (low, step, last) = match &factor.levels {
        &Levels::Range(low, high, true) => (whole(low), Some(1), whole(high)),
        Levels::Range(..) => return Err(asked()),
        Levels::List(values) => {
            let values: Option<Vec<u32>> =
                values.iter().map(|value| u32::try_from(value.as_u64()?).ok()).collect();
            let values = values.ok_or_else(asked)?;
            let [first, second, ..] = values[..] else { return Err(asked()) };
            let step = second.checked_sub(first).filter(|&step| step > 0).ok_or_else(asked)?;
            let is_even = values.windows(2).all(|pair| pair[1].checked_sub(pair[0]) == Some(step));
            (Some(first), is_even.then_some(step), values.last().copied())
        }
    };
    let (Some(low), Some(step), Some(last)) = (low, step, last) else { return Err(asked()) };
    Ok((low, step, (last - low) / step))
}

/// A number of a range of whole numbers, if it is none below 0.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "just checked")]
fn whole(number: f64) -> Option<u32> {
    (0.0..=f64::from(u32::MAX)).contains(&number).then_some(number as u32)
}

/// The dimensions that a path names; each has the number of the file alone.
fn dimensions_of(network: &Network, path: &str) -> Result<Vec<Dimension>, Error> {
    let is_counted = path.starts_with("fleet.") || path.starts_with("vertiports.");
    if !is_counted {
        // A path that leads nowhere is mistyped, whatever could vary.
        let trial = network.changed([(&path.to_owned(), &Value::from(1))]);
        if let Err(error) = trial
            && error.code().0 == 123
        {
            return Err(error.into());
        }
        return Err(Error::Asked {
            rule: format!("{path:?} cannot vary in a search for a design"),
            hint: "only numbers of aircraft, stands and chargers can; give it one value, or vary it with `vertifleet sweep`",
        });
    }
    let has_chargers = network.vertiports().iter().any(|one| one.chargers.is_some());
    if path.ends_with(".chargers") && !has_chargers {
        return Err(Error::Asked {
            rule: format!(
                "{path:?} cannot vary: aircraft are charged at every stand of this network"
            ),
            hint: "vary stands, or write into the network how many chargers its vertiports have",
        });
    }
    let members = network.members(path)?;
    members.into_iter().map(|(path, value)| dimension(network, path, &value)).collect()
}

fn dimension(network: &Network, path: String, value: &Value) -> Result<Dimension, Error> {
    let asked = || Error::Asked {
        rule: format!("{path:?} is no number of aircraft, stands or chargers"),
        hint: "vary fleet.NAME.count, vertiports.NAME.stands or vertiports.NAME.chargers; other settings may have one value",
    };
    // The entry may be in quotes, with dots in them.
    let ends =
        path.split_once('.').and_then(|(section, rest)| Some((section, rest.rsplit_once('.')?)));
    let Some((section, (entry, member))) = ends else { return Err(asked()) };
    let id = |member: &str| {
        let found = network.members(&format!("{section}.{entry}.{member}")).ok()?;
        found.into_iter().next()?.1.as_str().map(str::to_owned)
    };
    let what = match (section, member) {
        ("fleet", "count") => id("type").and_then(|id| {
            let kinds = network.aircraft_types();
            kinds
                .iter()
                .position(|kind| kind.id == id)
                .map(TypeIx::new)
                .map(DimensionKind::Aircraft)
        }),
        ("vertiports", "stands" | "chargers") => id("id").and_then(|id| {
            let at = network.vertiports().iter().position(|one| one.id == id)?;
            let at = VertiportIx::new(at);
            Some(if member == "stands" {
                DimensionKind::Stands(at)
            } else {
                DimensionKind::Chargers(at)
            })
        }),
        _ => None,
    };
    let now = value.as_u64().and_then(|now| u32::try_from(now).ok());
    let (Some(what), Some(now)) = (what, now) else { return Err(asked()) };
    Ok(Dimension { path, what, low: now, step: 1, steps: 0, now })
}

/// What varies where nothing is said: chargers, or stands where there are none, and the fleet
/// unless the goal is the spill of a given one.
fn default_dimensions(network: &Network, goal: Goal) -> Result<Vec<Dimension>, Error> {
    let mut dimensions = Vec::new();
    if goal != Goal::LeastSpill {
        dimensions.extend(dimensions_of(network, "fleet.*.count")?);
    }
    for (at, vertiport) in network.vertiports().iter().enumerate() {
        let member = if vertiport.chargers.is_some() { "chargers" } else { "stands" };
        dimensions.extend(dimensions_of(network, &format!("vertiports.{at}.{member}"))?);
    }
    for one in &mut dimensions {
        one.low = u32::from(!one.is_aircraft());
        one.steps = (2 * one.now).saturating_sub(one.low);
    }
    Ok(dimensions)
}

#[cfg(test)]
mod tests {
    use vertifleet_core::{Coded, Network};

    use super::{Counts, Space};
    use crate::size::Goal;
    use crate::sweep::Factor;

    fn space(factors: &[&str]) -> Result<Space, crate::Error> {
        let network = Network::shipped("new-york").expect("shipped");
        let factors: Vec<Factor> =
            factors.iter().map(|text| Factor::parse(text).expect("a factor")).collect();
        Space::new(&network, &factors, Goal::MostProfit)
    }

    #[test]
    fn the_start_is_the_network_and_steps_change_what_they_say() {
        let space =
            space(&["fleet.*.count=0..40/4", "vertiports.JFK.stands=2..9"]).expect("a space");
        assert_eq!(space.start(), [4, 4, 6]);
        let york = Network::shipped("new-york").expect("shipped");
        assert_eq!(space.counts(&[4, 4, 6]), Counts::of(&york));
        let changed = space.network(&[5, 0, 7]).expect("a design");
        assert_eq!(space.counts(&[5, 0, 7]), Counts::of(&changed));
        assert_eq!(changed.fleet_size(), 20);
        assert!(space.is_possible(&[5, 0, 7]));
        assert!(!space.is_possible(&[0, 0, 7]), "no aircraft");
        assert!(!space.is_possible(&[10, 10, 7]), "80 aircraft on 49 stands");
    }

    #[test]
    fn without_a_range_all_fleets_and_stands_vary_up_to_twice_the_file() {
        let all = space(&["tariffs.aircraft_cost_usd_per_day=500"]).expect("a space");
        assert_eq!(all.dimensions.len(), 11);
        assert_eq!(all.costs_of_one_usd()[0].to_bits(), 500.0_f64.to_bits());
        assert_eq!(all.network(&all.start()).expect("a design").fleet_size(), 32);
    }

    #[test]
    fn what_is_no_number_of_something_is_refused() {
        for factor in [
            "tariffs.fare_level=1..2/0.5",
            "fleet.midnight.count=1,2,4",
            "fleet.midnight.count=0.5..2.5",
            "vertiports.*.latitude=1..3",
        ] {
            assert!(space(&[factor]).is_err(), "{factor}");
        }
        for (factor, code) in [
            ("tarifs.fare_level=1..2", 123),
            ("vertiport.JFK.stands=1..3", 123),
            ("fleet.midnigth.count=1..3", 123),
            ("fleet.midnight.cont=1..3", 123),
            ("tariffs.fare_lev=1..2", 123),
            ("aircraft_types.midnight.seatz=1..3", 123),
            ("aircraft_types.midnight.seats=1..3", 407),
            ("tariffs.fare_level=1..2", 407),
        ] {
            let error = space(&[factor]).expect_err(factor);
            assert_eq!(error.code().0, code, "{factor}: {error}");
        }
        let none = space(&["vertiports.*.chargers=1..3"]).expect_err("no chargers").to_string();
        assert!(none.contains("charged at every stand"), "{none}");
    }
}
