//! What the observations of a day need besides the day.

use vertifleet_core::{FeatureScales, Network};
use vertifleet_policy::{PriceMemory, Shortlist};

use crate::paper::Scales;
use crate::{full, priced};

/// The scales of a network, which divide the paper's parts, and two caches. Parts that contain
/// prices need the cache of bid prices, and parts of the full observation the cache of flights.
/// Days that are played in parallel should have an observer each.
#[derive(Debug, Clone)]
pub struct Observer {
    pub(crate) scales: Scales,
    pub(crate) prices: PriceMemory,
    pub(crate) shortlist: Shortlist,
    pub(crate) priced: priced::Eye,
    pub(crate) full: full::Eye,
}

impl Observer {
    /// An observer of the days of a network.
    pub fn of(network: &Network) -> Self {
        Self::scaled(network.feature_scales())
    }

    fn scaled(scales: FeatureScales) -> Self {
        Self {
            scales: Scales::from(scales),
            prices: PriceMemory::default(),
            shortlist: Shortlist::default(),
            priced: priced::Eye::default(),
            full: full::Eye::default(),
        }
    }
}

impl Default for Observer {
    /// An observer without a network: the paper's parts stay in their units.
    fn default() -> Self {
        Self::scaled(FeatureScales {
            stands: 1.0,
            passengers: 1.0,
            fare_usd: 1.0,
            passenger_cost_usd: 1.0,
            energy_price_usd: 1.0,
            battery_kwh: 1.0,
            power_kw: 1.0,
        })
    }
}
