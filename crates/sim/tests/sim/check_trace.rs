//! Trace files: a written trace reads back bit for bit, errors name what cannot be read, and
//! nothing panics.

use proptest::prelude::{Strategy, any, prop, prop_assert_eq, proptest};
use proptest::sample::Index;
use vertifleet_core::{AircraftIx, Coded, Scenario, Time, VertiportIx};
use vertifleet_sim::check::check;
use vertifleet_sim::{Trace, TraceError, TraceRow};

use crate::check_as_needed as as_needed;
use crate::check_day::{day, schedule};

fn scenario() -> Scenario {
    day().check("by hand").expect("a day within the rules")
}

fn read(csv: impl AsRef<[u8]>) -> Result<Trace, TraceError> {
    Trace::from_csv(csv.as_ref(), &scenario(), "day.csv")
}

fn refused(csv: impl AsRef<[u8]>) -> String {
    let error = read(csv).expect_err("a broken trace");
    format!("{}: {error}", error.code())
}

#[test]
fn a_trace_reads_as_the_files_page_states() {
    insta::assert_snapshot!(schedule().to_csv(&scenario()), @r#"
    time,aircraft,from,to,passengers,revenue,passenger_cost,energy_kwh,energy_cost,arrival,ready
    06:00:00,A1,V1,V3,4,200,104,45,9,06:50:00,07:35:00
    06:00:00,A2,"V2, by the ""lake""",V1,3,90,39,23,4.6,06:30:00,06:53:00
    06:53:00,A2,V1,V3,2,100,52,45,13.5,07:43:00,08:28:00
    07:35:00,A1,V3,V3,0,0,0,0,0,07:35:00,07:50:00
    07:50:00,A1,V3,V1,0,0,0,45.01166666666667,13.5035,08:40:01,09:25:02
    "#);
}

/// A flight from V1 to V3 costs $7.25, and every aircraft $100 a day.
#[test]
fn a_day_with_flight_costs_has_a_column_for_them() {
    let mut day = scenario().into_day();
    day.flight_cost_usd.cells_mut()[2] = 7.25;
    day.aircraft_cost_usd = 100.0;
    let day = day.check("day").expect("a day within the rules");
    let mut trace = schedule();
    let missing = check(&day, &trace);
    assert_eq!(missing.broken.keys().map(|rule| rule.name()).collect::<Vec<_>>(), ["flight-cost"]);
    for row in &mut trace.rows {
        row.flight_cost_usd = if (row.from.0, row.to.0) == (0, 2) { 7.25 } else { 0.0 };
    }
    let csv = trace.to_csv(&day);
    assert!(csv.starts_with("time,aircraft,") && csv.contains(",ready,flight_cost\n"), "{csv}");
    assert!(csv.contains(",07:35:00,7.25\n"), "{csv}");
    let marked = format!("\u{feff}{}", csv.replace('\n', "\r\n").replace("\n06:", "\n6:"));
    assert_eq!(Trace::from_csv(marked.as_bytes(), &day, "day.csv").expect("a trace"), trace);
    let report = check(&day, &trace);
    assert!(report.is_valid(), "{report}");
    let totals = report.totals;
    assert_eq!((totals.flight_cost_usd, totals.aircraft_cost_usd), (2.0 * 7.25, 2.0 * 100.0));
    let plain = check(&scenario(), &schedule()).totals;
    assert!((totals.profit_usd - (plain.profit_usd - 214.5)).abs() < 1e-9);
    assert!(report.to_string().ends_with("flight cost $14.50 - aircraft cost $200.00"));
    for (csv, day) in [(csv, scenario()), (schedule().to_csv(&scenario()), day)] {
        let error = Trace::from_csv(csv.as_bytes(), &day, "day.csv").expect_err("another header");
        assert_eq!(error.code().to_string(), "V205");
    }
}

#[test]
fn a_written_trace_reads_back_and_replaces_the_file_before_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("day.csv");
    Trace::default().write(&scenario(), &path).expect("a place to write");
    schedule().write(&scenario(), &path).expect("a place to write");
    assert_eq!(Trace::read(&path, &scenario()).expect("a trace"), schedule());
    let files = std::fs::read_dir(folder.path()).expect("the folder").count();
    assert_eq!(files, 1, "nothing is left next to the trace");
}

#[test]
fn files_that_cannot_be_read_or_written_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let nowhere = folder.path().join("nowhere").join("day.csv");
    let error = Trace::read(&nowhere, &scenario()).expect_err("no such file");
    assert_eq!(error.code().to_string(), "V101");
    assert!(error.to_string().contains("day.csv: cannot be read"), "{error}");
    let error = Trace::read(folder.path(), &scenario()).expect_err("a folder");
    assert_eq!(error.code().to_string(), "V101");
    let error = schedule().write(&scenario(), &nowhere).expect_err("no such folder");
    assert_eq!(error.code().to_string(), "V102");
    assert!(error.hint().is_some());
}

#[test]
fn a_file_over_the_limit_is_refused_before_it_is_read() {
    let file = tempfile::NamedTempFile::new().expect("a file");
    file.as_file().set_len((256 << 20) + 1).expect("a hole");
    let error = Trace::read(file.path(), &scenario()).expect_err("too large");
    assert_eq!(error.code().to_string(), "V103");
}

#[test]
fn what_is_wrong_in_a_file_is_named_with_its_line_and_column() {
    let good = schedule().to_csv(&scenario());
    let edited = |from: &str, to: &str| {
        assert!(good.contains(from), "{from}");
        refused(good.replacen(from, to, 1))
    };
    let messages = [
        refused(""),
        edited("time,aircraft", "aircraft,time"),
        edited("06:53:00,A2", "06:53,A2"),
        edited("06:53:00,A2", "06:53:00,A3"),
        edited("A2,V1,V3", "A2,V1,V7"),
        edited("V1,V3,2,", "V1,V3,2.5,"),
        edited("V1,V3,2,", "V1,V3,65536,"),
        edited("104,45,", "104,-45,"),
        edited("104,45,", "NaN,45,"),
        edited("104,45,", "104,1e999,"),
        edited("07:43:00,08:28:00", "07:43:00"),
        edited("07:43:00,08:28:00", "07:43:00,08:28:00,"),
        edited("\"lake\"", "lake"),
        edited("\"\"lake", "\"lake"),
        edited("07:43:00", "07:43:\u{fffd}".repeat(50).as_str()),
    ];
    insta::assert_snapshot!(messages.join("\n"), @r#"
    V205: day.csv: line 1: the header must be "time,aircraft,from,to,passengers,revenue,passenger_cost,energy_kwh,energy_cost,arrival,ready", found ""
    V205: day.csv: line 1: the header must be "time,aircraft,from,to,passengers,revenue,passenger_cost,energy_kwh,energy_cost,arrival,ready", found "aircraft,time,from,to,passengers,revenue,passenger_cost,energy_kwh,energy_cost,arrival,ready"
    V208: day.csv: line 4: time must be a time as HH:MM:SS, found "06:53"
    V207: day.csv: line 4: aircraft "A3" is not among the scenario's aircraft
    V207: day.csv: line 4: to "V7" is not among the scenario's vertiports
    V208: day.csv: line 4: passengers must be a whole number from 0 to 65535, found "2.5"
    V208: day.csv: line 4: passengers must be a whole number from 0 to 65535, found "65536"
    V208: day.csv: line 2: energy_kwh must be a finite number, at least 0, found "-45"
    V208: day.csv: line 2: passenger_cost must be a finite number, at least 0, found "NaN"
    V208: day.csv: line 2: energy_kwh must be a finite number, at least 0, found "1e999"
    V206: day.csv: line 4: a row must have 11 values, found 10
    V206: day.csv: line 4: a row must have 11 values, found 12
    V207: day.csv: line 3: from "V2, by the lake\"\"" is not among the scenario's vertiports
    V207: day.csv: line 3: from "V2, by the lake\"\"\"" is not among the scenario's vertiports
    V208: day.csv: line 4: arrival must be a time as HH:MM:SS, found "07:43:�07:43:�07:43:�07:43:�07:43:�07:43:�07:43:�07:43:�07:43:�07:43:�07:43:�07:43:�07:43:�07:43:�07:43:�07:43:�07:43:�0..."
    "#);
}

#[test]
fn lines_are_counted_as_an_editor_counts_them() {
    let good = schedule().to_csv(&scenario());
    let broken = good.replace("07:43:00", "soon");
    assert!(refused(&broken).contains("line 4:"));
    assert!(refused(broken.replace('\n', "\r\n")).contains("line 4:"));
    assert!(refused(broken.replace('\n', "\n\n")).contains("line 7:"));
}

#[test]
fn files_that_spreadsheets_saved_are_read() {
    let good = schedule().to_csv(&scenario());
    assert_eq!(read(good.replace('\n', "\r\n")).expect("a trace"), schedule());
    assert_eq!(read(format!("\u{feff}{good}")).expect("a trace"), schedule());
    assert_eq!(read(good.trim_end()).expect("a trace"), schedule());
}

/// Any row at all, including those of aircraft and vertiports that do not exist.
fn any_row() -> impl Strategy<Value = TraceRow> {
    let index = || prop::strategy::Union::new([(0_u16..4).boxed(), any::<u16>().boxed()]);
    let time = || {
        prop::strategy::Union::new([(21_600_u32..30_000).boxed(), any::<u32>().boxed()])
            .prop_map(Time::from_seconds)
    };
    let amounts = prop::array::uniform4(any::<f64>());
    let times = (time(), time(), time(), time());
    (times, index(), index(), index(), any::<u16>(), amounts).prop_map(
        |((time, takeoff, arrival, ready), aircraft, from, to, passengers, amounts)| TraceRow {
            time,
            aircraft: AircraftIx(aircraft),
            from: VertiportIx(from),
            to: VertiportIx(to),
            passengers,
            revenue_usd: amounts[0],
            passenger_cost_usd: amounts[1],
            energy_kwh: amounts[2],
            energy_cost_usd: amounts[3],
            flight_cost_usd: amounts[0],
            charge_kwh: amounts[3],
            takeoff,
            arrival,
            ready,
        },
    )
}

/// Rows that a file can hold: with ids of this scenario and amounts that are not negative.
fn storable_row() -> impl Strategy<Value = TraceRow> {
    let amount =
        || any::<f64>().prop_filter("a finite number", |n| n.is_finite()).prop_map(f64::abs);
    let time = || (0_u32..10_000 * 3600).prop_map(Time::from_seconds);
    let amounts = (amount(), amount(), amount(), amount());
    (any_row(), 0_u16..2, 0_u16..3, 0_u16..3, amounts, (time(), time(), time())).prop_map(
        |(row, aircraft, from, to, amounts, times)| TraceRow {
            time: times.0,
            aircraft: AircraftIx(aircraft),
            from: VertiportIx(from),
            to: VertiportIx(to),
            revenue_usd: amounts.0,
            passenger_cost_usd: amounts.1,
            energy_kwh: amounts.2,
            energy_cost_usd: amounts.3,
            flight_cost_usd: 0.0,
            charge_kwh: 0.0,
            takeoff: times.0,
            arrival: times.1,
            ready: times.2,
            ..row
        },
    )
}

proptest! {
    #[test]
    fn what_is_written_reads_back_bit_for_bit(rows in prop::collection::vec(storable_row(), 0..8)) {
        let trace = Trace { rows };
        let back = read(trace.to_csv(&scenario())).expect("what was written");
        prop_assert_eq!(back, trace);
    }

    #[test]
    fn no_bytes_panic_the_reader(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let _ = read(&bytes);
        let header = schedule().to_csv(&scenario()).lines().next().expect("a header").to_owned();
        let _ = read([header.as_bytes(), b"\n", &bytes].concat());
    }

    #[test]
    fn no_edit_of_a_good_file_panics_reader_or_checker(
        edits in prop::collection::vec((any::<Index>(), 0_u8..3, prop::sample::select(b"\",\n\r:-.0129eV\0\xff".to_vec())), 1..6)
    ) {
        let mut csv = schedule().to_csv(&scenario()).into_bytes();
        for (at, kind, byte) in edits {
            let at = at.index(csv.len());
            match kind {
                0 => csv[at] = byte,
                1 => csv.insert(at, byte),
                _ => drop(csv.remove(at)),
            }
        }
        if let Ok(trace) = read(&csv) {
            let _ = check(&scenario(), &trace).to_string();
        }
    }

    #[test]
    fn no_rows_panic_the_checker(rows in prop::collection::vec(any_row(), 0..12)) {
        let trace = Trace { rows };
        for day in [day(), as_needed::day(), as_needed::with_taper(as_needed::day())] {
            let report = check(&day.check("day").expect("a day within the rules"), &trace);
            prop_assert_eq!(report.is_valid(), report.findings.is_empty());
        }
    }
}
