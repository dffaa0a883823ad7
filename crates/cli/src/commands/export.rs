//! `vertifleet export`: writes a played or planned day in the formats of other programs.

use std::fs;
use std::path::Path;
use std::process::ExitCode;

use anstream::eprintln;
use vertifleet_core::{OutputKind, Outputs, write_atomically};
use vertifleet_export::{
    CSV_FILE, Calendar, Flown, GEOJSON_FILE, GTFS_FILE, ICALENDAR_FILE, PARQUET_FILE, csv, geojson,
    gtfs, icalendar, parquet,
};
use vertifleet_sim::Trace;

use crate::args::{ExportArguments, ExportFormat};
use crate::commands::read_scenario;
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;

/// The first bytes of every SVG and PNG file, of this program or any other.
pub(crate) const SVG_FILE: OutputKind =
    OutputKind { name: "SVG picture", skipped: 0, opening: "<svg xmlns=" };
pub(crate) const PNG_FILE: OutputKind =
    OutputKind { name: "PNG picture", skipped: 1, opening: "PNG\r\n" };

pub(crate) fn run(arguments: &ExportArguments) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    let scenario = read_scenario(&arguments.scenario)?;
    let trace = Trace::read(&arguments.trace, &scenario)?;
    let mut outputs = Outputs::new(arguments.force);
    outputs.reads(&arguments.scenario);
    outputs.reads(&arguments.trace);
    let date = arguments.date.as_deref();
    let calendar = date.map(|date| Calendar::new(date, &arguments.time_zone)).transpose()?;
    let flown = Flown::new(&scenario, &trace.rows)?;
    let path = &arguments.output;
    let (kind, content) = match arguments.format {
        ExportFormat::Csv => (CSV_FILE, csv(&flown, calendar.as_ref())),
        ExportFormat::Parquet => (PARQUET_FILE, parquet(&flown, calendar.as_ref())),
        ExportFormat::Geojson => {
            (GEOJSON_FILE, geojson(&flown, dated(calendar.as_ref())?)?.into_bytes())
        }
        ExportFormat::Gtfs => (GTFS_FILE, gtfs(&flown, dated(calendar.as_ref())?)?),
        ExportFormat::Svg => {
            (SVG_FILE, arguments.picture.draw(&scenario, &trace.rows).into_bytes())
        }
        ExportFormat::Png => {
            let picture = arguments.picture.draw(&scenario, &trace.rows);
            (PNG_FILE, vertifleet_picture::png(&picture))
        }
        ExportFormat::Icalendar => {
            write_calendars(&flown, dated(calendar.as_ref())?, path, &mut outputs)?;
            return Ok(ExitCode::SUCCESS);
        }
    };
    outputs.writes(path, &kind)?;
    write_atomically(path, &content)?;
    eprintln!("written: {}", path.display());
    Ok(ExitCode::SUCCESS)
}

/// The calendar of a format that needs one.
fn dated(calendar: Option<&Calendar>) -> Result<&Calendar, Failure> {
    calendar.ok_or_else(|| {
        let message = "this format has dates, and the day has none".to_owned();
        Failure::usage(message, "add --date, as 2026-11-24, and --time-zone, as America/New_York")
    })
}

/// Writes the calendar of each vertiport into a folder.
fn write_calendars(
    flown: &Flown<'_>,
    calendar: &Calendar,
    folder: &Path,
    outputs: &mut Outputs,
) -> Result<(), Failure> {
    let calendars = icalendar(flown, calendar);
    fs::create_dir_all(folder).map_err(|cause| {
        let origin = folder.display().to_string();
        Failure::from(vertifleet_core::Error::CannotWrite { origin, cause })
    })?;
    for one in &calendars {
        outputs.writes(&folder.join(&one.file), &ICALENDAR_FILE)?;
    }
    for one in &calendars {
        write_atomically(&folder.join(&one.file), one.text.as_bytes())?;
    }
    eprintln!("written: {} calendars in {}", calendars.len(), folder.display());
    Ok(())
}
