//! Studies: comparisons of policies on many days of a network, which run in the background while
//! days are dispatched.
//!
//! One study runs at a time, on at most half of the cores and with the lowest priority, so that
//! decisions stay quick. Studies live in memory: the result of a study follows from its request, so
//! it can be computed again after the service has stopped.

mod asked;
mod progress;
mod result;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use serde::Serialize;
use utoipa::ToSchema;
use vertifleet_core::Stop;
use vertifleet_report::replay_json;
use vertifleet_study::record::ReplayedDay;
use vertifleet_study::{ComparisonReport, NetworkOrigin};

pub(crate) use self::asked::{Asked, NewStudy, Split};
pub(crate) use self::progress::StudyProgress;
use self::progress::{Progress, Watched};
pub(crate) use self::result::StudyResult;
use crate::clock::now_ms;
use crate::error::Error;
use crate::keys::Idempotency;
use crate::problem::Problem;

/// Largest number of studies that wait.
const MOST_WAITING: usize = 8;
/// Largest number of finished studies; the oldest make room for new ones.
const MOST_ENDED: usize = 20;
/// The lowest priority of threads on Linux.
#[cfg(target_os = "linux")]
const LAST_IN_TURN: i32 = 19;

/// A study: its request, its progress and its result.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub(crate) struct StudyInfo {
    /// Its id.
    pub(crate) id: String,
    /// The name of its network.
    network: String,
    /// Whether that is a shipped network (`shipped`), a network with such a name that draws other
    /// days (`changed`), or neither (`own`).
    #[schema(value_type = String)]
    network_origin: NetworkOrigin,
    /// Its policies. The others are measured against the first.
    policies: Vec<String>,
    /// Its number of days.
    days: u32,
    /// The seed of its first day, or its number among the validation days.
    seed: u64,
    /// The purpose of its days.
    split: Split,
    /// Whether an upper bound is proven for every day.
    bounds: bool,
    /// The command that runs the same study without the service.
    command: String,
    /// When it was requested, milliseconds of the Unix clock.
    created_ms: i64,
    /// Settings that are allowed but probably not intended.
    warnings: Vec<String>,
    /// Its state.
    state: StudyState,
    /// Its progress, while it plays.
    #[serde(skip_serializing_if = "Option::is_none")]
    progress: Option<StudyProgress>,
    /// How long it played, seconds, once it has finished.
    #[serde(skip_serializing_if = "Option::is_none")]
    took_s: Option<f64>,
    /// The reason why it failed.
    #[serde(skip_serializing_if = "Option::is_none")]
    problem: Option<Problem>,
    /// The result, if a finished study is read.
    #[serde(skip_serializing_if = "Option::is_none")]
    result: Option<StudyResult>,
}

/// The state of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum StudyState {
    /// It waits for studies that were asked for before.
    Waiting,
    /// It plays its days.
    Playing,
    /// It has its result.
    Finished,
    /// It could not be played to its end.
    Failed,
}

/// The studies of the service.
#[derive(Debug, Default)]
pub(crate) struct Studies {
    list: Arc<Mutex<List>>,
}

/// All studies in the order in which they were asked for.
#[derive(Debug, Default)]
struct List {
    studies: Vec<Arc<Study>>,
    /// Whether a thread plays them.
    is_played: bool,
}

/// A study.
#[derive(Debug)]
struct Study {
    /// The constant part; its state is not used.
    info: StudyInfo,
    /// The request that made it, if it has a key.
    key: Option<Idempotency>,
    stop: Stop,
    stage: Mutex<Stage>,
}

/// The state of a study, with its data.
#[derive(Debug)]
enum Stage {
    Waiting(Box<Asked>),
    Playing(Progress),
    Finished { report: Box<ComparisonReport>, replayed: Vec<ReplayedDay>, took_s: f64 },
    Failed(Problem),
}

impl Studies {
    /// Adds a study with a new id to those that wait.
    ///
    /// # Errors
    /// Returns [`Error::TooMuch`] if too many wait.
    pub(crate) fn add(
        &self,
        id: String,
        key: Option<Idempotency>,
        asked: Asked,
    ) -> Result<StudyInfo, Error> {
        let mut list = lock(&self.list);
        let waiting = list.studies.iter().filter(|study| study.state() == StudyState::Waiting);
        if waiting.count() >= MOST_WAITING {
            return Err(Error::TooMuch { what: "studies that wait", most: MOST_WAITING as u64 });
        }
        let study = Arc::new(Study::new(id, key, asked));
        let info = study.info();
        list.studies.push(study);
        list.forget_the_oldest();
        if !list.is_played {
            list.is_played = true;
            let played = Arc::clone(&self.list);
            std::thread::spawn(move || play_all(&played));
        }
        Ok(info)
    }

    /// The study that an earlier request with the same key has made.
    ///
    /// # Errors
    /// Returns [`Error::KeyReused`] if another request has made one with this key.
    pub(crate) fn asked_before(
        &self,
        asked: Option<&Idempotency>,
    ) -> Result<Option<StudyInfo>, Error> {
        let Some(Idempotency { key, request }) = asked else { return Ok(None) };
        let list = lock(&self.list);
        let made = |study: &&Arc<Study>| study.key.as_ref().is_some_and(|known| known.key == *key);
        let Some(study) = list.studies.iter().find(made) else { return Ok(None) };
        let is_same = study.key.as_ref().is_some_and(|known| known.request == *request);
        if is_same { Ok(Some(study.info())) } else { Err(Error::KeyReused { key: key.clone() }) }
    }

    /// All studies, the latest first, without their results.
    pub(crate) fn list(&self) -> Vec<StudyInfo> {
        lock(&self.list).studies.iter().rev().map(|study| study.info()).collect()
    }

    /// A study, with its result if it has one.
    ///
    /// # Errors
    /// Returns [`Error::NotFound`] if there is no such study.
    pub(crate) fn read(&self, id: &str) -> Result<StudyInfo, Error> {
        let study = self.find(id)?;
        let mut info = study.info();
        if let Stage::Finished { report, .. } = &*lock(&study.stage) {
            info.result = Some(StudyResult::of(report, &study.info.policies));
        }
        Ok(info)
    }

    /// The page with the result of a study.
    ///
    /// # Errors
    /// Returns [`Error::NotFound`] if there is no such study, or if it has not finished.
    pub(crate) fn page(&self, id: &str) -> Result<String, Error> {
        match &*lock(&self.find(id)?.stage) {
            Stage::Finished { report, replayed, .. } => {
                Ok(vertifleet_report::comparison(report, replayed).page())
            }
            _ => Err(Error::not_found("report of study", id)),
        }
    }

    /// The first days of a study as each policy played them, as JSON.
    ///
    /// # Errors
    /// Returns [`Error::NotFound`] if there is no such study, or if it has not finished.
    pub(crate) fn replay(&self, id: &str) -> Result<String, Error> {
        match &*lock(&self.find(id)?.stage) {
            Stage::Finished { replayed, .. } => Ok(replay_json(replayed)),
            _ => Err(Error::not_found("replay of study", id)),
        }
    }

    /// Stops a study, if it has not ended, and removes it.
    ///
    /// # Errors
    /// Returns [`Error::NotFound`] if there is no such study.
    pub(crate) fn delete(&self, id: &str) -> Result<(), Error> {
        let study = self.find(id)?;
        study.stop.request();
        lock(&self.list).studies.retain(|one| !Arc::ptr_eq(one, &study));
        Ok(())
    }

    fn find(&self, id: &str) -> Result<Arc<Study>, Error> {
        let found = lock(&self.list).studies.iter().find(|study| study.info.id == id).cloned();
        found.ok_or_else(|| Error::not_found("study", id))
    }
}

impl Drop for Studies {
    /// The thread that runs them ends soon after the service has.
    fn drop(&mut self) {
        for study in lock(&self.list).studies.drain(..) {
            study.stop.request();
        }
    }
}

impl List {
    fn forget_the_oldest(&mut self) {
        let has_ended =
            |study: &Arc<Study>| matches!(study.state(), StudyState::Finished | StudyState::Failed);
        let ended = self.studies.iter().filter(|study| has_ended(study)).count();
        let mut too_many = ended.saturating_sub(MOST_ENDED);
        self.studies.retain(|study| {
            let is_forgotten = too_many > 0 && has_ended(study);
            too_many -= usize::from(is_forgotten);
            !is_forgotten
        });
    }
}

impl Study {
    fn new(id: String, key: Option<Idempotency>, asked: Asked) -> Self {
        let info = StudyInfo {
            id,
            network: asked.network.name().to_owned(),
            network_origin: asked.origin,
            policies: asked.policies.clone(),
            days: asked.drawn.days,
            seed: asked.drawn.first,
            split: asked.split,
            bounds: asked.bound_step.is_some(),
            command: asked.command(),
            created_ms: now_ms(),
            warnings: asked.warnings.clone(),
            state: StudyState::Waiting,
            progress: None,
            took_s: None,
            problem: None,
            result: None,
        };
        let stage = Mutex::new(Stage::Waiting(Box::new(asked)));
        Self { info, key, stop: Stop::default(), stage }
    }

    fn state(&self) -> StudyState {
        match &*lock(&self.stage) {
            Stage::Waiting(_) => StudyState::Waiting,
            Stage::Playing(_) => StudyState::Playing,
            Stage::Finished { .. } => StudyState::Finished,
            Stage::Failed(_) => StudyState::Failed,
        }
    }

    fn info(&self) -> StudyInfo {
        let mut info = StudyInfo { state: self.state(), ..self.info.clone() };
        match &*lock(&self.stage) {
            Stage::Waiting(_) => {}
            Stage::Playing(progress) => info.progress = Some(progress.now()),
            Stage::Finished { took_s, .. } => info.took_s = Some(*took_s),
            Stage::Failed(problem) => info.problem = Some(problem.clone()),
        }
        info
    }

    /// Begins, if it waits: returns the request, and changes the state.
    fn begin(&self) -> Option<Box<Asked>> {
        let mut stage = lock(&self.stage);
        let Stage::Waiting(asked) = &mut *stage else { return None };
        let phases = asked.policies.len() + usize::from(asked.bound_step.is_some());
        let playing = Stage::Playing(Progress::of(phases));
        match std::mem::replace(&mut *stage, playing) {
            Stage::Waiting(asked) => Some(asked),
            _ => unreachable!("it waits"),
        }
    }

    /// Runs to the end.
    fn play(self: &Arc<Self>, asked: &Asked) {
        let begun = Instant::now();
        let command = self.info.command.clone();
        let watched = Watched(Arc::clone(self));
        let play = || -> Result<(ComparisonReport, Vec<ReplayedDay>), Error> {
            let records = threads()
                .map_err(|cause| Error::Internal { cause: cause.to_string() })?
                .install(|| asked.comparison(&self.stop)?.run(command, &self.stop, &watched))?;
            Ok((ComparisonReport::of(&records)?, records.replayed))
        };
        let outcome = catch_unwind(AssertUnwindSafe(play)).unwrap_or_else(|_| {
            Err(Error::Internal { cause: "the study failed; the log has more".to_owned() })
        });
        *lock(&self.stage) = match outcome {
            Ok((report, replayed)) => {
                let took_s = begun.elapsed().as_secs_f64();
                Stage::Finished { report: Box::new(report), replayed, took_s }
            }
            Err(error) => Stage::Failed(Problem::of(&error)),
        };
    }
}

/// Runs all waiting studies, one after the other.
fn play_all(list: &Mutex<List>) {
    let next = || {
        let mut list = lock(list);
        let next = list.studies.iter().find_map(|study| Some((Arc::clone(study), study.begin()?)));
        list.is_played = next.is_some();
        next
    };
    while let Some((study, asked)) = next() {
        study.play(&asked);
    }
}

/// The threads of a study: half of the cores, with the lowest priority.
fn threads() -> Result<ThreadPool, ThreadPoolBuildError> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let pool = ThreadPoolBuilder::new().num_threads((cores / 2).max(1));
    // On Linux this affects the calling thread; elsewhere it would slow the whole service down.
    #[cfg(target_os = "linux")]
    let pool = pool.start_handler(|_| {
        // A thread whose priority cannot be lowered still runs.
        let _ = rustix::process::setpriority_process(None, LAST_IN_TURN);
    });
    pool.build()
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
