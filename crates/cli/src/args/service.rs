//! The arguments of the dispatch service and of `operate`.

use std::net::SocketAddr;
use std::path::PathBuf;

use clap::{Args, Subcommand};
use vertifleet_serve::Role;

use super::NETWORK;
use crate::typed::{parse_name, parse_seed};

#[derive(Debug, Args)]
pub(crate) struct ServeArguments {
    /// Address to listen on; one beyond this machine needs a token, and TLS or --behind-proxy
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:8080")]
    pub(crate) listen: SocketAddr,
    /// Folder of the data, made at the first start
    #[arg(long, value_name = "DIR", default_value = "vertifleet-data", global = true)]
    pub(crate) data: PathBuf,
    /// PostgreSQL database to keep the data in, in place of the folder
    #[arg(long, value_name = "URL", global = true)]
    pub(crate) database: Option<String>,
    /// Use TLS with the certificate chain in this PEM file, read at the start
    #[arg(long, value_name = "FILE", requires = "key")]
    pub(crate) certificate: Option<PathBuf>,
    /// PEM file with the key of the certificate
    #[arg(long, value_name = "FILE", requires = "certificate")]
    pub(crate) key: Option<PathBuf>,
    /// Allow other addresses without TLS, because a proxy in front of the service provides it
    #[arg(long, conflicts_with = "certificate")]
    pub(crate) behind_proxy: bool,
    /// Send spans of requests to this OpenTelemetry collector, as http://127.0.0.1:4318 [default:
    /// OTEL_EXPORTER_OTLP_ENDPOINT, or none]
    #[arg(long, value_name = "URL")]
    pub(crate) otlp: Option<String>,
    /// Base map of the console: a MapLibre style, whose resources have the same origin, or a
    /// PMTiles file [default: the bundled one]
    #[arg(long, value_name = "URL")]
    pub(crate) basemap: Option<String>,
    /// Show simulated, disturbed days of New York at 60 times their speed, one after the other, and
    /// delete their data at the end
    #[arg(long, conflicts_with_all = ["data", "database", "certificate", "behind_proxy"])]
    pub(crate) demo: bool,
    #[command(subcommand)]
    pub(crate) action: Option<ServeAction>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum ServeAction {
    /// Make, list and revoke tokens
    ///
    /// Once there is a token, every request needs one (Authorization: Bearer vf_...), except those
    /// for the files of the console, /healthz and /readyz.
    #[command(subcommand)]
    Token(TokenAction),
    /// Check and play every event of every day; the exit code is 1 if something is damaged
    Verify,
    /// Copy the data to a new file; the service may be running
    Backup {
        /// New file
        file: PathBuf,
    },
    /// Restore a copy into a folder without data
    Restore {
        /// Copy
        file: PathBuf,
    },
    /// Print all actions except events of days: days, networks, policies and tokens that users
    /// made, changed or deleted
    ///
    /// Each line is a JSON object with at_ms (milliseconds of the Unix clock), actor (the name of
    /// the token), action and target.
    Audit,
    /// Print a day with all its events as JSON
    Export {
        /// Id of the day
        day: String,
    },
}

#[derive(Debug, Subcommand)]
pub(crate) enum TokenAction {
    /// Make a token and print it; it is stored as a hash and cannot be printed again
    Make {
        /// Name of the token, which the audit records as the actor
        #[arg(long, value_parser = parse_token_name)]
        name: String,
        /// Role: read; dispatch, which adds events, decisions and new days; or admin, which adds
        /// networks, policies, and archiving, reopening and deleting days
        #[arg(long, value_parser = parse_role)]
        role: Role,
    },
    /// List the tokens, without their secrets, as JSON
    List,
    /// Revoke a token; the service refuses it after at most two seconds
    Revoke {
        /// Id of the token, the part after vf_
        id: String,
    },
}

#[derive(Debug, Args)]
pub(crate) struct OperateArguments {
    /// Address of the service, for example http://127.0.0.1:8080
    pub(crate) url: String,
    #[arg(long, help = NETWORK, default_value = "paper")]
    pub(crate) network: String,
    /// Seed of the day
    #[arg(long, default_value_t = 1, allow_hyphen_values = true, value_parser = parse_seed)]
    pub(crate) seed: u64,
    /// Policy that decides
    #[arg(long, default_value = "gcaps-x", value_parser = parse_name)]
    pub(crate) policy: String,
    /// Speed: seconds of the day in a second, or max
    #[arg(long, default_value = "max", value_parser = parse_speed)]
    pub(crate) speed: Speed,
    /// Leave the decisions to others, such as people at the console, and wait until every ready
    /// aircraft has one
    #[arg(long)]
    pub(crate) by_hand: bool,
    /// PEM file with certificates to trust, for a service with a self-signed certificate
    #[arg(long, value_name = "FILE")]
    pub(crate) trust: Option<PathBuf>,
    /// Print the day's numbers as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// Parses the name of a token.
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

/// Parses the role of a token.
fn parse_role(text: &str) -> Result<Role, String> {
    let known = Role::ALL.map(Role::name).join(", ");
    Role::named(text).ok_or_else(|| format!("expected one of {known}"))
}
