//! Imports trip records for measurements: `import_trips VERTIPORTS FILE...` prints the account.

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use vertifleet_core::{Network, Stop};
use vertifleet_import::{Demand, Request, Trips, import};

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [vertiports, files @ ..] = words.as_slice() else {
        return Err("import_trips VERTIPORTS FILE...".into());
    };
    let mut trips = Trips::new(files.iter().map(Path::new).collect());
    trips.decay_mi = Some(1.0);
    let request = Request {
        base: &Network::find("new-york")?,
        name: "measured",
        vertiports: Path::new(vertiports),
        demand: Demand::Trips(trips),
        corridors: None,
        tariffs: None,
        aircraft: None,
        time_zone: None,
        energy_prices: None,
    };
    let begin = Instant::now();
    let imported = import(&request, &Stop::default(), &|_| ())?;
    let seconds = begin.elapsed().as_secs_f64();
    if let Some(account) = imported.account {
        println!("{account}");
        println!("{} passengers a day over {} days", account.passengers_a_day, account.days);
    }
    println!("{seconds:.2} s, {} bytes of network file", imported.toml.len());
    Ok(())
}
