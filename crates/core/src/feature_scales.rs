//! The divisors of the features of learned policies (§IV.A): fixed numbers of the network file,
//! never learned from days.

use serde::{Deserialize, Serialize};

use crate::scenario::Day;
use crate::{AircraftType, Error, FormatError, Matrix, limits};

/// The size that each quantity typically has in a network; a feature is the quantity divided by it.
/// All are above 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "RawFeatureScales")]
pub struct FeatureScales {
    /// U_i, the aircraft at a vertiport, and U_max, its stands.
    pub stands: f64,
    /// d_i and r_i, the passengers of one period who leave a vertiport or want to reach it.
    pub passengers: f64,
    /// P_ij, dollars a passenger.
    pub fare_usd: f64,
    /// R_ij, dollars a passenger.
    pub passenger_cost_usd: f64,
    /// E, dollars per kWh.
    pub energy_price_usd: f64,
    /// B, the battery's charge, kWh.
    pub battery_kwh: f64,
    /// g_ij, the mean power of a flight, kW.
    pub power_kw: f64,
}

impl FeatureScales {
    /// Scales for a network whose file has none: the mean of each quantity. `mean_demand` is the
    /// mean demand of each period.
    pub(crate) fn typical(day: &Day, mean_demand: &[Matrix<f64>]) -> Self {
        let pairs =
            |matrix: &Matrix<f64>| mean(matrix.cells().iter().copied().filter(|&x| x > 0.0));
        let types = &day.aircraft_types;
        let distance_mi = pairs(&day.distance_mi);
        let windows_h = f64::from(day.operations.takeoff_s + day.operations.landing_s) / 3_600.0;
        let power_kw = |kind: &AircraftType| {
            kind.energy_kwh_per_mi * distance_mi / (windows_h + distance_mi / kind.speed_mph)
        };
        let leaving =
            |matrix: &Matrix<f64>| matrix.cells().iter().sum::<f64>() / day.vertiports.len() as f64;
        Self {
            stands: mean(day.vertiports.iter().map(|vertiport| f64::from(vertiport.stands))),
            passengers: mean(mean_demand.iter().map(leaving)).max(1.0),
            fare_usd: pairs(day.fare_usd.in_period(0)),
            passenger_cost_usd: pairs(&day.passenger_cost_usd),
            energy_price_usd: mean(day.energy_price_usd.iter().copied()),
            battery_kwh: mean(types.iter().map(|kind| kind.battery_kwh)),
            power_kw: mean(types.iter().map(power_kw)),
        }
    }
}

/// The mean of some numbers, or 1 if it is not above 0.
fn mean(numbers: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = numbers.fold((0.0, 0.0), |(sum, count), number| (sum + number, count + 1.0));
    if sum > 0.0 { sum / count } else { 1.0 }
}

/// The scales as they are written, before the check.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of feature_scales")]
pub(crate) struct RawFeatureScales {
    stands: f64,
    passengers: f64,
    fare_usd: f64,
    passenger_cost_usd: f64,
    energy_price_usd: f64,
    battery_kwh: f64,
    power_kw: f64,
}

impl RawFeatureScales {
    /// Checks that every scale is above 0 and finite.
    pub(crate) fn check(self) -> Result<FeatureScales, FormatError> {
        let number = |value, member: &str| {
            let checked =
                limits::FEATURE_SCALE.check(value, || format!("feature_scales: {member}"));
            checked.map(|()| value)
        };
        Ok(FeatureScales {
            stands: number(self.stands, "stands")?,
            passengers: number(self.passengers, "passengers")?,
            fare_usd: number(self.fare_usd, "fare_usd")?,
            passenger_cost_usd: number(self.passenger_cost_usd, "passenger_cost_usd")?,
            energy_price_usd: number(self.energy_price_usd, "energy_price_usd")?,
            battery_kwh: number(self.battery_kwh, "battery_kwh")?,
            power_kw: number(self.power_kw, "power_kw")?,
        })
    }
}

impl TryFrom<RawFeatureScales> for FeatureScales {
    type Error = Error;

    fn try_from(raw: RawFeatureScales) -> Result<Self, Error> {
        raw.check().map_err(|error| error.in_file("model"))
    }
}

#[cfg(test)]
mod tests {
    use crate::{FeatureScales, Network};

    #[test]
    fn a_file_without_scales_has_typical_ones() {
        let paper = Network::shipped("paper").expect("shipped");
        let (text, _) = paper.toml().split_once("[feature_scales]").expect("it has scales");
        let found =
            Network::from_toml(text, "paper").expect("scales are optional").feature_scales();
        let given = paper.feature_scales();
        for (found, given) in [
            (found.stands, given.stands),
            (found.passengers, given.passengers),
            (found.fare_usd, given.fare_usd),
            (found.passenger_cost_usd, given.passenger_cost_usd),
            (found.energy_price_usd, given.energy_price_usd),
            (found.battery_kwh, given.battery_kwh),
            (found.power_kw, given.power_kw),
        ] {
            assert!((0.5..2.0).contains(&(found / given)), "{found} instead of about {given}");
        }
    }

    #[test]
    fn scales_read_back_as_written_and_only_if_above_zero() {
        let scales = Network::shipped("paper").expect("shipped").feature_scales();
        let text = serde_json::to_string(&scales).expect("plain numbers");
        let again: FeatureScales = serde_json::from_str(&text).expect("our own text");
        assert_eq!(again, scales);
        for bad in ["0", "-6", "1e300"] {
            let text = text.replacen("6.0", bad, 1);
            let error = serde_json::from_str::<FeatureScales>(&text).expect_err("not a scale");
            assert!(error.to_string().contains("stands must be"), "{error}");
        }
    }
}
