//! Errors between the records and the written report, with stable codes (V4xx).

use std::path::PathBuf;

use vertifleet_core::{Code, Coded, Exit};
use vertifleet_policy::{PlayError, PolicyError};

/// An expected error of this crate. Messages are fragments for people; [`Error::code`] is for
/// programs and for the error index.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file that cannot be written (V102); the error is one of `vertifleet-core`.
    #[error(transparent)]
    Core(#[from] vertifleet_core::Error),

    /// Weights that do not fit or do not load (V3xx); the error is one of `vertifleet-learn`.
    #[error(transparent)]
    Learn(#[from] vertifleet_learn::Error),

    /// A day that is too large for a bound, or cannot be planned (V5xx); the error is one of
    /// `vertifleet-optimize`.
    #[error(transparent)]
    Optimize(#[from] vertifleet_optimize::Error),

    /// A trace that cannot be replayed (V2xx); the error is one of `vertifleet-sim`.
    #[error(transparent)]
    Trace(#[from] vertifleet_sim::TraceError),

    /// V401 report folder cannot be made. The folder of the report cannot be made: missing rights,
    /// or a file where the folder should be.
    ///
    /// Fix: name another folder.
    #[error("{}: cannot make the folder of the report: {cause}", path.display())]
    CannotMakeFolder {
        /// The path of the folder.
        path: PathBuf,
        /// The error of the operating system.
        cause: std::io::Error,
    },

    /// V402 nothing to compare. A comparison has no policy or no day.
    ///
    /// Fix: name at least one policy and one day.
    #[error("nothing to compare: {policies} policies on {days} days")]
    Empty {
        /// Number of policies.
        policies: usize,
        /// Number of days.
        days: usize,
    },
    /// V403 policies on different days. Two policies did not meet the same days in the same order,
    /// so their results cannot be paired: records of different runs were mixed. The program itself
    /// never does this.
    ///
    /// Fix: run all policies in one comparison.
    #[error(
        "policy {policy:?}, day {position}: found {found}, but {first_policy:?} has {expected}"
    )]
    Unpaired {
        /// The policy whose days differ.
        policy: String,
        /// The policy that its days were compared with.
        first_policy: String,
        /// Position of the first day that differs.
        position: usize,
        /// The day found there.
        found: String,
        /// The day expected there.
        expected: String,
    },
    /// V404 policy named twice. Two policies of one comparison have the same name.
    ///
    /// Fix: name each policy once. Give a second model of the same kind another name: `--policies
    /// gcaps,mine --model mine=PATH`.
    #[error("policy {name:?} is named twice")]
    DuplicatePolicy {
        /// The name that two policies have.
        name: String,
    },
    /// V405 result that is no number. A result is not a finite number, because a scenario has
    /// values far beyond those of any real day.
    ///
    /// Fix: check the scenario. If its values are plausible, report the day as a defect.
    #[error("policy {policy:?}, day {day:?}: {member} must be a finite number, found {value}")]
    NotFinite {
        /// The name of the policy.
        policy: String,
        /// The name of the day.
        day: String,
        /// The name of the result.
        member: &'static str,
        /// The value that was found.
        value: f64,
    },

    /// V406 policy cannot play the day. A policy could not play a day to its end. With `replay`,
    /// the trace is of another scenario, or it stops before the day does. Any other policy made a
    /// choice that is not feasible.
    ///
    /// Fix: replay a trace with the scenario that it was made from. If the policy is a function of
    /// your own, let it choose a vertiport where `action_mask` is 1. Report any other policy as a
    /// defect.
    #[error("policy {policy:?} cannot play {day}: {cause}")]
    Stuck {
        /// The name of the policy.
        policy: String,
        /// The name of the day.
        day: String,
        /// Why the policy could not continue.
        cause: PlayError,
    },

    /// V407 policies and models that do not go together. A model is given for a policy that takes
    /// none, for one that does not take part, twice for one name, or of another kind than its name
    /// says; or the name of a policy is not understood. The message and the hint say which of these
    /// it is.
    ///
    /// Fix: follow the hint.
    #[error("{rule}")]
    Asked {
        /// The rule that is broken.
        rule: String,
        /// How to fix it.
        hint: &'static str,
    },

    /// The study was stopped before it was done. Nothing was written.
    #[error("stopped before all days were played")]
    Stopped,

    /// V409 parts of different studies. Parts of a comparison that were played separately belong to
    /// different networks or policies, or days are missing between them.
    ///
    /// Fix: join all parts of one comparison, in the order of their days.
    #[error("the parts do not go together: {rule}")]
    PartsDiffer {
        /// The rule that is broken.
        rule: String,
    },

    /// V410 days that do not go together. Days from files cannot be compared (`compare
    /// --days-from`), because there are no days, they have different vertiports, or two of them
    /// have the same `name`.
    ///
    /// Fix: compare days of one network: the same vertiports in the same order, and a different
    /// name for each day.
    #[error("the days do not go together: {rule}")]
    DaysDiffer {
        /// The rule that is broken.
        rule: String,
    },

    /// V411 no such suite. `evaluate` was asked for a suite of a name that no suite has, or a
    /// result file names one.
    ///
    /// Fix: give one of the names that the message lists.
    #[error("there is no suite {name:?}: known are {known}")]
    UnknownSuite {
        /// The name that was asked for.
        name: String,
        /// The known names.
        known: String,
        /// The name that was probably intended, if there is a similar one, as a question.
        meant: Option<String>,
    },

    /// V412 a suite that is no longer what was frozen. A day of a suite is drawn otherwise than it
    /// was when the suite was frozen, so results would not compare with those of others. This build
    /// has another network of that name, or another way of drawing days.
    ///
    /// Fix: use a release. In a changed build of your own, freeze the suites again with `make
    /// suites`, and do not publish results under their names.
    #[error("suite {suite:?} is no longer what was frozen: {day}")]
    SuiteChanged {
        /// The name of the suite.
        suite: String,
        /// What differs.
        day: String,
    },

    /// V413 not a result. `evaluate --verify` was given a file that is not a result of an
    /// evaluation, or one that was damaged.
    ///
    /// Fix: name a file that `vertifleet evaluate --results` or `Evaluation.save` wrote.
    #[error("{origin}: not a result of an evaluation: {rule}")]
    NotAResult {
        /// The path of the file.
        origin: String,
        /// What is wrong with it.
        rule: String,
    },

    /// V414 folder of another study. The folder of `--out` holds a sweep, or a search for a design,
    /// with other settings, days, policies or weights, or one of another version of the program; or
    /// the `journal` of a sweep in Python does. Its results would not go together with those of
    /// this study.
    ///
    /// Fix: name another folder or file, or replace that study: with `--force`, or, in Python, by
    /// removing the journal.
    #[error("{}: belongs to another study", path.display())]
    OtherStudy {
        /// The journal of the other study.
        path: PathBuf,
    },

    /// V415 result that does not verify. `board` shows verified results only, and a claim of this
    /// file does not hold: it was changed, or its bounds are of another version.
    ///
    /// Fix: `vertifleet evaluate --verify FILE` lists everything that does not hold. Leave the file
    /// out, or evaluate the policy again.
    #[error("{origin}: {verdict}")]
    NotVerified {
        /// The path of the file.
        origin: String,
        /// What does not hold.
        verdict: String,
    },

    /// V416 results that do not go together. `board` was given two results of one training run,
    /// runs of one method that see different things, or no result at all.
    ///
    /// Fix: give each run once. Name runs where files do not: `evaluate --method POLICY=METHOD`,
    /// with weights that have a seed, or `Evaluation.save(runs=...)` in Python.
    #[error("the results do not go together: {rule}")]
    ResultsDiffer {
        /// The rule that is broken.
        rule: String,
    },

    /// No policy has this name. Cause: a typing error. Fix: give one of the names that the
    /// message lists.
    #[error("there is no policy {name:?}: known are {known}")]
    UnknownPolicy {
        /// The name that was asked for.
        name: String,
        /// The known names.
        known: String,
        /// The name that was probably intended, if there is a similar one, as a question.
        meant: Option<String>,
    },
}

impl Error {
    /// The error for a policy that could not play a day to its end or was stopped.
    pub fn of_play(policy: &str, day: &str, cause: PlayError) -> Self {
        match cause {
            PlayError::NoAnswer(PolicyError::Stopped) => Self::Stopped,
            cause => Self::Stuck { policy: policy.to_owned(), day: day.to_owned(), cause },
        }
    }

    /// Whether a policy cannot play some days although nothing is wrong with it: its weights belong
    /// to another network.
    pub(crate) fn is_misfit(&self) -> bool {
        use vertifleet_learn::Error as Learn;
        matches!(self, Self::Learn(Learn::NotShipped { .. } | Learn::WrongNetwork { .. }))
    }
}

impl Coded for Error {
    fn code(&self) -> Code {
        Code(match self {
            Self::Core(error) => return error.code(),
            Self::Learn(error) => return error.code(),
            Self::Optimize(error) => return error.code(),
            Self::Trace(error) => return error.code(),
            Self::CannotMakeFolder { .. } => 401,
            Self::Empty { .. } => 402,
            Self::Unpaired { .. } => 403,
            Self::DuplicatePolicy { .. } => 404,
            Self::NotFinite { .. } => 405,
            Self::Stuck { .. } => 406,
            Self::Asked { .. } => 407,
            Self::Stopped => 408,
            Self::PartsDiffer { .. } => 409,
            Self::DaysDiffer { .. } => 410,
            Self::UnknownSuite { .. } => 411,
            Self::SuiteChanged { .. } => 412,
            Self::NotAResult { .. } => 413,
            Self::OtherStudy { .. } => 414,
            Self::NotVerified { .. } => 415,
            Self::ResultsDiffer { .. } => 416,
            Self::UnknownPolicy { .. } => 307,
        })
    }

    fn hint(&self) -> Option<&str> {
        match self {
            Self::Core(error) => error.hint(),
            Self::Learn(error) => error.hint(),
            Self::Optimize(error) => error.hint(),
            Self::Trace(error) => error.hint(),
            Self::CannotMakeFolder { .. } => {
                Some("name a folder that is yours, or one that is not there yet")
            }
            Self::Empty { .. } => Some("a comparison takes at least one policy and one day"),
            Self::DuplicatePolicy { .. } => {
                Some("give a second model of the same kind a different name")
            }
            Self::Unpaired { .. } => Some("run all policies in one comparison"),
            Self::Stuck { .. } => Some(
                "a replay needs the trace of the very day that is played; any other policy must choose what is feasible",
            ),
            Self::Asked { hint, .. } => Some(hint),
            Self::PartsDiffer { .. } => {
                Some("join all parts of one comparison, in the order of their days")
            }
            Self::DaysDiffer { .. } => Some(
                "days of one comparison have the same vertiports, and each has a different name",
            ),
            Self::UnknownPolicy { meant, .. } => Some(
                meant.as_deref().unwrap_or("for weights of your own, give a model under this name"),
            ),
            Self::UnknownSuite { meant, .. } => meant.as_deref(),
            Self::SuiteChanged { .. } => {
                Some("use a release, or freeze the suites of this build with `make suites`")
            }
            Self::NotAResult { .. } => {
                Some("results are written by `vertifleet evaluate --results`")
            }
            Self::NotVerified { .. } => {
                Some("leave the file out, or evaluate the policy again with this version")
            }
            Self::ResultsDiffer { .. } => Some(
                "a method has one result for each training run; evaluate --method names the method of a run",
            ),
            Self::OtherStudy { .. } => Some("name another one, or replace that study with --force"),
            Self::NotFinite { .. } | Self::Stopped => None,
        }
    }

    fn exit(&self) -> Exit {
        match self {
            Self::Core(error) => error.exit(),
            Self::Learn(error) => error.exit(),
            Self::Optimize(error) => error.exit(),
            Self::Trace(error) => error.exit(),
            Self::CannotMakeFolder { .. }
            | Self::NotFinite { .. }
            | Self::NotVerified { .. }
            | Self::Stopped => Exit::Failed,
            _ => Exit::Input,
        }
    }
}
