//! The folder of a run: weights, learning curve, checkpoint and TensorBoard's events; and the loop that fills it.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use vertifleet_core::{Outputs, Stop};

use crate::error::Error;
use crate::kinds;
use crate::nn::Architecture;
use crate::run::event_file::EventFile;
use crate::run::{Curve, TrainingPlan, TrainingRun};

/// A run is set aside after a row of its curve if that many times as long has passed since as setting it aside took the last time.
const LEARNING_TO_SAVING: u32 = 50;

/// The files of a policy's run. Those of several policies may lie in one folder.
#[derive(Debug, Clone)]
pub struct RunFolder {
    folder: PathBuf,
    /// The policy's weights.
    pub weights: PathBuf,
    /// The learning curve, as CSV.
    pub curve: PathBuf,
    /// What a run goes on from.
    pub checkpoint: PathBuf,
    /// TensorBoard takes a folder for a run, so each policy has its own.
    pub events: PathBuf,
}

/// Follows a run.
pub trait TrainingWatch: Sync {
    /// So many units of [work](TrainingRun::work) more are done.
    fn has_worked(&self, units: u64);
    /// The curve has a row more, from so many decisions a second.
    fn has_learned(&self, curve: &Curve, steps_per_second: f64);
    /// Something could not be written, and the run goes on without it; a disk that is full now may have room again when the run is
    /// over.
    fn could_not_write(&self, error: &Error);
}

impl RunFolder {
    /// The files of a policy's run in this folder.
    pub fn of(policy: &Architecture, folder: &Path) -> Self {
        let name = policy.name();
        let weights = folder.join(format!("{name}.safetensors"));
        Self {
            folder: folder.to_owned(),
            curve: Curve::beside(&weights),
            weights,
            checkpoint: folder.join(format!("{name}-checkpoint.safetensors")),
            events: folder.join("tensorboard").join(name),
        }
    }

    /// Begins a run whose files are to lie here, or goes on with the one whose files do where `resume` is asked. None of the files is
    /// read for something else, and what is there already is of an earlier run.
    ///
    /// # Errors
    /// As [`TrainingPlan::start`] and [`TrainingPlan::resume`]; [`Error::EarlierRun`] if a run is to begin where another one's checkpoint
    /// is; [`Error::Core`] for files that would be lost.
    pub fn begin(
        &self,
        plan: TrainingPlan,
        resume: bool,
        outputs: &mut Outputs,
    ) -> Result<Box<dyn TrainingRun>, Error> {
        if !resume && self.checkpoint.exists() {
            return Err(Error::EarlierRun { checkpoint: self.checkpoint.display().to_string() });
        }
        if self.folder.exists() {
            outputs.writes(&self.weights, &kinds::WEIGHTS)?;
            outputs.writes(&self.curve, kinds::curve(&plan.policy))?;
            outputs.writes(&self.checkpoint, &kinds::CHECKPOINT)?;
        }
        let run = if resume { plan.resume(&self.checkpoint)? } else { plan.start()? };
        vertifleet_core::create_folder(&self.folder)?;
        Ok(run)
    }

    /// Learns until the run is done or `stop` is requested, and sets the run aside after rows of its curve and at the end. What was
    /// learned after the last row is lost then.
    ///
    /// # Errors
    /// If the run diverges or its days run out, or if the files cannot be written at the end.
    pub fn train(
        &self,
        run: &mut dyn TrainingRun,
        stop: &Stop,
        watch: &dyn TrainingWatch,
    ) -> Result<(), Error> {
        let mut events = Events::create(&self.events, &run.curve(), watch);
        let (mut saved, mut saving) = (Instant::now(), Duration::ZERO);
        while !run.is_done() {
            let (begun, before) = (Instant::now(), run.curve().steps());
            match run.advance(stop, &|units| watch.has_worked(units)) {
                Err(Error::Stopped) => break,
                advanced => advanced?,
            }
            let curve = run.curve();
            let steps_per_second = (curve.steps() - before) as f64 / begun.elapsed().as_secs_f64();
            watch.has_learned(&curve, steps_per_second);
            events.append_last(&curve, steps_per_second, watch);
            if saved.elapsed() >= LEARNING_TO_SAVING * saving {
                let begun = Instant::now();
                if let Err(error) = self.write(run) {
                    watch.could_not_write(&error);
                }
                (saved, saving) = (Instant::now(), begun.elapsed());
            }
        }
        self.write(run)
    }

    /// Leaves the run as it stands; each file is whole at every moment. The checkpoint comes last, so that what it knows of is there.
    fn write(&self, run: &dyn TrainingRun) -> Result<(), Error> {
        vertifleet_core::write_atomically(&self.curve, run.curve().to_csv().as_bytes())?;
        run.model().write(&self.weights)?;
        run.write_checkpoint(&self.checkpoint)
    }
}

/// TensorBoard's file, as long as it can be written: a run does not depend on it.
struct Events(Option<EventFile>);

impl Events {
    fn create(folder: &Path, so_far: &Curve, watch: &dyn TrainingWatch) -> Self {
        Self(told(EventFile::create(folder, unix_seconds(), so_far), watch))
    }

    fn append_last(&mut self, curve: &Curve, steps_per_second: f64, watch: &dyn TrainingWatch) {
        let Some((steps, mut scalars)) = curve.scalars().pop() else { return };
        scalars.push(("time/fps", steps_per_second));
        if let Some(file) = &mut self.0
            && told(file.append(unix_seconds(), steps, &scalars), watch).is_none()
        {
            self.0 = None;
        }
    }
}

fn told<T>(written: Result<T, Error>, watch: &dyn TrainingWatch) -> Option<T> {
    written.inspect_err(|error| watch.could_not_write(error)).ok()
}

fn unix_seconds() -> f64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64())
}
