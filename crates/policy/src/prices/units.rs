//! The unit of money of a day: the profit of a typical full flight.

use vertifleet_core::{TypeIx, VertiportIx};
use vertifleet_sim::View;

/// Profit of a typical full flight of each type of aircraft, dollars: the mean over all pairs
/// within range, at the fares and the energy price of the first period. It is one dollar where
/// there is no such pair or flying does not pay.
pub fn units_usd(view: View<'_>) -> Vec<f64> {
    TypeIx::all(view.aircraft_types().len()).map(|kind| unit_usd(view, kind)).collect()
}

fn unit_usd(view: View<'_>, kind: TypeIx) -> f64 {
    let energy_price_usd = view.energy_prices_usd()[0];
    let seats = f64::from(view.aircraft_type(kind).seats);
    let (mut sum_usd, mut pairs) = (0.0, 0_u32);
    for from in VertiportIx::all(view.vertiports()) {
        for to in view.within_range(kind, from).iter() {
            let margin_usd =
                view.fares_usd(0, from)[to.at()] - view.passenger_costs_usd(from)[to.at()];
            let energy_kwh = view.leg(kind, from, to).energy_kwh;
            sum_usd += seats * margin_usd
                - energy_kwh * energy_price_usd
                - view.flight_costs_usd(from)[to.at()];
            pairs += 1;
        }
    }
    (sum_usd / f64::from(pairs.max(1))).max(1.0)
}
