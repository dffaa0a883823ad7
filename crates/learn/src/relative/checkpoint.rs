//! Checkpoints of `gcaps-x` runs: weights, moments and all lessons between two rounds, in one safetensors file.
//!
//! Lessons are kept rather than made again: trying choices out is most of what a run takes. Which days a round plays, and the
//! order in which its lessons are met, follow from the seed and the round's number, so there is nothing else to keep.

use std::collections::BTreeMap;
use std::path::Path;

use safetensors::tensor::{Dtype, SafeTensors};
use serde::{Deserialize, Serialize};

use crate::adam::Adam;
use crate::error::Error;
use crate::nn::Architecture;
use crate::relative::course::Course;
use crate::relative::features::{AIRCRAFT_FEATURES, NODE_FEATURES, Rows};
use crate::relative::lessons::{Lessons, Library};
use crate::relative::training::Round;
use crate::settings::first_difference;
use crate::tensor_file;

const FORMAT: &str = "vertifleet-checkpoint-any/1";
/// No checkpoint of ours comes near; larger files are not read.
const LIMIT_BYTES: u64 = 16 << 30;
/// As many as a network file may have.
const MOST_VERTIPORTS: usize = 256;
const LEARNER: [&str; 3] = ["params", "adam_first", "adam_second"];
/// Tensors of the lessons with one number of vertiports; that number stands before the name.
const LESSONS: [&str; 4] = ["nodes", "aircraft", "priced", "values"];

/// What makes a run the run that it is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Run {
    pub(crate) network: String,
    /// Changes when the network's days do.
    pub(crate) network_print: u32,
    pub(crate) policy: Architecture,
    pub(crate) course: Course,
    pub(crate) seed: u32,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Header {
    format: String,
    run: Run,
    rounds: Vec<Round>,
    adam_steps: u64,
    /// Numbers of vertiports that there are lessons of.
    vertiports: Vec<usize>,
}

/// How far a run has come.
pub(crate) struct Progress {
    pub(crate) rounds: Vec<Round>,
    pub(crate) params: Vec<f32>,
    pub(crate) adam: Adam,
    pub(crate) library: Library,
}

/// Writes a checkpoint, whole or not at all.
pub(crate) fn write(
    path: &Path,
    run: Run,
    rounds: &[Round],
    (params, adam): (&[f32], &Adam),
    library: &Library,
) -> Result<(), Error> {
    let header = Header {
        format: FORMAT.to_owned(),
        run,
        rounds: rounds.to_vec(),
        adam_steps: adam.steps,
        vertiports: library.0.keys().copied().collect(),
    };
    let learner = LEARNER.iter().map(|&name| name.to_owned());
    let learner = learner.zip([params, &adam.first, &adam.second]);
    let lessons = library.0.iter().flat_map(|(&vertiports, lessons)| {
        let inputs = lessons.rows.inputs();
        let numbers = [inputs.nodes, inputs.aircraft, &lessons.priced, &lessons.values];
        LESSONS.iter().map(move |name| lessons_name(vertiports, name)).zip(numbers)
    });
    let tensors: Vec<(String, &[f32])> = learner.chain(lessons).collect();
    let tensors =
        tensors.iter().map(|(name, entries)| (name.as_str(), vec![entries.len()], *entries));
    let bytes = tensor_file::to_bytes(&header, tensors);
    Ok(vertifleet_core::write_atomically(path, &bytes)?)
}

/// Reads the checkpoint of this run, whose network has so many parameters.
pub(crate) fn read(path: &Path, asked: &Run, parameters: usize) -> Result<Progress, Error> {
    let bytes = vertifleet_core::read_at_most(path, LIMIT_BYTES)?;
    from_bytes(&bytes, asked, parameters).map_err(|rule| Error::BadCheckpoint { rule })
}

fn from_bytes(bytes: &[u8], asked: &Run, parameters: usize) -> Result<Progress, String> {
    let Header { run, rounds, adam_steps, vertiports, .. } =
        tensor_file::header(bytes, FORMAT, |header: &Header| &header.format)?;
    check_same(&run, asked)?;
    if rounds.len() > asked.course.rounds as usize {
        return Err(format!("{} rounds are more than the run has", rounds.len()));
    }
    if rounds.iter().zip(1..).any(|(round, number)| round.round != number) {
        return Err("rounds must be numbered from 1 on".to_owned());
    }
    let file = SafeTensors::deserialize(bytes).map_err(|error| error.to_string())?;
    let learner = |name: &str| tensor(&file, name, parameters);
    let [params, first, second] = LEARNER.map(learner);
    let lessons = vertiports.into_iter().map(|count| Ok((count, lessons(&file, count)?)));
    Ok(Progress {
        rounds,
        params: params?,
        adam: Adam { first: first?, second: second?, steps: adam_steps },
        library: Library(lessons.collect::<Result<BTreeMap<usize, Lessons>, String>>()?),
    })
}

/// The checkpoint is of the run that is asked for.
fn check_same(found: &Run, asked: &Run) -> Result<(), String> {
    let differs = |what: &str, found: &dyn std::fmt::Display, asked: &dyn std::fmt::Display| {
        Err(format!("it is of a run with {what} {found}, but {asked} is asked for"))
    };
    if found.network != asked.network {
        return differs("network", &found.network, &asked.network);
    }
    if found.network_print != asked.network_print {
        return Err(format!("network {:?} has changed since the run was started", found.network));
    }
    if found.policy != asked.policy {
        let [found, asked] = [&found.policy, &asked.policy].map(|policy| format!("{policy:?}"));
        return differs("policy", &found, &asked);
    }
    if found.seed != asked.seed {
        return differs("seed", &found.seed, &asked.seed);
    }
    match first_difference(&found.course, &asked.course) {
        Some((name, found, asked)) => differs(&format!("setting {name}"), &found, &asked),
        None => Ok(()),
    }
}

/// All lessons with one number of vertiports. The file has to hold every number that is made room for.
fn lessons(file: &SafeTensors<'_>, vertiports: usize) -> Result<Lessons, String> {
    if !(1..=MOST_VERTIPORTS).contains(&vertiports) {
        return Err(format!(
            "lessons must have 1 to {MOST_VERTIPORTS} vertiports, found {vertiports}"
        ));
    }
    let [nodes, aircraft, priced, values] = LESSONS.map(|name| lessons_name(vertiports, name));
    let numbers = file.tensor(&aircraft).map_err(|error| error.to_string())?.data().len() / 4;
    let rows = numbers / AIRCRAFT_FEATURES;
    let tensor = |name: &str, entries: usize| tensor(file, name, entries);
    let lessons = Lessons {
        rows: Rows::of(
            vertiports,
            tensor(&nodes, rows * vertiports * NODE_FEATURES)?,
            tensor(&aircraft, rows * AIRCRAFT_FEATURES)?,
        ),
        priced: tensor(&priced, rows * vertiports)?,
        values: tensor(&values, rows * vertiports)?,
    };
    let mut masks = lessons.rows.inputs().mask.chunks_exact(vertiports);
    if masks.any(|mask| mask.iter().all(|&listed| listed == 0)) {
        return Err("a lesson has no choice".to_owned());
    }
    Ok(lessons)
}

fn lessons_name(vertiports: usize, name: &str) -> String {
    format!("lessons.{vertiports}.{name}")
}

/// The entries of a tensor that must have so many, all finite.
fn tensor(file: &SafeTensors<'_>, name: &str, entries: usize) -> Result<Vec<f32>, String> {
    let view = file.tensor(name).map_err(|error| error.to_string())?;
    if view.dtype() != Dtype::F32 || view.shape() != [entries] {
        return Err(format!("tensor {name:?} must be {entries} numbers of F32"));
    }
    let values: Vec<f32> = tensor_file::entries(&view).collect();
    if values.iter().any(|value| !value.is_finite()) {
        return Err(format!("tensor {name:?}: a number is not finite"));
    }
    Ok(values)
}
