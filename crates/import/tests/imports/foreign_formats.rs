//! Files of other programs are named for what they are, with the remedy.

use vertifleet_core::Coded;
use vertifleet_import::Demand;

use crate::planner::{Folder, new_york, request, run, run_table};

const POINT: &str = r#"{"type":"Feature","properties":{"id":"A"},"geometry":{"type":"Point","coordinates":[-74,40.7]}}"#;

#[test]
fn tables_of_other_kinds_are_named() {
    let folder = Folder::new();
    let (base, places) = (new_york(), folder.path("vertiports.csv"));
    let lines = "{\"period\":6,\"from\":\"A\"}\n{\"period\":7,\"from\":\"B\"}\n";
    let bytes: [(&[u8], &str); 20] = [
        (b"<NUMBER OF ZONES> 24\n<TOTAL OD FLOW> 360600.0\n<END OF METADATA>\n", "TNTP"),
        (b"\n<NUMBER OF ZONES> 24\n", "TNTP"),
        (b"~ trips of Sioux Falls\n\n<NUMBER OF ZONES> 24\n", "TNTP"),
        (b"Node\tX\tY\t;\n1\t-96.77\t43.61\t;\n", "TNTP"),
        (b"~\tinit_node\tterm_node\tlength\t;\n\t1\t2\t6\t;\n", "TNTP"),
        (b"Origin  1 \n    1 :      0.0;     2 :    100.0;\n", "TNTP"),
        (b"\xff\xff\xff\xff\x60\x01\0\0\x10\0\0\0\0\0\x0a\0", "an Arrow IPC stream"),
        (b"ORC\x0a\x06\x12\x04\x08\x03\x50\0", "an ORC file"),
        (b"\xef\xbb\xbf<?xml version=\"1.0\"?><kml/>", "XML"),
        (b"MATLAB 5.0 MAT-file\0\x01\xff\xee", "no text"),
        (b"\x80\x04\x95\x13\0\0\0", "no text"),
        (b"\x89HDF\r\n\x1a\n\0\0\0\0\0\0\0\0", "OMX"),
        (b"FEA1\0\0\0\0\0\0\0\0\0\0\0\0", "Feather"),
        (b"ARROW1\0\0\xff\xff\xff\xff\0\0\0\0", "Feather"),
        (b"fgb\x03fgb\0\0\0\0\0\0\0\0\0", "FlatGeobuf"),
        (lines.as_bytes(), "JSON lines"),
        (b"[{\"period\":6}]", "a JSON list"),
        (
            b"{\"last_updated\":1,\"ttl\":0,\"data\":{\"stations\":[{\"station_id\":\"1\"}]}}",
            "GBFS",
        ),
        (b"{\"type\":\"FeatureCollection\",\"features\":[]}", "GeoJSON"),
        (b"\x1e{\"type\":\"Feature\"}\n", "newline-delimited GeoJSON"),
    ];
    for (content, name) in bytes {
        let demand = folder.file("demand.csv", content);
        let error = run(&request(&base, &places, Demand::Table(&demand))).expect_err(name);
        assert_eq!(error.code().0, 701, "{name}: {error}");
        assert!(error.to_string().contains(name), "{name}: {error}");
        let remedy = ["write", "export"].iter().any(|word| error.to_string().contains(word));
        assert!(remedy, "{name} without a remedy: {error}");
    }
}

#[test]
fn maps_of_other_kinds_are_named() {
    let folder = Folder::new();
    let base = new_york();
    let demand = folder.file("demand.csv", "period,from,to,passengers\n7,A,B,14\n");
    for (content, name) in [
        (r#"{"type":"Topology","objects":{},"arcs":[]}"#.to_owned(), "TopoJSON"),
        (format!("{POINT}\n{POINT}\n"), "newline-delimited GeoJSON"),
        (format!("\u{1e}{POINT}\n\u{1e}{POINT}\n"), "newline-delimited GeoJSON"),
        (r#"{"last_updated":1,"ttl":0,"data":{"stations":[]}}"#.to_owned(), "GBFS"),
        (r#"{"geometryType":"esriGeometryPoint","features":[]}"#.to_owned(), "Esri"),
    ] {
        for file in ["places.geojson", "places.json", "places"] {
            let places = folder.file(file, &content);
            let error = run(&request(&base, &places, Demand::Table(&demand))).expect_err(name);
            assert_eq!(error.code().0, 701, "{name}: {error}");
            assert!(error.to_string().contains(name), "{file}, {name}: {error}");
        }
    }
}

#[test]
fn the_first_name_of_a_table_may_begin_as_a_foreign_file_does() {
    // "ORC" begins ORC files, and a name of a column or vertiport as well.
    for name in ["ORCHARD", "ORC", "Origin", "~"] {
        let table = format!("{name},period,from,to,passengers\n1,7,JRB,JFK,14\n");
        run_table(&Folder::new(), &table).expect("a network");
    }
}
