//! An import in which one file has any bytes and all others are valid, for the targets that fuzz
//! the readers of planners' files.
//!
//! If the name of a file does not reveal its format, readers detect GeoJSON and Parquet by the
//! first bytes; so one target covers all formats of its file.

use std::fs;
use std::path::PathBuf;
use std::sync::{LazyLock, Once};

use vertifleet_core::{DaySeed, Network, Stop};
use vertifleet_import::{Demand, Request, Trips, import};

pub const VERTIPORTS: &str =
    "id,latitude,longitude,stands\nJRB,40.70112,-74.0088,40\nJFK,40.63993,-73.77869,40\n";
pub const DEMAND: &str = "from,to,period,passengers\nJRB,JFK,7,14\nJFK,JRB,08:00:00,2.5e0\n";
pub const ZONES: &str =
    "zone,latitude,longitude\n12,40.70112,-74.0088\nKennedy,40.63993,-73.77869\n";
pub const TRIPS: &str =
    "pickup_datetime,PULocationID,DOLocationID\n2015-06-01 07:30:00,12.0,Kennedy\n";
pub const CORRIDORS: &str = r#"{"type":"FeatureCollection","features":[{"type":"Feature",
"properties":{"from":"JRB","to":"JFK"},
"geometry":{"type":"LineString","coordinates":[[-74.0088,40.70112],[-73.77869,40.63993]]}}]}"#;
pub const FARES: &str = "from,to,fare_usd,passenger_cost_usd\nJRB,JFK,120,\nJFK,JRB,,20\n";

static BASE: LazyLock<Network> =
    LazyLock::new(|| Network::shipped("new-york").expect("it is shipped"));
/// One folder for all imports of a process, since files are only read in it.
static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let folder = std::env::temp_dir().join(format!("vertifleet-fuzz-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder that can be made");
    for (name, text) in [
        ("vertiports", VERTIPORTS),
        ("demand", DEMAND),
        ("trips", TRIPS),
        ("zones", ZONES),
        ("corridors", CORRIDORS),
        ("fares", FARES),
    ] {
        fs::write(folder.join(name), text).expect("room");
    }
    folder
});

/// Imports with these bytes in place of one file, and returns whether that made a network. The
/// import may refuse the bytes, but must not panic; days can be drawn from a network that it makes.
pub fn import_with(any: &str, bytes: &[u8]) -> bool {
    stop_at_panics_of_ours();
    let path = FOLDER.join("any");
    fs::write(&path, bytes).expect("room");
    let file = |name: &str| if name == any { path.clone() } else { FOLDER.join(name) };
    let (vertiports, table, records) = (file("vertiports"), file("demand"), file("trips"));
    let (zones, corridors, fares) = (file("zones"), file("corridors"), file("fares"));
    let demand = if any == "trips" || any == "zones" {
        let mut trips = Trips::new(vec![records.as_path()]);
        (trips.zones, trips.radius_mi) = (Some(zones.as_path()), 5.0);
        Demand::Trips(trips)
    } else {
        Demand::Table(&table)
    };
    let request = Request {
        base: &BASE,
        name: "imported",
        vertiports: &vertiports,
        demand,
        corridors: (any == "corridors").then_some(corridors.as_path()),
        tariffs: (any == "fares").then_some(fares.as_path()),
        aircraft: None,
        time_zone: None,
        energy_prices: None,
    };
    match import(&request, &Stop::default(), &|_| ()) {
        Ok(imported) => {
            imported.network.draw(DaySeed::comparison(1).expect("a small seed"));
            true
        }
        Err(error) => {
            assert!(error.to_string().len() < 2_500, "messages stay short");
            false
        }
    }
}

/// libFuzzer ends the process at every panic, including those of the Parquet library, which its
/// reader turns into errors. With this hook, only panics of this project's crates end it at once;
/// any other that is not caught still ends the run.
fn stop_at_panics_of_ours() {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        std::panic::set_hook(Box::new(|panic| {
            let is_ours = panic.location().is_none_or(|place| {
                place.file().contains("crates/") || place.file().starts_with("fuzz_targets")
            });
            if is_ours {
                eprintln!("{panic}");
                std::process::abort();
            }
        }));
    });
}
