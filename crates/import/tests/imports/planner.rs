//! A folder with a planner's files, and requests for them.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;
use vertifleet_core::{Network, Stop};
use vertifleet_import::{Demand, Error, Imported, Request, Trips, import};

/// Three vertiports of New York, as a table.
pub(crate) const VERTIPORTS: &str = "\
id,latitude,longitude,stands,chargers,busy,name
JRB,40.70112,-74.00880,12,,true,Downtown Manhattan
JFK,40.63993,-73.77869,20,6,false,Kennedy
EWR,40.69248,-74.16869,8,,false,Newark
";

/// A line on a map.
pub(crate) fn line(properties: &str, positions: &str) -> String {
    format!(
        r#"{{"type":"Feature","properties":{{{properties}}},"geometry":{{"type":"LineString","coordinates":[{positions}]}}}}"#
    )
}

/// A point on a map.
pub(crate) fn point(properties: &str, longitude: f64, latitude: f64) -> String {
    format!(
        r#"{{"type":"Feature","properties":{{{properties}}},"geometry":{{"type":"Point","coordinates":[{longitude},{latitude}]}}}}"#
    )
}

/// A map of features.
pub(crate) fn map(features: &[String]) -> String {
    format!(r#"{{"type":"FeatureCollection","features":[{}]}}"#, features.join(","))
}

/// A folder with files.
pub(crate) struct Folder(TempDir);

impl Folder {
    /// A folder with the table of [`VERTIPORTS`].
    pub(crate) fn new() -> Self {
        let folder = Self(tempfile::tempdir().expect("a folder"));
        folder.file("vertiports.csv", VERTIPORTS);
        folder
    }

    /// Writes a file and returns its path.
    pub(crate) fn file(&self, name: &str, contents: impl AsRef<[u8]>) -> PathBuf {
        fs::write(self.path(name), contents).expect("a free folder");
        self.path(name)
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// An error's message without the path of this folder.
    pub(crate) fn message(&self, error: &Error) -> String {
        error.to_string().replace(&format!("{}/", self.0.path().display()), "")
    }
}

/// A request with the vertiports of a folder and nothing but a demand.
pub(crate) fn request<'a>(
    base: &'a Network,
    vertiports: &'a Path,
    demand: Demand<'a>,
) -> Request<'a> {
    Request {
        base,
        name: "imported",
        vertiports,
        demand,
        corridors: None,
        tariffs: None,
        aircraft: None,
        time_zone: None,
        energy_prices: None,
    }
}

pub(crate) fn new_york() -> Network {
    Network::shipped("new-york").expect("it is shipped")
}

/// Imports without a report of progress.
pub(crate) fn run(request: &Request<'_>) -> Result<Imported, Error> {
    import(request, &Stop::default(), &|_| ())
}

/// Imports trips to the vertiports of a folder.
pub(crate) fn run_trips(folder: &Folder, trips: Trips<'_>) -> Result<Imported, Error> {
    let (base, vertiports) = (new_york(), folder.path("vertiports.csv"));
    run(&request(&base, &vertiports, Demand::Trips(trips)))
}

/// Imports a table of demand to the vertiports of a folder.
pub(crate) fn run_table(folder: &Folder, table: &str) -> Result<Imported, Error> {
    let (base, vertiports) = (new_york(), folder.path("vertiports.csv"));
    let table = folder.file("demand.csv", table);
    run(&request(&base, &vertiports, Demand::Table(&table)))
}
