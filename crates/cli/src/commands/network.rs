//! `vertifleet network`: makes, checks and shows network files.

use std::io::{IsTerminal, Write as _, stdin};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anstream::{eprint, eprintln};
use serde_json::json;
use vertifleet_core::{Coded, Network, OutputKind, Outputs, Stop, Warning, write_atomically};
use vertifleet_import::{
    Demand, NewNetwork, NewVertiport, Request, TripColumns, TripValue, Trips, import,
};
use vertifleet_progress::Bar;
use vertifleet_study::network_overview::NetworkOverview;

use crate::args::{ImportArguments, NetworkAction, NewArguments};
use crate::commands::export::{PNG_FILE, SVG_FILE};
use crate::commands::find_network;
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;
use crate::output::{print, warn};
use crate::typed::parse_vertiport;

/// No file begins with this text, so an existing network file, which may have been edited, is never
/// replaced without `--force`.
const NEW_FILE: OutputKind = OutputKind { name: "new network file", skipped: 0, opening: "\0" };

/// The steps of the progress of an import.
const STEPS: u32 = 1_000;

pub(crate) fn run(action: &NetworkAction) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    match action {
        NetworkAction::Import(arguments) => run_import(arguments),
        NetworkAction::Check { files, json } => check(files, *json),
        NetworkAction::Show { network, picture, force, json } => {
            show(network, picture.as_deref(), *force, *json)
        }
        NetworkAction::New(arguments) => new(arguments),
        NetworkAction::Diff { one, other, json } => diff(one, other, *json),
    }
}

fn run_import(arguments: &ImportArguments) -> Result<ExitCode, Failure> {
    refuse_flags_of_trips_without_trips(arguments)?;
    let mut outputs = Outputs::new(arguments.force);
    let base = find_network(&arguments.base, &mut outputs)?;
    let optional = [
        &arguments.demand,
        &arguments.zones,
        &arguments.corridors,
        &arguments.fares,
        &arguments.energy_prices,
    ];
    let read =
        optional.into_iter().flatten().chain([&arguments.vertiports]).chain(&arguments.trips);
    read.for_each(|path| outputs.reads(path));
    if let Some(output) = &arguments.output {
        outputs.writes(output, &NEW_FILE)?;
    }
    let demand = match &arguments.demand {
        Some(table) => Demand::Table(table),
        None => Demand::Trips(trips(arguments)?),
    };
    let request = Request {
        base: &base,
        name: &arguments.name,
        vertiports: &arguments.vertiports,
        demand,
        corridors: arguments.corridors.as_deref(),
        tariffs: arguments.fares.as_deref(),
        aircraft: arguments.aircraft,
        time_zone: arguments.time_zone.as_deref(),
        energy_prices: arguments.energy_prices.as_deref(),
    };
    let bar = Bar::new(STEPS.into(), "thousandths read");
    let done = std::sync::Mutex::new(0);
    let progress = |share: f64| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1000")]
        let now = (f64::from(STEPS) * share.clamp(0.0, 1.0)) as u64;
        let mut before = done.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        bar.advance(now.saturating_sub(*before));
        *before = now.max(*before);
    };
    // Ctrl-C ends the program; the file is written completely or not at all.
    let imported = import(&request, &Stop::default(), &progress)?;
    drop(bar);
    if let Some(output) = &arguments.output {
        write_atomically(output, imported.toml.as_bytes())?;
    }
    for warning in &imported.warnings {
        warn(warning.code(), warning);
    }
    // The import reports passengers outside the hours of operation, so the warning is not repeated.
    let said = |warning: &Warning| matches!(warning, Warning::OutsideOperations { .. });
    for warning in imported.network.warnings().into_iter().filter(|warning| !said(warning)) {
        warn(warning.code(), &warning);
    }
    if arguments.json {
        let account = json!({
            "network": imported.network.name(),
            "trips": imported.account,
            "inherited": { "from": base.name(), "members": imported.inherited },
        });
        print(&serde_json::to_string_pretty(&account).expect("plain data"))?;
    } else if let Some(account) = &imported.account {
        print(&account.to_string())?;
        if arguments.dry_run {
            print(account.dropped_rows().trim_end())?;
        }
    }
    eprintln!("inherited from {}: {}", base.name(), imported.inherited.join(", "));
    match &arguments.output {
        Some(output) => eprintln!("written: {}", output.display()),
        None => eprintln!("nothing was written"),
    }
    Ok(ExitCode::SUCCESS)
}

/// Refuses flags that would have no effect.
fn refuse_flags_of_trips_without_trips(arguments: &ImportArguments) -> Result<(), Failure> {
    let flags = arguments.flags_of_trips();
    if !arguments.trips.is_empty() || flags.is_empty() {
        return Ok(());
    }
    let (flags, say) = (flags.join(", "), if flags.len() == 1 { "says" } else { "say" });
    let message = format!("{flags} {say} how trip records become demand, and --trips is not given");
    let hint = "--demand takes mean passengers as they are: leave these flags out, or give --trips in its place";
    Err(Failure::usage(message, hint))
}

/// The trip records and how they become demand.
fn trips(arguments: &ImportArguments) -> Result<Trips<'_>, Failure> {
    let start = Trips::new(arguments.trips.iter().map(PathBuf::as_path).collect());
    Ok(Trips {
        columns: trip_columns(&arguments.trip_columns)?,
        zones: arguments.zones.as_deref(),
        radius_mi: arguments.radius.unwrap_or(start.radius_mi),
        mode_share: arguments.mode_share.unwrap_or(start.mode_share),
        decay_mi: arguments.decay,
        weekdays: arguments.weekdays.unwrap_or(start.weekdays),
        first_date: arguments.first_date,
        last_date: arguments.last_date,
        time_format: arguments.time_format.clone(),
        ..start
    })
}

/// The columns of the trip records that are named, each once.
fn trip_columns(named: &[(TripValue, String)]) -> Result<TripColumns<'_>, Failure> {
    let mut columns = TripColumns::default();
    for (at, (value, column)) in named.iter().enumerate() {
        if named[..at].iter().any(|(before, _)| before == value) {
            let message = format!("--trip-columns names two columns for {}", value.name());
            return Err(Failure::usage(message, "all files of trips have the same columns"));
        }
        columns = columns.with(*value, column);
    }
    Ok(columns)
}

/// Prints every finding about network files. The exit code is that of bad input if one of them
/// cannot be used.
fn check(files: &[PathBuf], as_json: bool) -> Result<ExitCode, Failure> {
    let (mut lines, mut list, mut errors) = (Vec::new(), Vec::new(), 0);
    for file in files {
        let network = match Network::read_or_findings(file)? {
            Ok(network) => Some(network),
            Err(findings) => {
                errors += findings.len();
                for error in &findings {
                    lines.push(format!("error[{}]: {error}", error.code()));
                    lines.extend(error.hint().map(|hint| format!("hint: {hint}")));
                    list.push(json!({
                        "file": file, "kind": "error", "code": error.code().to_string(),
                        "message": error.to_string(), "hint": error.hint(),
                    }));
                }
                None
            }
        };
        if let Some(network) = network {
            for warning in network.warnings() {
                lines.push(format!("warning[{}]: {}: {warning}", warning.code(), file.display()));
                list.push(json!({
                    "file": file, "kind": "warning", "code": warning.code().to_string(),
                    "message": warning.to_string(), "hint": null,
                }));
            }
            lines.push(format!("{}: {} can be used", file.display(), network.name()));
        }
    }
    print(&if as_json {
        serde_json::to_string_pretty(&list).expect("plain data")
    } else {
        lines.join("\n")
    })?;
    Ok(if errors == 0 { ExitCode::SUCCESS } else { ExitCode::from(2) })
}

fn show(
    network: &str,
    picture: Option<&Path>,
    force: bool,
    as_json: bool,
) -> Result<ExitCode, Failure> {
    let mut outputs = Outputs::new(force);
    let network = find_network(network, &mut outputs)?;
    if let Some(path) = picture {
        let svg = || vertifleet_picture::network(&network.mean_day(), &network.mean_demand());
        match path.extension().and_then(|end| end.to_str()) {
            Some("svg") => {
                outputs.writes(path, &SVG_FILE)?;
                write_atomically(path, svg().as_bytes())?;
            }
            Some("png") => {
                outputs.writes(path, &PNG_FILE)?;
                write_atomically(path, &vertifleet_picture::png(&svg()))?;
            }
            _ => {
                let message = format!("{}: a picture ends in .svg or .png", path.display());
                return Err(Failure::usage(message, "name the file otherwise"));
            }
        }
    }
    let overview = NetworkOverview::of(&network);
    print(&if as_json {
        serde_json::to_string_pretty(&overview).expect("plain data")
    } else {
        vertifleet_report::network(&overview).text()
    })?;
    Ok(ExitCode::SUCCESS)
}

fn new(arguments: &NewArguments) -> Result<ExitCode, Failure> {
    Outputs::new(arguments.force).writes(&arguments.output, &NEW_FILE)?;
    let mut vertiports = arguments.vertiports.clone();
    let name = match &arguments.name {
        Some(name) => name.clone(),
        None => ask("--name", "name of the network, for example bay", |text| Ok(text.to_owned()))?,
    };
    while arguments.vertiports.is_empty() {
        let what = "a vertiport as ID,LATITUDE,LONGITUDE,STANDS, or nothing if there are no more";
        match ask("--vertiport", what, ask_vertiport)? {
            Some(vertiport) => vertiports.push(vertiport),
            None => break,
        }
    }
    let number = |text: &str| text.parse().map_err(|_| "expected a number".to_owned());
    let aircraft = match arguments.aircraft {
        Some(aircraft) => aircraft,
        None => ask("--aircraft", "number of aircraft", |text| {
            text.parse().map_err(|_| "expected a whole number".to_owned())
        })?,
    };
    let passengers_a_day = match arguments.passengers {
        Some(passengers) => passengers,
        None => ask("--passengers", "passengers who want to fly on a day", number)?,
    };
    let fare_usd_per_mi = match arguments.fare {
        Some(fare) => fare,
        None => ask("--fare", "fare a mile, dollars", number)?,
    };
    let network = NewNetwork { name, vertiports, aircraft, passengers_a_day, fare_usd_per_mi };
    write_atomically(&arguments.output, network.toml()?.as_bytes())?;
    eprintln!("written: {}", arguments.output.display());
    eprintln!(
        "next: look for the word assumption in it, then vertifleet network show {}",
        arguments.output.display()
    );
    Ok(ExitCode::SUCCESS)
}

fn ask_vertiport(text: &str) -> Result<Option<NewVertiport>, String> {
    if text.is_empty() { Ok(None) } else { parse_vertiport(text).map(Some) }
}

/// Asks the user for a value that no flag gives, until the answer is valid. Without a terminal it
/// returns an error that names the flag.
fn ask<T>(flag: &str, what: &str, read: impl Fn(&str) -> Result<T, String>) -> Result<T, Failure> {
    loop {
        if !stdin().is_terminal() {
            let message = format!("{flag} is not given, and there is no terminal to ask on");
            return Err(Failure::usage(message, "give the flag, or run the command in a terminal"));
        }
        eprint!("{what}: ");
        std::io::stderr().flush().map_err(|error| Failure::internal(&error))?;
        let mut line = String::new();
        let read_bytes = stdin().read_line(&mut line).map_err(|error| Failure::internal(&error))?;
        if read_bytes == 0 {
            return Err(Failure::usage(format!("{flag} is not given"), "give the flag"));
        }
        match read(line.trim()) {
            Ok(answer) => return Ok(answer),
            Err(problem) => eprintln!("{problem}"),
        }
    }
}

fn diff(one: &str, other: &str, as_json: bool) -> Result<ExitCode, Failure> {
    let mut outputs = Outputs::new(false);
    let (before, after) = (find_network(one, &mut outputs)?, find_network(other, &mut outputs)?);
    let differences = before.differences(&after);
    let line = |difference: &vertifleet_core::Difference| {
        let text = |value: &Option<String>| value.clone().unwrap_or_else(|| "nothing".to_owned());
        let place = match &difference.demand {
            Some(cell) => format!("demand from {} to {} at {}", cell.from, cell.to, cell.period),
            None => difference.path.clone().unwrap_or_default(),
        };
        format!("{place}: {} -> {}", text(&difference.before), text(&difference.after))
    };
    print(&if as_json {
        serde_json::to_string_pretty(&differences).expect("plain data")
    } else if differences.is_empty() {
        "no difference".to_owned()
    } else {
        differences.iter().map(line).collect::<Vec<_>>().join("\n")
    })?;
    Ok(ExitCode::SUCCESS)
}
