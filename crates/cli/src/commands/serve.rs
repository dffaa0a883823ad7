//! `vertifleet serve`: runs the dispatch service, and manages its tokens.

mod demo;

use std::process::ExitCode;

use anstream::eprintln;
use tracing_subscriber::EnvFilter;
use tracing_subscriber::filter::LevelFilter;
use vertifleet_serve::{
    Contents, DayCheck, Keeper, Limits, Location, Protection, Settings, Tokens, restore, serve,
};

use crate::args::{ServeAction, ServeArguments, TokenAction};
use crate::failure::Failure;
use crate::interrupt::stop_on_interrupt;
use crate::output::print;

pub(crate) fn run(arguments: &ServeArguments) -> Result<ExitCode, Failure> {
    let location = match &arguments.database {
        Some(url) => Location::Postgres(url.clone()),
        None => Location::Folder(arguments.data.clone()),
    };
    match &arguments.action {
        Some(ServeAction::Token(action)) => {
            let tokens = match action {
                TokenAction::Make { .. } => Tokens::open(&location)?,
                TokenAction::List | TokenAction::Revoke { .. } => Tokens::open_existing(&location)?,
            };
            eprintln!("tokens of {}", place(arguments));
            keep_tokens(&tokens, action)?;
        }
        Some(ServeAction::Verify) => return verify(&Keeper::open(&location)?),
        Some(ServeAction::Backup { file }) => {
            Keeper::open(&location)?.backup(file)?;
            eprintln!("copied {} to {}", place(arguments), file.display());
        }
        Some(ServeAction::Restore { file }) => {
            if arguments.database.is_some() {
                return Err(Failure::usage(
                    "`restore` puts a copy back into a folder".to_owned(),
                    "a PostgreSQL database is restored by its own programs, psql or pg_restore",
                ));
            }
            let Contents { days, events } = restore(file, &arguments.data)?;
            eprintln!("put {days} days with {events} events back into {}", place(arguments));
        }
        Some(ServeAction::Audit) => {
            for record in Keeper::open(&location)?.audit()? {
                print(&serde_json::to_string(&record).expect("plain data can be written"))?;
            }
        }
        Some(ServeAction::Export { day }) => print(&Keeper::open(&location)?.export(day)?)?,
        None if arguments.demo => demo::run(arguments)?,
        None => {
            let stop = stop_on_interrupt()?;
            let settings = settings(arguments, location);
            let scheme = match settings.protection {
                Protection::Tls { .. } => "https",
                Protection::None | Protection::Proxy => "http",
            };
            let listens = |address| {
                eprintln!(
                    "listening on {scheme}://{address}, with the data in {}",
                    place(arguments)
                );
            };
            serve(&settings, listens, &stop)?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// The settings of the service. Logging starts here.
fn settings(arguments: &ServeArguments, location: Location) -> Settings {
    log_to_stderr();
    Settings {
        listen: arguments.listen,
        location,
        protection: protection(arguments),
        limits: Limits::default(),
        collector: collector(arguments),
        basemap: arguments.basemap.clone(),
    }
}

/// The protection of connections against eavesdropping.
fn protection(arguments: &ServeArguments) -> Protection {
    match (&arguments.certificate, &arguments.key) {
        (Some(certificate), Some(key)) => {
            Protection::Tls { certificate: certificate.clone(), key: key.clone() }
        }
        _ if arguments.behind_proxy => Protection::Proxy,
        _ => Protection::None,
    }
}

/// The collector that spans are sent to: the one of the command line, or else that of
/// OpenTelemetry's standard variable.
fn collector(arguments: &ServeArguments) -> Option<String> {
    let told = || std::env::var("OTEL_EXPORTER_OTLP_ENDPOINT").ok().filter(|url| !url.is_empty());
    arguments.otlp.clone().or_else(told)
}

/// The location of the data, for messages.
fn place(arguments: &ServeArguments) -> String {
    let data = &arguments.data;
    let folder = || std::path::absolute(data).unwrap_or_else(|_| data.clone());
    let in_database = arguments.database.as_ref().map(|_| "the database".to_owned());
    in_database.unwrap_or_else(|| folder().display().to_string())
}

/// Prints the findings about each day. The exit code is 1 if something is damaged.
fn verify(keeper: &Keeper) -> Result<ExitCode, Failure> {
    let mut is_sound = true;
    let mut printed = Ok(());
    keeper.verify(|DayCheck { day, events, finding }| {
        is_sound &= finding.is_none();
        let finding = finding.unwrap_or_else(|| "sound".to_owned());
        let line = print(&format!("{day}: {events} events, {finding}"));
        if printed.is_ok() {
            printed = line;
        }
    })?;
    printed?;
    Ok(if is_sound { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Logs as JSON, one line each: errors and warnings, or the levels in `RUST_LOG`.
fn log_to_stderr() {
    let filter =
        EnvFilter::builder().with_default_directive(LevelFilter::WARN.into()).from_env_lossy();
    tracing_subscriber::fmt().json().with_env_filter(filter).with_writer(std::io::stderr).init();
}

fn keep_tokens(tokens: &Tokens, action: &TokenAction) -> Result<(), Failure> {
    match action {
        TokenAction::Make { name, role } => print(&tokens.make(name, *role)?),
        TokenAction::List => {
            let list = serde_json::to_string_pretty(&tokens.list()?);
            print(&list.expect("plain data can be written"))
        }
        TokenAction::Revoke { id } => Ok(tokens.revoke(id)?),
    }
}
