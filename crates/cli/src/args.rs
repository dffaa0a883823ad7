//! The arguments of the command line.

mod network;
mod planning;
#[cfg(feature = "service")]
mod service;

use std::path::PathBuf;
use std::time::Duration;

use clap::builder::{PathBufValueParser, TypedValueParser as _};
use clap::{Args, Parser, Subcommand, ValueEnum};
use vertifleet_core::Purpose;
use vertifleet_study::PolicySource;

use crate::typed::{
    parse_count, parse_minutes, parse_model, parse_name, parse_pair, parse_seconds, parse_seed,
    parse_seed_of_a_run, parse_share, parse_split, parse_steps, parse_threads,
};

pub(crate) use network::{ImportArguments, NetworkAction, NewArguments};
pub(crate) use planning::{
    ExplainArguments, ExportArguments, ExportFormat, SizeArguments, SweepArguments,
};

#[cfg(feature = "service")]
pub(crate) use service::{OperateArguments, ServeAction, ServeArguments, Speed, TokenAction};

/// Decides where every electric air taxi of an urban fleet flies next.
#[derive(Debug, Parser)]
#[command(name = "vertifleet", version, propagate_version = true)]
pub(crate) struct Arguments {
    /// Threads to use at most [default: RAYON_NUM_THREADS or the number of cores]
    #[arg(long, global = true, allow_hyphen_values = true, value_parser = parse_threads)]
    pub(crate) threads: Option<usize>,
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Make, check and show network files
    #[command(subcommand)]
    Network(NetworkAction),
    /// Draw days of a network as scenario files
    Scenario(ScenarioArguments),
    /// Play a day with one policy
    Simulate(SimulateArguments),
    /// Check a schedule against the rules, independently of the simulator
    Check(CheckArguments),
    /// Break a day's profit down, and price one more stand, aircraft or seat
    Explain(ExplainArguments),
    /// Write a played or planned day in the formats of other programs
    Export(ExportArguments),
    /// Prove how much a known day can earn at most
    Bound(BoundArguments),
    /// Find the best schedule for a known day, and say how far from the best it may be
    Plan(PlanArguments),
    /// Train a policy on days of a network
    Train(TrainArguments),
    /// Play many days with many policies and report who earns what
    Compare(CompareArguments),
    /// Play the same days under many settings of a network: what is a change worth?
    Sweep(SweepArguments),
    /// Find how many aircraft, stands and chargers a network should have
    Size(SizeArguments),
    /// Measure policies on frozen suites of days or on random networks, and verify results
    Evaluate(EvaluateArguments),
    /// Run the dispatch service: live days over HTTP
    #[cfg(feature = "service")]
    Serve(ServeArguments),
    /// Operate a day through a dispatch service, as an operator would
    #[cfg(feature = "service")]
    Operate(OperateArguments),
    /// Not in this build, which was made for `make demo`
    #[cfg(not(feature = "service"))]
    #[command(hide = true, alias = "operate")]
    Serve {
        /// Whatever the service would take
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        _ignored: Vec<String>,
    },
}

#[derive(Debug, Args)]
pub(crate) struct ScenarioArguments {
    /// Network file, the name of a shipped network (paper, disrupted, new-york, large, as-coded,
    /// san-francisco, los-angeles, dallas, paris), random:NUMBER, or random-places:SIZE:NUMBER
    pub(crate) network: String,
    /// Seed of the first day; the following days take the following seeds
    #[arg(long, allow_hyphen_values = true, value_parser = parse_seed)]
    pub(crate) seed: u64,
    /// Number of days
    #[arg(long, allow_hyphen_values = true, value_parser = parse_count)]
    pub(crate) days: Option<u32>,
    /// File for one day, folder for several (with --days) [default: the day goes to stdout]
    #[arg(short, long, value_name = "FILE|DIR")]
    pub(crate) output: Option<PathBuf>,
    /// Replace a file that this program did not write or that is read-only; never what the command
    /// reads
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct SimulateArguments {
    /// Scenario file
    pub(crate) scenario: PathBuf,
    /// random, greedy, prices, rolling, gcaps, mlp, gcaps-x, gcaps-x:rollouts=K, gcaps-full,
    /// mlp-full, or replay:TRACE
    #[arg(long, value_parser = parse_name)]
    pub(crate) policy: String,
    /// Seed of the random policy
    #[arg(long, default_value_t = 0, allow_hyphen_values = true, value_parser = parse_seed)]
    pub(crate) seed: u64,
    /// Weights of a learned policy [default: the shipped ones of the scenario's network]
    #[arg(long, value_name = "PATH", value_parser = PathBufValueParser::new().map(PolicySource::File))]
    pub(crate) model: Option<PolicySource>,
    /// Write every decision to this CSV file
    #[arg(long, value_name = "FILE")]
    pub(crate) trace: Option<PathBuf>,
    /// Write a page with ledger, map, aircraft, stands, demand and replay of the day to this HTML
    /// file
    #[arg(long, value_name = "FILE")]
    pub(crate) report: Option<PathBuf>,
    /// Replace a file that this program did not write or that is read-only; never what the command
    /// reads
    #[arg(long)]
    pub(crate) force: bool,
    /// Print the day's numbers as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CheckArguments {
    /// Scenario file
    pub(crate) scenario: PathBuf,
    /// Trace of the whole day, as simulate --trace writes it
    pub(crate) trace: PathBuf,
    /// Print the findings as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct BoundArguments {
    /// Scenario file; several of them, or a folder with them (all *.json), give means over days too
    #[arg(required = true, value_name = "SCENARIO|DIR")]
    pub(crate) scenarios: Vec<PathBuf>,
    /// Longest price interval, minutes, 1 to 60; slices have 60, 15, 5, 3 or 1 minutes. Fewer never
    /// give a looser bound, and take longer
    #[arg(long, value_name = "MIN", default_value_t = 5, allow_hyphen_values = true, value_parser = parse_minutes)]
    pub(crate) step: u32,
    /// Bound also what can be earned on the mean without knowing take-off delays, on days drawn
    /// from this network
    #[arg(long, value_name = "NETWORK")]
    pub(crate) without_foresight: Option<String>,
    /// Print bounds and shadow prices as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct PlanArguments {
    /// Scenario file
    pub(crate) scenario: PathBuf,
    /// Write the schedule, every decision of the day, to this CSV file
    #[arg(short, long, value_name = "TRACE")]
    pub(crate) output: PathBuf,
    /// Seconds that it takes at most, start and proof included; 0 gives the day of greedy
    #[arg(long, value_name = "S", default_value = "60", allow_hyphen_values = true, value_parser = parse_seconds)]
    pub(crate) time_limit: Duration,
    /// Stop as soon as the gap to the certified bound is no more than this share of the bound, as
    /// 0.03
    #[arg(long, value_name = "G", allow_hyphen_values = true, value_parser = parse_share)]
    pub(crate) gap: Option<f64>,
    /// Seed of the search
    #[arg(long, default_value_t = 0, allow_hyphen_values = true, value_parser = parse_seed)]
    pub(crate) seed: u64,
    /// Replace a file that this program did not write or that is read-only; never what the command
    /// reads
    #[arg(long)]
    pub(crate) force: bool,
    /// Print the plan's numbers as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// The kinds of policy that can be trained.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Trainable {
    /// Graph capsules and attention (§IV)
    Gcaps,
    /// The paper's baseline: plain layers
    Mlp,
    /// One network for networks of any size, beside the day's prices
    GcapsX,
    /// One network for networks of any size, with the forecast and the fleet and without prices
    GcapsFull,
    /// The same observation flattened, for networks of one size
    MlpFull,
}

impl Trainable {
    /// The name of the policy.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Gcaps => "gcaps",
            Self::Mlp => "mlp",
            Self::GcapsX => "gcaps-x",
            Self::GcapsFull => "gcaps-full",
            Self::MlpFull => "mlp-full",
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct TrainArguments {
    /// Network file, the name of a shipped network (paper, disrupted, new-york, large, as-coded,
    /// san-francisco, los-angeles, dallas, paris), random:NUMBER, or random-places:SIZE:NUMBER;
    /// random or random-places:SIZE for a new network each day
    #[arg(long)]
    pub(crate) network: String,
    /// Kind of policy
    #[arg(long)]
    pub(crate) policy: Trainable,
    /// Settings to start from: default, or evolution; for gcaps and mlp also paper (Table 2) or
    /// imitation
    #[arg(long, default_value = "default")]
    pub(crate) preset: String,
    /// Decisions to learn from, in place of the preset's
    #[arg(long, allow_hyphen_values = true, value_parser = parse_steps)]
    pub(crate) steps: Option<u64>,
    /// Seed of the run: first weights, training days and choices follow from it
    #[arg(long, default_value_t = 1, allow_hyphen_values = true, value_parser = parse_seed_of_a_run)]
    pub(crate) seed: u32,
    /// Weights to begin with, of the same kind of policy, in place of fresh ones; sizes are those
    /// of the weights
    #[arg(long, value_name = "FILE")]
    pub(crate) begin_with: Option<PathBuf>,
    /// Folder for weights, learning curve and checkpoint
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Go on from the checkpoint in the folder
    #[arg(long)]
    pub(crate) resume: bool,
    /// Replace a file that this program did not write or that is read-only; never what the command
    /// reads
    #[arg(long)]
    pub(crate) force: bool,
    /// Change one setting; may be given several times
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = parse_pair)]
    pub(crate) set: Vec<(String, String)>,
}

#[derive(Debug, Args)]
pub(crate) struct CompareArguments {
    /// Network file, the name of a shipped network (paper, disrupted, new-york, large, as-coded,
    /// san-francisco, los-angeles, dallas, paris), random:NUMBER, or random-places:SIZE:NUMBER
    #[arg(long, required_unless_present = "days_from")]
    pub(crate) network: Option<String>,
    /// Days of your own in place of drawn ones: scenario files, or a folder with them (all *.json,
    /// in the order of their names)
    #[arg(long, value_name = "DIR|FILE", num_args = 1.., conflicts_with_all = ["network", "days", "seed", "split"])]
    pub(crate) days_from: Vec<PathBuf>,
    /// Policies, separated by commas: random, greedy, prices, rolling, gcaps, mlp, gcaps-x,
    /// gcaps-x:rollouts=K (which rolls its K best choices out), names given by --model, and plan,
    /// the planner, which knows the days beforehand
    #[arg(long, value_delimiter = ',', required = true, value_parser = parse_name)]
    pub(crate) policies: Vec<String>,
    /// Number of days
    #[arg(long, required_unless_present = "days_from", allow_hyphen_values = true, value_parser = parse_count)]
    pub(crate) days: Option<u32>,
    /// Seed of the first day, and of the random policy [default: 1, and 0 with --days-from]
    #[arg(long, allow_hyphen_values = true, value_parser = parse_seed)]
    pub(crate) seed: Option<u64>,
    /// Whose days: comparison, for results; validation, to choose settings and weights; or
    /// training. With the latter two, the seed is the number of the first day
    #[arg(long, default_value = "comparison", value_parser = parse_split)]
    pub(crate) split: Purpose,
    /// Weights for a policy name; may be given several times
    #[arg(long = "model", value_name = "NAME=PATH", value_parser = parse_model)]
    pub(crate) models: Vec<(String, PolicySource)>,
    /// Prove an upper bound of every day and show each policy's share of it
    #[arg(long)]
    pub(crate) bound: bool,
    /// Longest price interval of the bound, minutes, 1 to 60; shorter is never looser and takes
    /// longer
    #[arg(long, value_name = "MIN", default_value_t = 5, requires = "bound", allow_hyphen_values = true, value_parser = parse_minutes)]
    pub(crate) step: u32,
    #[command(flatten)]
    pub(crate) presented: PresentedArguments,
}

#[derive(Debug, Args)]
pub(crate) struct EvaluateArguments {
    /// Suites, separated by commas: paper-100, disrupted-100, new-york-100, cities-100, random-50,
    /// random-places-100, large, or all; random:N is a day of each of N random networks, whose
    /// bounds are proven first
    #[arg(long, value_name = "NAME", value_delimiter = ',', default_value = "paper-100", value_parser = parse_name)]
    pub(crate) suite: Vec<String>,
    /// Policies, separated by commas, as compare takes them; the others are measured against the
    /// first
    #[arg(long, value_delimiter = ',', required_unless_present = "verify", value_parser = parse_name)]
    pub(crate) policies: Vec<String>,
    /// Weights for a policy name; may be given several times
    #[arg(long = "model", value_name = "NAME=PATH", value_parser = parse_model)]
    pub(crate) models: Vec<(String, PolicySource)>,
    /// Write a result file for each suite and policy into this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) results: Option<PathBuf>,
    /// What to say about the policies in the result files, as training=NONE; may be given several
    /// times
    #[arg(long, value_name = "NAME=TEXT", requires = "results", value_parser = parse_pair)]
    pub(crate) about: Vec<(String, String)>,
    /// Verify result files: play their choices, and compute everything that they claim again
    #[arg(long, value_name = "RESULT", num_args = 1.., conflicts_with_all = ["suite", "policies", "models", "results", "about", "force"])]
    pub(crate) verify: Vec<PathBuf>,
    /// Print the results as JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Replace a file that this program did not write or that is read-only; never what the command
    /// reads
    #[arg(long)]
    pub(crate) force: bool,
}

/// How a study is shown.
#[derive(Debug, Args)]
pub(crate) struct PresentedArguments {
    /// Print the results as JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Write table, figures and a report page into this folder, in place of an earlier report
    #[arg(long, value_name = "DIR")]
    pub(crate) report: Option<PathBuf>,
    /// Replace a read-only report, and move any other folder of that name to DIR.old; never what
    /// the command reads
    #[arg(long)]
    pub(crate) force: bool,
}
