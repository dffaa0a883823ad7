//! The arguments of the dispatch service and of those who operate days through it.

use std::net::SocketAddr;
use std::path::PathBuf;

use clap::{Args, Subcommand};
use vertifleet_serve::Role;

use crate::typed::{parse_name, parse_seed};

#[derive(Debug, Args)]
pub(crate) struct ServeArguments {
    /// Address to listen on
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:8080")]
    pub(crate) listen: SocketAddr,
    /// Folder of the data, made at the first start
    #[arg(long, value_name = "DIR", default_value = "vertifleet-data", global = true)]
    pub(crate) data: PathBuf,
    /// PostgreSQL database to keep the data in, instead of the folder
    #[arg(long, value_name = "URL", global = true)]
    pub(crate) database: Option<String>,
    /// Speak TLS with the certificate in this PEM file, its chain included
    #[arg(long, value_name = "FILE", requires = "key")]
    pub(crate) certificate: Option<PathBuf>,
    /// PEM file with the key of the certificate
    #[arg(long, value_name = "FILE", requires = "certificate")]
    pub(crate) key: Option<PathBuf>,
    /// A proxy that speaks TLS stands before the service, which may then listen on other addresses
    #[arg(long, conflicts_with = "certificate")]
    pub(crate) behind_proxy: bool,
    /// Send spans of requests to this collector of OpenTelemetry [default:
    /// OTEL_EXPORTER_OTLP_ENDPOINT, or to none]
    #[arg(long, value_name = "URL")]
    pub(crate) otlp: Option<String>,
    /// Show this base map in the console instead of the bundled one: a style of MapLibre, or a
    /// PMTiles file
    #[arg(long, value_name = "URL")]
    pub(crate) basemap: Option<String>,
    /// Show simulated, disturbed days of New York at 60 times their speed, one after the other, and
    /// keep nothing
    #[arg(long, conflicts_with_all = ["data", "database", "certificate", "behind_proxy"])]
    pub(crate) demo: bool,
    #[command(subcommand)]
    pub(crate) action: Option<ServeAction>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum ServeAction {
    /// Make, list and revoke tokens
    #[command(subcommand)]
    Token(TokenAction),
    /// Check every event of every day
    Verify,
    /// Copy the data to a new file, while the service may run
    Backup {
        /// The file
        file: PathBuf,
    },
    /// Put a copy back, into a folder without data
    Restore {
        /// The copy
        file: PathBuf,
    },
    /// Print who did what beside the events of days, a JSON object a line
    Audit,
    /// Print a day with all its events as JSON
    Export {
        /// The id of the day
        day: String,
    },
}

#[derive(Debug, Subcommand)]
pub(crate) enum TokenAction {
    /// Make a token and print it; it cannot be printed again
    Make {
        /// What the token is called in the record of who did what
        #[arg(long, value_parser = parse_token_name)]
        name: String,
        /// What it permits
        #[arg(long, value_parser = parse_role)]
        role: Role,
    },
    /// List the tokens, without their secrets, as JSON
    List,
    /// Revoke a token
    Revoke {
        /// The token's id, which is the part after vf_
        id: String,
    },
}

#[derive(Debug, Args)]
pub(crate) struct OperateArguments {
    /// Address of the service, for example http://127.0.0.1:8080
    pub(crate) url: String,
    /// Network file, the name of a shipped network, random:NUMBER, or random-places:SIZE:NUMBER
    #[arg(long, default_value = "paper")]
    pub(crate) network: String,
    /// Seed of the day
    #[arg(long, default_value_t = 1, allow_hyphen_values = true, value_parser = parse_seed)]
    pub(crate) seed: u64,
    /// The policy that decides
    #[arg(long, default_value = "gcaps-x", value_parser = parse_name)]
    pub(crate) policy: String,
    /// Seconds of the day that pass in a second, or max
    #[arg(long, default_value = "max", value_parser = parse_speed)]
    pub(crate) speed: Speed,
    /// Leave the decisions to others, such as people at the console, and wait for each
    #[arg(long)]
    pub(crate) by_hand: bool,
    /// PEM file with certificates to trust, for a service whose certificate is its own
    #[arg(long, value_name = "FILE")]
    pub(crate) trust: Option<PathBuf>,
    /// Print the day's numbers as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// What a token is called.
fn parse_token_name(text: &str) -> Result<String, String> {
    match text.trim() {
        "" => Err("expected a name, by which people know who did what".to_owned()),
        name => Ok(name.to_owned()),
    }
}

/// How fast a day is operated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Speed {
    /// Seconds of the day in a second.
    Times(f64),
    /// As fast as the service answers.
    Max,
}

/// The speed of a day.
fn parse_speed(text: &str) -> Result<Speed, String> {
    match text.parse() {
        _ if text == "max" => Ok(Speed::Max),
        Ok(times) if (1.0..=1e6).contains(&times) => Ok(Speed::Times(times)),
        _ => Err("expected a number from 1 to 1000000, or max".to_owned()),
    }
}

/// What a token permits.
fn parse_role(text: &str) -> Result<Role, String> {
    let known = Role::ALL.map(Role::name).join(", ");
    Role::named(text).ok_or_else(|| format!("expected one of {known}"))
}
