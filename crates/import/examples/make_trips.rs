//! Writes invented trip records for measurements: `make_trips COUNT FILE [SEED [NETWORK [ROWS]]]`.
//!
//! The records are around the vertiports of a network that places them by latitude and longitude,
//! `new-york` if none is named. FILE ends with `.csv` or `.parquet`, whose row groups have ROWS
//! rows. The vertiports go to a file `vertiports.csv` next to it.

#[path = "../tests/imports/made.rs"]
mod made;

use std::error::Error;
use std::fmt::Write;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::Path;

use vertifleet_core::Network;

const ROWS_OF_GROUP: usize = 1 << 20;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [count, path, rest @ ..] = words.as_slice() else {
        return Err("make_trips COUNT FILE [SEED [NETWORK [ROWS]]]".into());
    };
    let seed = rest.first().map_or(Ok(1), |seed| seed.parse())?;
    let network = Network::find(rest.get(1).map_or("new-york", String::as_str))?;
    let rows = rest.get(2).map_or(Ok(ROWS_OF_GROUP), |rows| rows.parse())?;
    let path = Path::new(path);
    let mut table = "id,latitude,longitude,stands\n".to_owned();
    let mut around = Vec::new();
    for vertiport in network.vertiports() {
        let degrees = vertiport.degrees.ok_or("the network has no latitudes and longitudes")?;
        around.push((degrees.latitude, degrees.longitude));
        let (latitude, longitude) = (degrees.latitude, degrees.longitude);
        writeln!(table, "{},{latitude},{longitude},{}", vertiport.id, vertiport.stands)?;
    }
    fs::write(path.with_file_name("vertiports.csv"), table)?;
    let trips = made::trips(&around, count.parse()?, seed);
    let file = BufWriter::with_capacity(1 << 20, File::create(path)?);
    if path.extension().is_some_and(|extension| extension == "parquet") {
        made::write_parquet(file, trips, rows)?;
    } else {
        made::write_csv(file, trips)?;
    }
    Ok(())
}
