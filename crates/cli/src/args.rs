//! The arguments of the command line.

mod network;
#[cfg(test)]
mod page;
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

/// The help of arguments that several commands take.
const NETWORK: &str = "Network file, the name of a shipped network (paper, paper-quick, disrupted, new-york, new-york-quick, large, as-coded, san-francisco, los-angeles, dallas, paris), random:NUMBER, random-training:NUMBER, random-validation:NUMBER, or random-places:SIZE:NUMBER";
const FORCE: &str =
    "Replace a file that this program did not write or that is read-only; never an input file";
const STEP: &str = "Longest price interval of the bound, minutes, 1 to 60; a shorter one never loosens the bound, and takes longer";
const SPLIT: &str = "Range of days: comparison, for results; validation, to choose settings and weights; or training. With the latter two, the seed is the number of the first day";

/// Decides where every electric air taxi of an urban fleet flies next.
#[derive(Debug, Parser)]
#[command(name = "vertifleet", version, propagate_version = true)]
pub(crate) struct Arguments {
    /// Largest number of threads; results do not depend on it, except those of plan, which makes a
    /// search in each thread [default: RAYON_NUM_THREADS or the number of cores]
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
    ///
    /// Takes schedules of any origin, in the form of a trace. Judges each row by what the row
    /// before it states, so that one mistake is one finding. The exit code is 1 if a rule is
    /// broken.
    Check(CheckArguments),
    /// Break a day's profit down, and price one more stand, aircraft or seat
    ///
    /// Plays a day, proves its upper bound, and prints the ledger, the demand carried and spilled,
    /// how full each vertiport was, and what each aircraft did. Then solves changed days, with the
    /// policy and with the bound: one more stand at each of the eight vertiports with the highest
    /// shadow prices, one more aircraft of each type, one more seat in each type, and take-offs a
    /// minute shorter. Where days charge as needed, also 10 kWh more in every battery of a type,
    /// and 1 kW more at every charger; all bounds then have at most 16 levels of charge.
    Explain(ExplainArguments),
    /// Write a played or planned day in the formats of other programs
    ///
    /// geojson and gtfs need vertiports with latitude and longitude.
    Export(ExportArguments),
    /// Prove an upper bound on the profit of a known day
    ///
    /// Bounds several days in parallel, a thread for each, and prints their means. These days must
    /// have the same vertiports.
    Bound(BoundArguments),
    /// Find a good schedule for a known day, and bound its distance from the best
    ///
    /// The schedule earns no less than any shipped policy whose day could be played in time. Ctrl-C
    /// ends the search and writes the best schedule found; a second Ctrl-C ends the program at
    /// once. Two runs with the same time limit may differ.
    Plan(PlanArguments),
    /// Train a policy on days of a network
    ///
    /// Writes weights, learning curve, checkpoint and a TensorBoard log. Ctrl-C abandons the update
    /// under way, writes the run as it stood before, and ends with exit code 0; a second Ctrl-C
    /// ends the program at once. A folder with the checkpoint of an earlier run of the same policy
    /// is refused without --resume.
    Train(TrainArguments),
    /// Play many days with many policies, and compare their profits
    ///
    /// Prints the policies by mean profit, and a paired t-test for each pair. Time per decision is
    /// measured one decision at a time, and is the only number that differs between two runs.
    ///
    /// Keeps bounds in $XDG_CACHE_HOME/vertifleet, or ~/.cache/vertifleet, which can be removed at
    /// any time. Ctrl-C keeps the bounds that were proven, and writes no report.
    Compare(CompareArguments),
    /// Play the same days under many settings of a network
    ///
    /// Each combination of values is a cell: the network with these members changed. All cells have
    /// the same days. Demand, delays and closures have the same random numbers wherever a change
    /// allows it, and aircraft start where they start on the unchanged network. So differences
    /// between cells are far less noisy than profits. Where a network has an elasticity, its demand
    /// is that at its own fares, whatever a cell changes.
    ///
    /// The report names the design that earns most, and the cheapest that earns at most 1 % less. A
    /// cell with more aircraft than stands is left out. An interrupted sweep goes on with the
    /// missing cells when the same command is given again, and ends with the same bytes.
    Sweep(SweepArguments),
    /// Find how many aircraft, stands and chargers a network should have
    ///
    /// Bounds all designs first, then plays the most promising ones on the same days. Prints the
    /// best design, its results on further days that the search has not used, and a certificate: a
    /// bound on how much more the best schedule of any design could earn. "One more adds at most"
    /// is the shadow price after costs. best.toml is the network file of the design, with all
    /// comments. An interrupted search goes on when the same command is given again, and ends with
    /// the same bytes.
    Size(SizeArguments),
    /// Measure policies on frozen suites of days or on random networks, and verify results
    ///
    /// Prints for each policy the mean share of the suite's certified bounds with its 95 %
    /// interval, the lowest share, the mean profit, the difference from the first policy in
    /// percentage points of the bound with the p-value of the paired t-test (Holm), and the time of
    /// one decision. A policy that cannot play a suite is left out of it. The random policy and the
    /// search of plan have seed 1.
    Evaluate(EvaluateArguments),
    /// Rank the methods of result files, with training runs as the unit
    ///
    /// Verifies every file first, and ends with exit code 1 if a claim does not hold. Each file is
    /// a run of a method on a suite; runs of one method differ in their seeds alone. Prints a table
    /// for each suite, sorted by what methods see, then by share: the mean share of the certified
    /// bound and the interquartile mean, with intervals over runs and days. The report adds
    /// performance profiles, and board.md, the same page in Markdown.
    Board(BoardArguments),
    /// Run the dispatch service: live days over HTTP, with a console at /
    ///
    /// Ctrl-C ends it after the requests that it is carrying out.
    #[cfg(feature = "service")]
    Serve(ServeArguments),
    /// Operate a day through a dispatch service, as an operator would
    ///
    /// Makes a day, reports events when they become known, and requests a decision whenever an
    /// aircraft is ready. The profit is that of simulate, to the cent. Where the network has a time
    /// zone, the day is today there. Sends requests again for half a minute if the service does not
    /// answer. Takes the token from the variable VERTIFLEET_TOKEN.
    #[cfg(feature = "service")]
    Operate(OperateArguments),
    /// Not in this build, which was made for make demo
    #[cfg(not(feature = "service"))]
    #[command(hide = true, alias = "operate")]
    Serve {
        /// All arguments, which this build ignores
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        _ignored: Vec<String>,
    },
}

#[derive(Debug, Args)]
pub(crate) struct ScenarioArguments {
    #[arg(help = NETWORK)]
    pub(crate) network: String,
    /// Seed of the first day, below 2^40; the following days take the following seeds
    #[arg(long, allow_hyphen_values = true, value_parser = parse_seed)]
    pub(crate) seed: u64,
    /// Number of days, 1 to 1000000, each written to the file NAME-SEED.json
    #[arg(long, allow_hyphen_values = true, value_parser = parse_count)]
    pub(crate) days: Option<u32>,
    /// File for one day, folder for several [default: stdout, and the current folder with --days]
    #[arg(short, long, value_name = "FILE|DIR")]
    pub(crate) output: Option<PathBuf>,
    #[arg(long, help = FORCE)]
    pub(crate) force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct SimulateArguments {
    /// Scenario file
    pub(crate) scenario: PathBuf,
    /// Policy: random, greedy, prices, rolling, gcaps, mlp, gcaps-x, gcaps-x:rollouts=K,
    /// gcaps-full, mlp-full, or replay:TRACE
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
    #[arg(long, help = FORCE)]
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
    /// Scenario files, or a folder with them (all *.json)
    #[arg(required = true, value_name = "SCENARIO|DIR")]
    pub(crate) scenarios: Vec<PathBuf>,
    #[arg(long, help = STEP, value_name = "MIN", default_value_t = 5, allow_hyphen_values = true, value_parser = parse_minutes)]
    pub(crate) step: u32,
    /// Levels of charge on days that charge as needed, 4 to 64; fewer take less time and give a
    /// higher bound
    #[arg(long, value_name = "N", default_value_t = 64)]
    pub(crate) levels: u16,
    /// Also bound the mean profit without knowledge of take-off delays, on days drawn from this
    /// network
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
    /// Time limit, seconds, for policies, search and proof; 0 gives the day of greedy
    #[arg(long, value_name = "S", default_value = "60", allow_hyphen_values = true, value_parser = parse_seconds)]
    pub(crate) time_limit: Duration,
    /// Stop when the gap is at most this share of the certified bound, as 0.03
    #[arg(long, value_name = "G", allow_hyphen_values = true, value_parser = parse_share)]
    pub(crate) gap: Option<f64>,
    /// Seed of the search
    #[arg(long, default_value_t = 0, allow_hyphen_values = true, value_parser = parse_seed)]
    pub(crate) seed: u64,
    #[arg(long, help = FORCE)]
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
    /// For networks of any size, with the day's prices
    GcapsX,
    /// For networks of any size, with forecast and fleet, without prices
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
    /// Network, as scenario takes it; random or random-places:SIZE draws a new network each day
    #[arg(long)]
    pub(crate) network: String,
    /// Policy to train
    #[arg(long)]
    pub(crate) policy: Trainable,
    /// Settings to start from: default, or evolution; for gcaps and mlp also paper (Table 2) or
    /// imitation
    #[arg(long, default_value = "default")]
    pub(crate) preset: String,
    /// Decisions to learn from, for PPO only [default: the preset's]
    #[arg(long, allow_hyphen_values = true, value_parser = parse_steps)]
    pub(crate) steps: Option<u64>,
    /// Seed of the run, below 2^24: first weights, training days and choices follow from it
    #[arg(long, default_value_t = 1, allow_hyphen_values = true, value_parser = parse_seed_of_a_run)]
    pub(crate) seed: u32,
    /// Weights to begin with, of the same policy, whose sizes they set [default: fresh ones]
    #[arg(long, value_name = "FILE")]
    pub(crate) begin_with: Option<PathBuf>,
    /// Folder for weights, learning curve and checkpoint
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Continue from the checkpoint in the folder, with the same arguments
    #[arg(long)]
    pub(crate) resume: bool,
    #[arg(long, help = FORCE)]
    pub(crate) force: bool,
    /// Change one setting, a size of the policy or its graph; may be given several times
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = parse_pair)]
    pub(crate) set: Vec<(String, String)>,
}

#[derive(Debug, Args)]
pub(crate) struct CompareArguments {
    #[arg(long, required_unless_present = "days_from", help = NETWORK)]
    pub(crate) network: Option<String>,
    /// Play these days in place of drawn ones: scenario files, or a folder with them (all *.json,
    /// in the order of their names)
    ///
    /// All days must have the same vertiports in the same order, and different names. Fleets,
    /// demand, tariffs, times and disturbances may differ. The name chooses the shipped weights, as
    /// paper-7 those of paper. Results have no published figures and no learning curves.
    #[arg(long, value_name = "DIR|FILE", num_args = 1.., conflicts_with_all = ["network", "days", "seed", "split"])]
    pub(crate) days_from: Vec<PathBuf>,
    /// Policies, separated by commas: random, greedy, prices, rolling, gcaps, mlp, gcaps-x,
    /// gcaps-x:rollouts=K (which rolls its K best choices out), gcaps-full, names given by --model,
    /// and plan, the planner, which knows the days in advance
    #[arg(long, value_delimiter = ',', required = true, value_parser = parse_name)]
    pub(crate) policies: Vec<String>,
    /// Number of days, 1 to 1000000
    #[arg(long, required_unless_present = "days_from", allow_hyphen_values = true, value_parser = parse_count)]
    pub(crate) days: Option<u32>,
    /// Seed of the first day, below 2^40, and of the random policy [default: 1, and 0 with
    /// --days-from]
    #[arg(long, allow_hyphen_values = true, value_parser = parse_seed)]
    pub(crate) seed: Option<u64>,
    #[arg(long, help = SPLIT, default_value = "comparison", value_parser = parse_split)]
    pub(crate) split: Purpose,
    /// Weights for a policy of that name; may be given several times
    #[arg(long = "model", value_name = "NAME=PATH", value_parser = parse_model)]
    pub(crate) models: Vec<(String, PolicySource)>,
    /// Prove an upper bound on every day, and print each policy's share of it
    #[arg(long)]
    pub(crate) bound: bool,
    #[arg(long, help = STEP, value_name = "MIN", default_value_t = 5, requires = "bound", allow_hyphen_values = true, value_parser = parse_minutes)]
    pub(crate) step: u32,
    #[command(flatten)]
    pub(crate) presented: PresentedArguments,
}

#[derive(Debug, Args)]
pub(crate) struct EvaluateArguments {
    /// Suites, separated by commas: paper-100, disrupted-100, new-york-100, paper-quick-20,
    /// new-york-quick-20, cities-100, random-50, random-places-100, large, or all; random:N is a
    /// day of each of the networks random:0 to random:N-1, which no training draws and whose bounds
    /// are proven first
    #[arg(long, value_name = "NAME", value_delimiter = ',', default_value = "paper-100", value_parser = parse_name)]
    pub(crate) suite: Vec<String>,
    /// Policies, separated by commas, as compare takes them; the others are measured against the
    /// first
    #[arg(long, value_delimiter = ',', required_unless_present = "verify", value_parser = parse_name)]
    pub(crate) policies: Vec<String>,
    /// Weights for a policy of that name; may be given several times
    #[arg(long = "model", value_name = "NAME=PATH", value_parser = parse_model)]
    pub(crate) models: Vec<(String, PolicySource)>,
    /// Write a result file for each suite and policy into this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) results: Option<PathBuf>,
    /// Note in the result files, as training=NONE; may be given several times
    #[arg(long, value_name = "NAME=TEXT", requires = "results", value_parser = parse_pair)]
    pub(crate) about: Vec<(String, String)>,
    /// Method that a policy is a training run of, for board, as mine-2=mine; may be given several
    /// times. The seed of the run is that of the weights [default: the name of the policy]
    #[arg(long = "method", value_name = "POLICY=METHOD", requires = "results", value_parser = parse_pair)]
    pub(crate) methods: Vec<(String, String)>,
    /// Verify result files: play their choices again, and recompute every claim; the exit code is 1
    /// if one does not hold
    #[arg(long, value_name = "RESULT", num_args = 1.., conflicts_with_all = ["suite", "policies", "models", "results", "about", "methods", "force"])]
    pub(crate) verify: Vec<PathBuf>,
    /// Print the results as JSON
    #[arg(long)]
    pub(crate) json: bool,
    #[arg(long, help = FORCE)]
    pub(crate) force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct BoardArguments {
    /// Result files of evaluate --results, or a folder with them (all *.json)
    #[arg(required = true, value_name = "RESULT|DIR")]
    pub(crate) results: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) presented: PresentedArguments,
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
    /// Replace a read-only report, and move any other folder of that name to DIR.old; never an
    /// input file
    #[arg(long)]
    pub(crate) force: bool,
}
