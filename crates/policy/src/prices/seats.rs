//! The seats that passengers ask for. Flights are whole: passengers of a pair and demand period
//! fill some flights, and the rest flies on one more that leaves partly empty, if that pays.

/// The seats that the passengers of a pair and demand period ask for.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Seats {
    /// Seats of the flights that leave full.
    pub(super) of_full_flights: f64,
    /// Seats of the flight that takes the other passengers; 0 if there is none.
    of_last_flight: f64,
    /// Price of a seat, dollars, above which the last flight is asked for too.
    last_flight_above_usd: f64,
}

impl Seats {
    /// What passengers who bring `margin_usd` each ask for, on aircraft that all have `a_flight`
    /// seats, or if that is `None`, on aircraft with several numbers of seats, which are taken to
    /// fill any number of seats.
    pub(super) fn of(passengers: u32, a_flight: Option<u32>, margin_usd: f64) -> Self {
        let rest = a_flight.map_or(0, |seats| passengers % seats);
        let one_flight = a_flight.filter(|&seats| seats < passengers && rest > 0);
        let Some(a_flight) = one_flight else {
            return Self { of_full_flights: passengers.into(), ..Self::default() };
        };
        let empty = f64::from(a_flight - rest) / f64::from(a_flight);
        Self {
            of_full_flights: (passengers - rest).into(),
            of_last_flight: a_flight.into(),
            last_flight_above_usd: empty * margin_usd.max(0.0),
        }
    }

    /// The number of seats asked for at a price.
    #[inline]
    pub(super) fn at(self, price_usd: f64) -> f64 {
        let asks_for_last = price_usd > self.last_flight_above_usd;
        self.of_full_flights + if asks_for_last { self.of_last_flight } else { 0.0 }
    }

    /// The price that aircraft pay for these seats, less the fares of the seats that stay empty,
    /// dollars.
    #[inline]
    pub(super) fn surplus_usd(self, price_usd: f64) -> f64 {
        let last_usd = (price_usd - self.last_flight_above_usd).max(0.0);
        self.of_full_flights * price_usd + self.of_last_flight * last_usd
    }
}

#[cfg(test)]
mod tests {
    use super::Seats;

    /// The most that passengers have beyond what flights of `a_flight` seats keep of their margin,
    /// and the seats of these flights, by trying every number of flights.
    fn best(passengers: u32, a_flight: u32, margin_usd: f64, price_usd: f64) -> (f64, f64) {
        let flights = (0..=passengers / a_flight + 2).map(|flights| {
            let seats = flights * a_flight;
            let brought_usd = margin_usd * f64::from(seats.min(passengers));
            (brought_usd - (margin_usd - price_usd) * f64::from(seats), f64::from(seats))
        });
        flights.max_by(|one, other| one.0.total_cmp(&other.0)).expect("there is a number")
    }

    #[test]
    fn whole_flights_leave_passengers_the_most() {
        for (a_flight, price_usd) in [1, 4, 9]
            .into_iter()
            .flat_map(|seats| [0.5, 3.0, 9.9, 16.1, 29.0].map(|price_usd| (seats, price_usd)))
        {
            for passengers in a_flight..4 * a_flight {
                let seats = Seats::of(passengers, Some(a_flight), 30.0);
                let (best_usd, number) = best(passengers, a_flight, 30.0, price_usd);
                assert!((seats.surplus_usd(price_usd) - best_usd).abs() < 1e-9);
                assert_eq!(
                    seats.at(price_usd),
                    number,
                    "{passengers} for {a_flight} at {price_usd}"
                );
            }
        }
    }

    #[test]
    fn passengers_who_fill_no_flight_ask_for_their_own_seats() {
        for a_flight in [Some(4), None] {
            let few = Seats::of(3, a_flight, 30.0);
            assert_eq!((few.at(0.0), few.at(29.0), few.surplus_usd(10.0)), (3.0, 3.0, 30.0));
        }
        assert_eq!(Seats::of(5, None, 30.0).at(29.0), 5.0);
    }
}
