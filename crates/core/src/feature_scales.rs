//! The divisors of the features of learned policies (§IV.A): fixed numbers of the network file, never learned from
//! days.

use serde::{Deserialize, Serialize};

use crate::{Error, limits};

/// The size that each quantity typically has in a network; a feature is the quantity divided by it. All are above 0.
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
    /// Checks that every scale is above 0 and finite; `origin` names the file in messages.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for the first scale that is not.
    pub fn check(self, origin: &str) -> Result<Self, Error> {
        for (member, value) in [
            ("stands", self.stands),
            ("passengers", self.passengers),
            ("fare_usd", self.fare_usd),
            ("passenger_cost_usd", self.passenger_cost_usd),
            ("energy_price_usd", self.energy_price_usd),
            ("battery_kwh", self.battery_kwh),
            ("power_kw", self.power_kw),
        ] {
            let member = || format!("feature_scales: {member}");
            limits::FEATURE_SCALE.check(value, origin, member)?;
        }
        Ok(self)
    }
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
    pub(crate) fn check(self, origin: &str) -> Result<FeatureScales, Error> {
        let Self {
            stands,
            passengers,
            fare_usd,
            passenger_cost_usd,
            energy_price_usd,
            battery_kwh,
            power_kw,
        } = self;
        let scales = FeatureScales {
            stands,
            passengers,
            fare_usd,
            passenger_cost_usd,
            energy_price_usd,
            battery_kwh,
            power_kw,
        };
        scales.check(origin)
    }
}

impl TryFrom<RawFeatureScales> for FeatureScales {
    type Error = Error;

    fn try_from(raw: RawFeatureScales) -> Result<Self, Error> {
        raw.check("model")
    }
}

#[cfg(test)]
mod tests {
    use crate::{FeatureScales, Network};

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
