//! Pipes are files like others: `<(...)`, `/dev/stdin` and named pipes give their bytes once, and
//! an import from them equals that from plain files.

use std::io::{PipeReader, Write, pipe};
use std::os::fd::AsRawFd;
use std::path::PathBuf;
use std::thread::{self, JoinHandle};

use flate2::Compression;
use flate2::write::GzEncoder;
use vertifleet_core::Coded;
use vertifleet_import::{Demand, Error, Imported, Trips};

use crate::made::{trips, write_csv, write_parquet};
use crate::planner::{Folder, VERTIPORTS, new_york, request, run};

/// A pipe with some content, as `<(...)` gives one.
struct Pipe {
    reader: PipeReader,
    writer: JoinHandle<()>,
}

impl Pipe {
    fn of(content: impl Into<Vec<u8>>) -> Self {
        let (reader, mut writer) = pipe().expect("a pipe");
        let content = content.into();
        // The reader may close the pipe before it has read all.
        let writer = thread::spawn(move || drop(writer.write_all(&content)));
        Self { reader, writer }
    }

    fn path(&self) -> PathBuf {
        format!("/dev/fd/{}", self.reader.as_raw_fd()).into()
    }

    fn end(self) {
        drop(self.reader);
        self.writer.join().expect("no panic");
    }
}

/// The parts of an import that do not name its files.
fn parts(imported: Result<Imported, Error>) -> (Vec<Vec<f64>>, Option<[u64; 2]>, Vec<String>) {
    let imported = imported.expect("a network");
    let demand = imported.network.mean_demand();
    let demand = demand.iter().map(|table| table.cells().to_vec()).collect();
    let rows = imported.account.as_ref().map(|account| [account.rows, account.kept]);
    let dropped = imported.account.map(|account| account.first_dropped).unwrap_or_default();
    (demand, rows, dropped.into_iter().map(|row| format!("{} {}", row.place, row.row)).collect())
}

fn gzip(content: &[u8]) -> Vec<u8> {
    let mut packed = GzEncoder::new(Vec::new(), Compression::fast());
    packed.write_all(content).expect("written");
    packed.finish().expect("written")
}

fn zip(content: &[u8]) -> Vec<u8> {
    let mut packed = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    packed.start_file("trips.csv", zip::write::SimpleFileOptions::default()).expect("begun");
    packed.write_all(content).expect("written");
    packed.finish().expect("written").into_inner()
}

#[test]
fn trip_records_in_a_pipe_are_those_of_a_plain_file() {
    let folder = Folder::new();
    let (base, vertiports) = (new_york(), folder.path("vertiports.csv"));
    let places = [(40.70112, -74.0088), (40.63993, -73.77869), (40.69248, -74.16869)];
    // More than one block of lines, and more than a pipe holds.
    let (mut csv, mut parquet) = (Vec::new(), Vec::new());
    write_csv(&mut csv, trips(&places, 60_000, 1)).expect("written");
    write_parquet(&mut parquet, trips(&places, 20_000, 1), 7_000).expect("written");
    for content in [csv.clone(), gzip(&csv), zip(&csv), parquet] {
        let imported = |path: &PathBuf| {
            parts(run(&request(&base, &vertiports, Demand::Trips(Trips::new(vec![path])))))
        };
        let plain = imported(&folder.file("trips", &content));
        let pipe = Pipe::of(content);
        assert_eq!(imported(&pipe.path()), plain);
        pipe.end();
    }
}

#[test]
fn tables_in_pipes_are_those_of_plain_files() {
    const DEMAND: &str = "period,from,to,passengers\n7,JRB,JFK,14\n8,JFK,JRB,3\n";
    const FARES: &str = "from,to,fare_usd\nJRB,JFK,95\n";
    const PRICES: &str = "period,price_usd_per_kwh\n0,0.1\n8,0.3\n";
    const WAY: &str = r#"{"type":"FeatureCollection","features":[{"type":"Feature","properties":{"from":"JRB","to":"JFK"},"geometry":{"type":"LineString","coordinates":[[-74.0088,40.70112],[-73.77869,40.63993]]}}]}"#;
    let texts = [VERTIPORTS, DEMAND, FARES, PRICES, WAY];
    let base = new_york();
    let imported = |paths: [&PathBuf; 5]| {
        let mut request = request(&base, paths[0], Demand::Table(paths[1]));
        (request.tariffs, request.energy_prices) =
            (Some(paths[2].as_path()), Some(paths[3].as_path()));
        request.corridors = Some(paths[4].as_path());
        let imported = run(&request).expect("a network");
        let numbers = imported.toml.lines().filter(|line| !line.starts_with('#'));
        numbers.collect::<Vec<_>>().join("\n")
    };
    let folder = Folder::new();
    let files = [0, 1, 2, 3, 4].map(|at| folder.file(&format!("file-{at}"), texts[at]));
    let pipes = texts.map(Pipe::of);
    let paths = [0, 1, 2, 3, 4].map(|at| pipes[at].path());
    assert_eq!(imported(paths.each_ref()), imported(files.each_ref()));
    pipes.into_iter().for_each(Pipe::end);
}

#[test]
fn the_errors_of_a_pipe_name_it_and_too_long_ones_end() {
    let folder = Folder::new();
    let base = new_york();
    let demand = folder.file("demand.csv", "period,from,to,passengers\n7,JRB,JFK,14\n");
    for (content, code) in [("id,latitude\n".to_owned(), 702), (" ".repeat((16 << 20) + 9), 103)] {
        let pipe = Pipe::of(content);
        let path = pipe.path();
        let error = run(&request(&base, &path, Demand::Table(&demand))).expect_err("an error");
        assert_eq!(error.code().0, code, "{error}");
        assert!(error.to_string().starts_with(&path.display().to_string()), "{error}");
        pipe.end();
    }
}
