//! The observation of `gcaps` and `mlp` (§IV.A): node features, aircraft state and mask, and the
//! remaining share of the day, which only the value head reads.
//!
//! The features of node i are U_i, U_max, d_i, r_i, P_i1..P_iN, R_i1..R_iN, where d_i and r_i are
//! the remaining demand of the current period from and to i. The features of the aircraft are E,
//! its vertiport (one-hot), its battery, and g_x1..g_xN. Every number is divided by a fixed scale
//! from the network file.

use vertifleet_core::{FeatureScales, VertiportIx};
use vertifleet_sim::{Decision, View};

use crate::observation::Observation;

/// The factors that features are multiplied by: the reciprocals of the network file's scales.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scales {
    stands: f32,
    passengers: f32,
    fare_usd: f64,
    cost_usd: f64,
    energy_price_usd: f64,
    battery_kwh: f64,
    power_kw: f64,
}

impl From<FeatureScales> for Scales {
    fn from(scales: FeatureScales) -> Self {
        Self {
            stands: (1.0 / scales.stands) as f32,
            passengers: (1.0 / scales.passengers) as f32,
            fare_usd: 1.0 / scales.fare_usd,
            cost_usd: 1.0 / scales.passenger_cost_usd,
            energy_price_usd: 1.0 / scales.energy_price_usd,
            battery_kwh: 1.0 / scales.battery_kwh,
            power_kw: 1.0 / scales.power_kw,
        }
    }
}

impl Scales {
    /// Writes δ_i of every node into `[N x F]`.
    pub(crate) fn write_nodes(&self, nodes: &mut [f32], view: View<'_>) {
        let vertiports = view.vertiports();
        let left = view.demand_left_in(view.period());
        let width = Observation::Paper.shape(vertiports).node_features;
        assert_eq!(nodes.len(), vertiports * width, "features are of one shape");
        for (i, node) in nodes.chunks_exact_mut(width).enumerate() {
            let from = VertiportIx::new(i);
            let departing: u32 = left[i * vertiports..][..vertiports].iter().sum();
            node[0] = f32::from(view.stands_taken()[i]) * self.stands;
            node[1] = f32::from(view.stands(from)) * self.stands;
            node[2] = departing as f32 * self.passengers;
            let (fares, costs) = node[4..].split_at_mut(vertiports);
            scale_into(fares, view.fares_usd(view.period(), from), self.fare_usd);
            scale_into(costs, view.passenger_costs_usd(from), self.cost_usd);
        }
        for j in 0..vertiports {
            let arriving: u32 = left.iter().skip(j).step_by(vertiports).sum();
            nodes[j * width + 3] = arriving as f32 * self.passengers;
        }
    }

    /// Writes ψ_k into `[G]`. The battery is full at every take-off (Eq. 14), so the charge is the
    /// capacity.
    pub(crate) fn write_aircraft(&self, aircraft: &mut [f32], decision: &Decision, view: View<'_>) {
        let vertiports = view.vertiports();
        let features = Observation::Paper.shape(vertiports).aircraft_features;
        assert_eq!(aircraft.len(), features, "features are of one shape");
        let kind = view.kind(decision.aircraft);
        let (price, rest) = aircraft.split_at_mut(1);
        let (place, rest) = rest.split_at_mut(vertiports);
        let (battery, powers) = rest.split_at_mut(1);
        price[0] = (view.energy_price_usd() * self.energy_price_usd) as f32;
        place.fill(0.0);
        place[decision.at.at()] = 1.0;
        battery[0] = (view.charge_kwh(decision.aircraft) * self.battery_kwh) as f32;
        for (power, leg) in powers.iter_mut().zip(view.legs_from(kind, decision.at)) {
            *power = (leg.mean_power_kw * self.power_kw) as f32;
        }
    }
}

/// The share of the day that is left.
pub(crate) fn clock(view: View<'_>, decision: &Decision) -> f32 {
    let day_s = view.day_end().since(view.day_start()).max(1);
    view.day_end().since(decision.time) as f32 / day_s as f32
}

fn scale_into(to: &mut [f32], from: &[f64], factor: f64) {
    for (to, &from) in to.iter_mut().zip(from) {
        *to = (from * factor) as f32;
    }
}
