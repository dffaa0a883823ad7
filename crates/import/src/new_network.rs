//! A network file to start from: a few vertiports, a fleet, a demand in passengers a day, and a
//! comment on every line that is an assumption.

use vertifleet_core::{FormatError, Network};

use crate::Error;

/// The name of the text in messages.
const ORIGIN: &str = "the new network";

/// The settings of a new network. Everything else is an assumption, which its file names.
#[derive(Debug, Clone, PartialEq)]
pub struct NewNetwork {
    /// Its name.
    pub name: String,
    /// Its vertiports.
    pub vertiports: Vec<NewVertiport>,
    /// Number of aircraft.
    pub aircraft: u32,
    /// Passengers of all pairs together who want to fly on a day.
    pub passengers_a_day: f64,
    /// The fare of a passenger a mile, dollars.
    pub fare_usd_per_mi: f64,
}

/// A vertiport of a new network.
#[derive(Debug, Clone, PartialEq)]
pub struct NewVertiport {
    /// Its name.
    pub id: String,
    /// Latitude in degrees; north is above 0.
    pub latitude: f64,
    /// Longitude in degrees; east is above 0.
    pub longitude: f64,
    /// Number of stands.
    pub stands: u32,
}

impl NewNetwork {
    /// The text of the network file. It has been read, so that it can be used as it is.
    ///
    /// # Errors
    /// The error of the network file if a value breaks one of its rules.
    pub fn toml(&self) -> Result<String, Error> {
        if self.vertiports.is_empty() {
            // A TOML file cannot have an empty list of tables, so the text would only lack a
            // member.
            let member = "vertiports".to_owned();
            return Err(FormatError::EntryCount { member, most: 256, found: 0 }
                .in_file(ORIGIN)
                .into());
        }
        let text = self.text();
        Network::from_toml(&text, ORIGIN)?;
        Ok(text)
    }

    fn text(&self) -> String {
        let quoted = |text: &str| toml_edit::Value::from(text).to_string();
        let number = |number: f64| toml_edit::Value::from(number).to_string();
        let vertiport = |one: &NewVertiport| {
            format!(
                "[[vertiports]]\nid = {id}\nlatitude = {latitude}\nlongitude = {longitude}\nstands = {stands}\nbusy = false\n\n",
                id = quoted(&one.id),
                latitude = number(one.latitude),
                longitude = number(one.longitude),
                stands = one.stands,
            )
        };
        let vertiports = self.vertiports.iter().map(vertiport).collect::<Vec<_>>().concat();
        let weights = vec!["1"; self.vertiports.len()].join(", ");
        TEMPLATE
            .replace("{name}", &quoted(&self.name))
            .replace("{vertiports}", &vertiports)
            .replace("{aircraft}", &self.aircraft.to_string())
            .replace("{passengers}", &number(self.passengers_a_day))
            .replace("{fare}", &number(self.fare_usd_per_mi))
            .replace("{weights}", &weights)
    }
}

/// The file, with names in braces where the values of a new network go.
const TEMPLATE: &str = include_str!("new_network.toml");

#[cfg(test)]
mod tests {
    use vertifleet_core::{Coded, DaySeed, Network};

    use super::{NewNetwork, NewVertiport};

    fn bay() -> NewNetwork {
        let vertiport = |id: &str, latitude, longitude, stands| NewVertiport {
            id: id.to_owned(),
            latitude,
            longitude,
            stands,
        };
        NewNetwork {
            name: "bay".to_owned(),
            vertiports: vec![
                vertiport("SFO", 37.61882, -122.3758, 5),
                vertiport("OAK \"East\"", 37.72125, -122.22115, 4),
                vertiport("SJC", 37.3639, -121.92894, 4),
            ],
            aircraft: 8,
            passengers_a_day: 1_500.0,
            fare_usd_per_mi: 4.5,
        }
    }

    #[test]
    fn a_new_network_can_be_used_at_once() {
        let text = bay().toml().expect("a network");
        let network = Network::from_toml(&text, "bay.toml").expect("a network");
        assert_eq!((network.fleet_size(), network.vertiports().len()), (8, 3));
        assert_eq!(network.vertiports()[1].id, "OAK \"East\"");
        assert!(network.warnings().is_empty());
        let passengers: f64 =
            network.mean_demand().iter().flat_map(|table| table.cells().to_vec()).sum();
        assert!((passengers - 1_500.0).abs() < 1.0, "{passengers}");
        network.draw(DaySeed::comparison(1).expect("a seed"));
        insta::assert_snapshot!(text);
    }

    #[test]
    fn what_the_format_refuses_is_refused() {
        let codes = [
            (NewNetwork { name: "my bay".to_owned(), ..bay() }, "V112"),
            (NewNetwork { aircraft: 14, ..bay() }, "V117"),
            (NewNetwork { passengers_a_day: f64::NAN, ..bay() }, "V104"),
            (NewNetwork { vertiports: Vec::new(), ..bay() }, "V108"),
        ];
        for (network, code) in codes {
            let error = network.toml().expect_err("no network");
            assert_eq!(error.code().to_string(), code, "{error}");
        }
    }
}
