//! The bound without foresight: dollars that no policy earns more than on average if it learns of
//! take-off delays only as they come.
//!
//! Each day that charges to full is bounded with a [`Penalty`] for knowing its delays. Demand,
//! closures and outages are known from the start, as in [`upper_bound`](super::upper_bound).

use vertifleet_core::{Charging, Network, Scenario, Stop, TakeoffDelays};

use super::certificate::Certificate;
use super::ladder::{PathLevels, Relaxed, search};
use super::penalty::Penalty;
use super::penalty::worths::Expected;
use super::prices::whole;
use super::time_expanded_day::TimeExpandedDay;
use super::{Bound, Step, Unless, upper_bound_unless};
use crate::Error;

/// The bound of a day that was drawn from a network, with a penalty for knowing its take-off
/// delays. The mean of these bounds over days that are drawn is at least the mean profit of any
/// policy that does not know the delays of a slot before the slot begins; the bound of one day is
/// no bound on that day alone. It is that of [`upper_bound`](super::upper_bound) where the network
/// has no delays, and on days that charge as needed: the penalty ignores that a delayed aircraft
/// charges for longer, and makes bounds with several levels of charge looser. `None` soon after
/// `stopped` is requested.
///
/// # Errors
/// [`Error::TooManyFlights`] if the day is too large for this step, and [`Error::OtherNetwork`] if
/// the day cannot have been drawn from the network.
pub fn bound_without_foresight(
    stopped: &Stop,
    network: &Network,
    scenario: &Scenario,
    step: Step,
) -> Result<Option<Bound>, Error> {
    let delays = scenario.disturbances.takeoff_delays.as_ref();
    match (delays, network.takeoff_delay_probabilities()) {
        (None, None) => upper_bound_unless(stopped, scenario, step),
        (Some(delays), Some(probabilities)) if can_be_drawn(delays, &probabilities) => {
            match scenario.operations.charging {
                Charging::ToFull => {
                    bound_with_penalty(stopped, scenario, delays, &probabilities, step)
                }
                Charging::AsNeeded => upper_bound_unless(stopped, scenario, step),
            }
        }
        _ => {
            let (day, network) = (scenario.name.clone(), network.name().to_owned());
            Err(Error::OtherNetwork { day, network })
        }
    }
}

/// The same for a day with these delays, which are drawn with these probabilities, by vertiport and
/// seconds.
pub(super) fn bound_with_penalty(
    stopped: &Stop,
    scenario: &Scenario,
    delays: &TakeoffDelays,
    probabilities: &[Vec<f64>],
    step: Step,
) -> Result<Option<Bound>, Error> {
    let expected = expected_day(scenario, delays, probabilities);
    let Some(bound) = upper_bound_unless(stopped, &expected, step)? else { return Ok(None) };
    let day = TimeExpandedDay::of(&expected, &[], bound.step_s(), 1)?;
    let mut certificate = Certificate::new(&day);
    if certificate.evaluate(&day, &bound.prices, stopped).is_none() {
        return Ok(None);
    }
    let expected = Expected { scenario: &expected, day: &day, certificate: &certificate };
    let penalty = Penalty::of(delays, probabilities, &expected);
    let relaxed = Relaxed { penalty: Some(&penalty), ..Relaxed::known(scenario, &[]) };
    let bound = search(relaxed, step, PathLevels::All, &Unless { stopped })?;
    Ok(bound.filter(|_| !stopped.is_requested()))
}

/// Whether all delays of a day have a probability.
fn can_be_drawn(delays: &TakeoffDelays, probabilities: &[Vec<f64>]) -> bool {
    delays.delay_s.iter().all(|slot| {
        slot.len() == probabilities.len()
            && slot.iter().zip(probabilities).all(|(&delay_s, probabilities)| {
                probabilities.get(delay_s as usize).is_some_and(|&probability| probability > 0.0)
            })
    })
}

/// The day as it is expected when it begins: the demand of the forecast, every take-off as late as
/// on the mean, only the closures that are announced, and no outages. All slots have the same
/// expectation, so it does not depend on the draws of the day.
fn expected_day(
    scenario: &Scenario,
    delays: &TakeoffDelays,
    probabilities: &[Vec<f64>],
) -> Scenario {
    let mut day = scenario.clone().into_day();
    let disturbances = &mut day.disturbances;
    if let Some(forecast) = disturbances.forecast.take() {
        day.demand = forecast;
    }
    let mean_s = |probabilities: &Vec<f64>| {
        let seconds =
            probabilities.iter().zip(0..).map(|(share, delay_s)| share * f64::from(delay_s));
        u32::try_from(whole(seconds.sum())).expect("delays are of hours")
    };
    let mean_s: Vec<u32> = probabilities.iter().map(mean_s).collect();
    let in_all_slots = vec![mean_s; delays.delay_s.len()];
    disturbances.takeoff_delays =
        Some(TakeoffDelays { slot_s: delays.slot_s, delay_s: in_all_slots });
    disturbances.closures.retain(|closure| closure.known);
    disturbances.outages.clear();
    day.check("the expected day").expect("a day with fewer disturbances keeps the rules")
}
