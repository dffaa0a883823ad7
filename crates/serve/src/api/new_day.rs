//! The inputs of a new day: a network or a scenario, and changes to it.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::value::RawValue;
use utoipa::ToSchema;
use vertifleet_core::{DaySeed, Matrix, Scenario};

use crate::calendar::Calendar;
use crate::error::Error;
use crate::ids::Ids;
use crate::moment::Moment;
use crate::names::is_printed;
use crate::networks;
use crate::optional::or_default;
use crate::service::Service;

/// A day to make, from a network or from a scenario.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct NewDay {
    /// A network that the program ships, or that was uploaded.
    network: Option<String>,
    /// The seed that draws the day from the network: its forecast, and the vertiports of aircraft
    /// in the morning, unless they are given. 1 if it is absent.
    #[schema(maximum = 1_099_511_627_775u64)]
    seed: Option<u64>,
    /// A whole scenario, in the format of scenario files.
    #[schema(value_type = Option<Object>)]
    scenario: Option<Box<RawValue>>,
    /// The expected passengers, in place of those of the network or the scenario. A pair without a
    /// row has no passengers.
    forecast: Option<Vec<ForecastRow>>,
    /// The vertiports of aircraft in the morning, by the ids of the aircraft. The others stand
    /// where the network or the scenario places them.
    #[serde(default, deserialize_with = "or_default")]
    #[schema(nullable)]
    aircraft: BTreeMap<String, String>,
    #[schema(min_length = 1, max_length = 80)]
    /// The display name of the day; without it, the name of its scenario, or of its network with
    /// the date.
    name: Option<String>,
    /// Its date, for example `2026-11-23`, from 1970 to 2199. Times may then be written in ISO
    /// 8601.
    #[schema(pattern = "^(19[7-9][0-9]|2[01][0-9]{2})-[0-9]{2}-[0-9]{2}$")]
    date: Option<String>,
    /// The time zone of its clock by its name in the IANA database; without it, that of the
    /// network.
    #[schema(min_length = 1)]
    time_zone: Option<String>,
    /// The default policy of its decisions.
    pub(super) policy: Option<String>,
}

/// Passengers who are expected to fly from one vertiport to another in one period.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ForecastRow {
    /// A time within the period, without a date.
    period: Moment,
    /// The vertiport of departure.
    from: String,
    /// The vertiport of destination.
    to: String,
    /// Their number.
    #[schema(format = Int64, maximum = 4_294_967_295u32)]
    passengers: u32,
}

/// The longest name of a day.
const LONGEST_NAME: usize = 80;

impl NewDay {
    /// The day as it is expected before it begins, and the time zone of its network.
    ///
    /// # Errors
    /// Returns an error if there is no such network, or if the inputs make no valid day.
    pub(super) async fn scenario(
        &self,
        service: &Service,
    ) -> Result<(Scenario, Option<String>), Error> {
        let (scenario, zone) = match (&self.network, &self.scenario) {
            (Some(network), None) => {
                let (network, _) = networks::find(&service.days.store, network).await?;
                let seed = DaySeed::comparison(self.seed.unwrap_or(1))?;
                (network.draw(seed), network.time_zone().map(str::to_owned))
            }
            (None, Some(_)) if self.seed.is_some() => {
                let rule = "`seed` goes with `network`: a scenario is drawn already".to_owned();
                return Err(Error::BadRequest { rule });
            }
            (None, Some(scenario)) => {
                (Scenario::from_json(scenario.get().as_bytes(), "scenario")?, None)
            }
            _ => {
                let rule = "name a `network` or give a `scenario`".to_owned();
                return Err(Error::BadRequest { rule });
            }
        };
        Ok((self.changed(scenario.expected())?, zone))
    }

    /// The day with the forecast and the places of aircraft that were given.
    fn changed(&self, scenario: Scenario) -> Result<Scenario, Error> {
        if self.forecast.is_none() && self.aircraft.is_empty() {
            return Ok(scenario);
        }
        let ids = Ids::of(&scenario);
        let mut day = scenario.into_day();
        if let Some(rows) = &self.forecast {
            for table in &mut day.demand {
                *table = Matrix::from_fn(table.size(), |_, _| 0);
            }
            for (at, ForecastRow { period, from, to, passengers }) in rows.iter().enumerate() {
                let wrong =
                    |what: &str| Error::BadRequest { rule: format!("forecast[{at}] {what}") };
                let period = ids.period(period.time())?;
                let pair = (ids.vertiport(from)?, ids.vertiport(to)?);
                if pair.0 == pair.1 {
                    return Err(wrong("leads from a vertiport to itself"));
                }
                let cell = &mut day.demand[period][pair];
                *cell = cell.saturating_add(*passengers);
            }
        }
        for (aircraft, vertiport) in &self.aircraft {
            day.aircraft[ids.aircraft(aircraft)?.at()].at = ids.vertiport(vertiport)?;
        }
        Ok(day.check("the day")?)
    }

    /// Its date and its time zone, both empty if it has no date.
    ///
    /// # Errors
    /// Returns [`Error::BadRequest`] if there is no such date or time zone, or if one is missing.
    pub(super) fn calendar(&self, of_network: Option<String>) -> Result<(String, String), Error> {
        let wrong = |rule: &str| Error::BadRequest { rule: rule.to_owned() };
        let Some(date) = &self.date else {
            return match self.time_zone {
                None => Ok(Default::default()),
                Some(_) => Err(wrong("`time_zone` goes with `date`")),
            };
        };
        let zone = self.time_zone.clone().or(of_network);
        let zone = zone.ok_or_else(|| {
            wrong("a day with a `date` needs a `time_zone`: its network has none")
        })?;
        Calendar::new(date, &zone)?;
        Ok((date.clone(), zone))
    }

    /// Its display name.
    ///
    /// # Errors
    /// Returns [`Error::BadRequest`] if the name is empty, too long, or has a control character.
    pub(super) fn name_of(&self, scenario: &Scenario) -> Result<String, Error> {
        let Some(name) = &self.name else {
            let dated = self.network.as_ref().zip(self.date.as_ref());
            let dated = dated.map(|(network, date)| format!("{network} {date}"));
            return Ok(dated.unwrap_or_else(|| scenario.name.clone()));
        };
        let length = name.chars().count();
        if length == 0 || length > LONGEST_NAME || !is_printed(name) {
            let rule = format!(
                "the `name` of a day has 1 to {LONGEST_NAME} characters, all of them printed ones"
            );
            return Err(Error::BadRequest { rule });
        }
        Ok(name.clone())
    }
}
