//! The progress of a study: its bounds first, then one policy after the other, each on all days.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use serde::Serialize;
use utoipa::ToSchema;
use vertifleet_study::record::mean_profit_usd;
use vertifleet_study::{PolicyRecord, Watch};

use super::result::Estimate;
use super::{Stage, Study, lock};

/// The progress of a study.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub(crate) struct StudyProgress {
    /// The policy that plays, or `bounds` while days are bounded; absent while days are drawn.
    #[serde(skip_serializing_if = "Option::is_none")]
    doing: Option<String>,
    /// The share of the work that is done, 0 to 1; every policy counts the same.
    share: f64,
    /// Expected remaining time, seconds. It assumes that the rest of this policy takes as long per
    /// day as its days so far, and the others as long as the mean of those before. Absent until a
    /// day has been played.
    #[serde(skip_serializing_if = "Option::is_none")]
    left_s: Option<f64>,
    /// The results of the policies that have played all their days.
    played: Vec<PlayedPolicy>,
}

/// The result of a policy while others still play.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub(crate) struct PlayedPolicy {
    /// Its name.
    name: String,
    /// Profit of a day, dollars.
    profit_usd: Estimate,
}

/// The progress of a study in memory: each phase is the bounds or a policy.
#[derive(Debug)]
pub(super) struct Progress {
    begun: Instant,
    phases: usize,
    /// The number of finished phases.
    over: usize,
    phase: Option<Phase>,
    played: Vec<PlayedPolicy>,
}

#[derive(Debug)]
struct Phase {
    doing: String,
    begun: Instant,
    days: usize,
    done: Arc<AtomicUsize>,
}

impl Progress {
    /// Nothing has been played yet.
    pub(super) fn of(phases: usize) -> Self {
        Self { begun: Instant::now(), phases, over: 0, phase: None, played: Vec::new() }
    }

    /// Begins the next phase. Returns the counter of its days.
    fn begin(&mut self, doing: &str, days: usize) -> Arc<AtomicUsize> {
        let begun = Instant::now();
        let done = Arc::new(AtomicUsize::new(0));
        match self.phase {
            // Time for drawing days counts for no policy.
            None => self.begun = begun,
            Some(_) => self.over += 1,
        }
        self.phase = Some(Phase { doing: doing.to_owned(), begun, days, done: Arc::clone(&done) });
        done
    }

    /// The current progress.
    pub(super) fn now(&self) -> StudyProgress {
        let Some(Phase { doing, begun, days, done }) = &self.phase else {
            return StudyProgress { doing: None, share: 0.0, left_s: None, played: Vec::new() };
        };
        let done = done.load(Ordering::Relaxed) as f64 / (*days).max(1) as f64;
        let share = (self.over as f64 + done) / self.phases.max(1) as f64;
        let before = begun.duration_since(self.begun);
        let left_s = self.left_s(done, before, begun.elapsed());
        StudyProgress { doing: Some(doing.clone()), share, left_s, played: self.played.clone() }
    }

    /// The expected remaining time, if the share `done` of this phase took `so_far` and all phases
    /// before it took `before`.
    fn left_s(&self, done: f64, before: Duration, so_far: Duration) -> Option<f64> {
        let (before_s, so_far_s) = (before.as_secs_f64(), so_far.as_secs_f64());
        let whole_phase_s = match (done > 0.0, self.over) {
            (true, _) => so_far_s / done,
            (false, 0) => return None,
            (false, over) => (before_s / over as f64).max(so_far_s),
        };
        let mean_s = (before_s + whole_phase_s) / (self.over + 1) as f64;
        let to_come = self.phases.saturating_sub(self.over + 1) as f64;
        Some((whole_phase_s - so_far_s).max(0.0) + to_come * mean_s)
    }
}

/// A study that receives its progress.
pub(super) struct Watched(pub(super) Arc<Study>);

impl Watched {
    fn begin(&self, doing: &str, days: usize) -> Box<dyn Fn() + Sync> {
        let Stage::Playing(progress) = &mut *lock(&self.0.stage) else { return Box::new(|| ()) };
        let done = progress.begin(doing, days);
        Box::new(move || {
            done.fetch_add(1, Ordering::Relaxed);
        })
    }
}

impl Watch for Watched {
    type Bar = Box<dyn Fn() + Sync>;

    fn bounds(&self, days: usize) -> Self::Bar {
        self.begin("bounds", days)
    }

    fn policy(&self, name: &str, _: usize, _: usize, days: usize) -> Self::Bar {
        self.begin(name, days)
    }

    fn played(&self, record: &PolicyRecord) {
        let Stage::Playing(progress) = &mut *lock(&self.0.stage) else { return };
        let profit_usd = mean_profit_usd(&record.days).into();
        progress.played.push(PlayedPolicy { name: record.name.clone(), profit_usd });
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::Ordering;
    use std::time::Duration;

    use super::Progress;

    #[test]
    fn the_time_left_follows_from_the_pace_so_far() {
        let mut progress = Progress::of(3);
        let seconds = Duration::from_secs;
        assert_eq!(progress.now().left_s, None, "no day has been played");
        progress.begin("bounds", 4).fetch_add(1, Ordering::Relaxed);
        assert_eq!(progress.now().share, 0.25 / 3.0);
        // A quarter took 2 s: 6 s for the rest of this phase, and 8 s for each of the other two.
        assert_eq!(progress.left_s(0.25, seconds(0), seconds(2)), Some(22.0));
        progress.begin("greedy", 4);
        // The first phase took 8 s, so this one and the next may too.
        assert_eq!(progress.left_s(0.0, seconds(8), seconds(1)), Some(15.0));
        assert_eq!(progress.left_s(0.5, seconds(8), seconds(1)), Some(1.0 + 5.0));
        progress.begin("prices", 4);
        assert_eq!(progress.left_s(1.0, seconds(9), seconds(5)), Some(0.0));
    }
}
