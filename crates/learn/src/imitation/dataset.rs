//! The dataset of imitation: decisions of played days, each with the values of its choices by roll-outs.

use std::collections::BTreeMap;

use safetensors::tensor::SafeTensors;
use vertifleet_policy::PricedChoice;

use crate::gcaps_x::features::{AIRCRAFT_FEATURES, NODE_FEATURES, Rows, Scene};
use crate::run::checkpoint::tensor;

/// Samples from days with one number of vertiports.
#[derive(Debug, Clone)]
pub(crate) struct Samples {
    pub(crate) rows: Rows,
    /// For each row and vertiport, in [`Scene::addition_usd`]: `priced` is the choice's worth at the prices less that
    /// of the best choice, and `values` is its value by roll-outs less the mean over the list. Both are 0 for a
    /// vertiport that is not on the list.
    pub(crate) priced: Vec<f32>,
    pub(crate) values: Vec<f32>,
}

impl Samples {
    pub(crate) fn new(vertiports: usize) -> Self {
        Self { rows: Rows::new(vertiports), priced: Vec::new(), values: Vec::new() }
    }

    /// Adds a decision with the values of its choices by roll-outs, dollars. A decision with nothing at stake teaches
    /// nothing and is left out.
    pub(crate) fn push(&mut self, scene: Scene<'_>, listed: &[PricedChoice], values_usd: &[f64]) {
        let (vertiports, addition_usd) = (self.rows.vertiports(), scene.addition_usd());
        if addition_usd <= 0.0 {
            return;
        }
        self.rows.push(scene, listed);
        let first = self.priced.len();
        self.priced.resize(first + vertiports, 0.0);
        self.values.resize(first + vertiports, 0.0);
        let mean_usd = values_usd.iter().sum::<f64>() / values_usd.len() as f64;
        for (&PricedChoice { worth_usd, to }, value) in listed.iter().zip(values_usd) {
            self.priced[first + to.at()] =
                ((worth_usd - listed[0].worth_usd) / addition_usd) as f32;
            self.values[first + to.at()] = ((value - mean_usd) / addition_usd) as f32;
        }
    }

    /// Drops all samples after the first `len`.
    fn truncate(&mut self, len: usize) {
        self.rows.truncate(len);
        self.priced.truncate(len * self.rows.vertiports());
        self.values.truncate(len * self.rows.vertiports());
    }

    fn append(&mut self, other: &Self) {
        for row in 0..other.rows.len() {
            self.rows.push_copy(&other.rows, row);
        }
        self.priced.extend(&other.priced);
        self.values.extend(&other.values);
    }
}

/// The samples of days with any number of vertiports, by that number.
#[derive(Debug, Clone, Default)]
pub(crate) struct Dataset(pub(crate) BTreeMap<usize, Samples>);

/// The most vertiports that a network file may have.
const MOST_VERTIPORTS: usize = 256;
/// The tensors that a checkpoint has for the samples of each number of vertiports, which stands before these names.
const TENSORS: [&str; 4] = ["nodes", "aircraft", "priced", "values"];

impl Dataset {
    pub(crate) fn add(&mut self, samples: &Samples) {
        let vertiports = samples.rows.vertiports();
        self.0.entry(vertiports).or_insert_with(|| Samples::new(vertiports)).append(samples);
    }

    pub(crate) fn len(&self) -> usize {
        self.0.values().map(|samples| samples.rows.len()).sum()
    }

    /// The number of samples for each number of vertiports.
    pub(crate) fn lengths(&self) -> BTreeMap<usize, usize> {
        self.0.iter().map(|(&vertiports, samples)| (vertiports, samples.rows.len())).collect()
    }

    /// Drops the samples that were added since the dataset had these lengths.
    pub(crate) fn truncate(&mut self, lengths: &BTreeMap<usize, usize>) {
        self.0.retain(|vertiports, _| lengths.contains_key(vertiports));
        for (vertiports, samples) in &mut self.0 {
            samples.truncate(lengths[vertiports]);
        }
    }

    /// All samples as a checkpoint stores them. They are stored and not computed again because roll-outs take most of
    /// a run's time.
    pub(crate) fn tensors(&self) -> impl Iterator<Item = (String, &[f32])> {
        self.0.iter().flat_map(|(&vertiports, samples)| {
            let inputs = samples.rows.inputs();
            let numbers = [inputs.nodes, inputs.aircraft, &samples.priced, &samples.values];
            TENSORS.iter().map(move |name| tensor_name(vertiports, name)).zip(numbers)
        })
    }

    /// Reads the samples of a checkpoint, which has samples for these numbers of vertiports.
    pub(crate) fn read(file: &SafeTensors<'_>, vertiports: &[usize]) -> Result<Self, String> {
        let samples = vertiports.iter().map(|&count| Ok((count, Samples::read(file, count)?)));
        Ok(Self(samples.collect::<Result<_, String>>()?))
    }
}

impl Samples {
    /// Reads the samples for one number of vertiports. Memory is allocated only for numbers that the file really
    /// holds.
    fn read(file: &SafeTensors<'_>, vertiports: usize) -> Result<Self, String> {
        if !(1..=MOST_VERTIPORTS).contains(&vertiports) {
            return Err(format!(
                "samples must have 1 to {MOST_VERTIPORTS} vertiports, found {vertiports}"
            ));
        }
        let [nodes, aircraft, priced, values] = TENSORS.map(|name| tensor_name(vertiports, name));
        let numbers = file.tensor(&aircraft).map_err(|error| error.to_string())?.data().len() / 4;
        let rows = numbers / AIRCRAFT_FEATURES;
        let tensor = |name: &str, entries: usize| tensor(file, name, entries);
        let samples = Self {
            rows: Rows::of(
                vertiports,
                tensor(&nodes, rows * vertiports * NODE_FEATURES)?,
                tensor(&aircraft, rows * AIRCRAFT_FEATURES)?,
            ),
            priced: tensor(&priced, rows * vertiports)?,
            values: tensor(&values, rows * vertiports)?,
        };
        let mut masks = samples.rows.inputs().mask.chunks_exact(vertiports);
        if masks.any(|mask| mask.iter().all(|&listed| listed == 0)) {
            return Err("a sample has no choice".to_owned());
        }
        Ok(samples)
    }
}

/// The name of a tensor in a checkpoint. It has not changed since the first checkpoints, so they can still be read.
fn tensor_name(vertiports: usize, name: &str) -> String {
    format!("lessons.{vertiports}.{name}")
}
