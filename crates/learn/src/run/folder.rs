//! The folder of a run, with weights, learning curve, checkpoint and TensorBoard's events; and the
//! loop that fills it.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use vertifleet_core::{Outputs, Stop};

use crate::error::Error;
use crate::kinds;
use crate::nn::Architecture;
use crate::run::event_file::EventFile;
use crate::run::{Curve, TrainingRequest, TrainingRun};

/// After a row of the curve, a checkpoint is written only if the time since the last one is at
/// least this multiple of the time that writing it took.
const LEARNING_TO_SAVING: u32 = 50;

/// The files of a policy's run. Several policies may share a folder.
#[derive(Debug, Clone)]
pub struct RunFolder {
    folder: PathBuf,
    /// The weight file.
    pub weights: PathBuf,
    /// The learning curve, as CSV.
    pub curve: PathBuf,
    /// The file from which the run is resumed.
    pub checkpoint: PathBuf,
    /// The folder of TensorBoard's events. TensorBoard treats a folder as a run, so each policy has
    /// its own.
    pub events: PathBuf,
}

/// Follows the progress of a run.
pub trait TrainingWatch: Sync {
    /// Called when this many more units of [work](TrainingRun::work) are done.
    fn has_worked(&self, units: u64);
    /// Called when the curve has a new row, learned at this many decisions per second.
    fn has_learned(&self, curve: &Curve, steps_per_second: f64);
    /// Called when a file could not be written. The run continues without it: a disk that is full
    /// now may have room again when the run is over.
    fn could_not_write(&self, error: &Error);
}

impl RunFolder {
    /// The files of a policy's run in this folder.
    pub fn of(policy: &Architecture, folder: &Path) -> Self {
        let name = policy.name();
        let weights = folder.join(format!("{name}.safetensors"));
        Self {
            folder: folder.to_owned(),
            curve: Curve::next_to(&weights),
            weights,
            checkpoint: folder.join(format!("{name}-checkpoint.safetensors")),
            events: folder.join("tensorboard").join(name),
        }
    }

    /// Starts a run that writes its files here, or resumes the run whose files are here if `resume`
    /// is set. No other file is overwritten: a file that exists already must be one that an earlier
    /// run wrote.
    ///
    /// # Errors
    /// The same as those of [`TrainingRequest::start`] and [`TrainingRequest::resume`];
    /// [`Error::EarlierRun`] if a run is to start where another run's checkpoint is;
    /// [`Error::Core`] for files that would be lost.
    pub fn begin(
        &self,
        plan: TrainingRequest,
        resume: bool,
        outputs: &mut Outputs,
    ) -> Result<Box<dyn TrainingRun>, Error> {
        if !resume && self.checkpoint.exists() {
            return Err(Error::EarlierRun { checkpoint: self.checkpoint.display().to_string() });
        }
        if self.folder.exists() {
            outputs.writes(&self.weights, &kinds::WEIGHTS)?;
            outputs.writes(&self.curve, &kinds::curve(plan.settings.learner().curve_opening()))?;
            outputs.writes(&self.checkpoint, &kinds::CHECKPOINT)?;
        }
        let run = if resume { plan.resume(&self.checkpoint)? } else { plan.start()? };
        vertifleet_core::create_folder(&self.folder)?;
        Ok(run)
    }

    /// Learns until the run is done or `stop` is requested, and writes the files after rows of its
    /// curve and at the end. A stop loses everything learned after the last row.
    /// # Errors
    /// Returns an error if the run diverges, if its training days run out, or if the files cannot
    /// be written at the end.
    pub fn train(
        &self,
        run: &mut dyn TrainingRun,
        stop: &Stop,
        watch: &dyn TrainingWatch,
    ) -> Result<(), Error> {
        let mut curve = run.curve();
        let mut events = Events::create(&self.events, &curve, watch);
        let (mut saved, mut saving) = (Instant::now(), Duration::ZERO);
        while !run.is_done() {
            let (begun, before) = (Instant::now(), curve.steps());
            match run.advance(stop, &|units| watch.has_worked(units)) {
                Err(Error::Stopped) => break,
                advanced => advanced?,
            }
            curve = run.curve();
            let steps_per_second = (curve.steps() - before) as f64 / begun.elapsed().as_secs_f64();
            watch.has_learned(&curve, steps_per_second);
            events.append_last(&curve, steps_per_second, watch);
            if saved.elapsed() >= LEARNING_TO_SAVING * saving {
                let begun = Instant::now();
                if let Err(error) = self.write(run, &curve) {
                    watch.could_not_write(&error);
                }
                (saved, saving) = (Instant::now(), begun.elapsed());
            }
        }
        self.write(run, &curve)
    }

    /// Writes the files of the run as it stands; each file is whole at every moment. The checkpoint
    /// is written last, so everything that it refers to exists.
    fn write(&self, run: &dyn TrainingRun, curve: &Curve) -> Result<(), Error> {
        vertifleet_core::write_atomically(&self.curve, curve.to_csv().as_bytes())?;
        run.model().write(&self.weights)?;
        run.write_checkpoint(&self.checkpoint)
    }
}

/// TensorBoard's event file, while it can be written: a failure to write it does not stop the run.
struct Events(Option<EventFile>);

impl Events {
    fn create(folder: &Path, so_far: &Curve, watch: &dyn TrainingWatch) -> Self {
        Self(told(EventFile::create(folder, unix_seconds(), so_far), watch))
    }

    fn append_last(&mut self, curve: &Curve, steps_per_second: f64, watch: &dyn TrainingWatch) {
        let Some(last) = curve.rows().len().checked_sub(1) else { return };
        let (steps, mut scalars) = curve.scalars(last);
        scalars.push(("time/fps".to_owned(), steps_per_second));
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
