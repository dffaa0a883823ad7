//! The dataset of imitation: decisions of played days, each with the values of its choices by
//! roll-outs.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use safetensors::tensor::SafeTensors;
use vertifleet_core::VertiportIx;
use vertifleet_observe::{Observation, Shape};

use crate::nn::{Architecture, Inputs};
use crate::rows::Rows;
use crate::run::checkpoint::tensor;

/// Samples from days with one number of vertiports.
#[derive(Debug, Clone)]
pub(crate) struct Samples {
    pub(crate) rows: Rows,
    /// For each row and vertiport, in the unit of the network's logits: `priced` is the choice's
    /// worth at the prices less that of the best choice, and `values` is its value by roll-outs
    /// less the mean over all choices. Both are 0 for a vertiport that cannot be chosen.
    pub(crate) priced: Vec<f32>,
    pub(crate) values: Vec<f32>,
}

/// A choice with the teacher's label.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LabelledChoice {
    pub(crate) to: VertiportIx,
    /// Its worth at the prices, dollars.
    pub(crate) worth_usd: f64,
    /// Its value by roll-outs, dollars.
    pub(crate) value_usd: f64,
}

impl Samples {
    /// No samples yet, in the form of these rows, which must be empty.
    pub(crate) fn new(rows: Rows) -> Self {
        Self { rows, priced: Vec::new(), values: Vec::new() }
    }

    /// Adds the teacher's labels of the decision whose row was added last. `unit_usd` is the unit
    /// of the network's logits.
    pub(crate) fn judge(&mut self, unit_usd: f64, choices: &[LabelledChoice]) {
        let first = self.priced.len();
        self.priced.resize(first + self.rows.vertiports(), 0.0);
        self.values.resize(first + self.rows.vertiports(), 0.0);
        let best_usd = choices.iter().map(|one| one.worth_usd).fold(f64::NEG_INFINITY, f64::max);
        let mean_usd = choices.iter().map(|one| one.value_usd).sum::<f64>() / choices.len() as f64;
        for &LabelledChoice { to, worth_usd, value_usd } in choices {
            self.priced[first + to.at()] = ((worth_usd - best_usd) / unit_usd) as f32;
            self.values[first + to.at()] = ((value_usd - mean_usd) / unit_usd) as f32;
        }
    }

    /// Drops all samples after the first `len`.
    fn truncate(&mut self, len: usize) {
        self.rows.resize(len);
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

/// Largest number of vertiports of a network file.
const MOST_VERTIPORTS: usize = 256;
/// The tensors of a checkpoint for the samples of each number of vertiports, which precedes these
/// names. Only networks that observe edges have `edges`, and only the features of the paper need
/// masks.
const TENSORS: [&str; 6] = ["nodes", "aircraft", "priced", "values", "edges", "masks"];

/// Whether the features of a policy leave out which vertiports may be chosen.
fn has_masks(policy: &Architecture) -> bool {
    policy.observation() == Observation::Paper
}

impl Dataset {
    pub(crate) fn add(&mut self, samples: Samples) {
        match self.0.entry(samples.rows.vertiports()) {
            Entry::Occupied(mut known) => known.get_mut().append(&samples),
            Entry::Vacant(new) => {
                new.insert(samples);
            }
        }
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

    /// All samples, for a checkpoint. They are stored rather than recomputed because roll-outs take
    /// most of a run's time.
    pub(crate) fn tensors(
        &self,
        policy: &Architecture,
    ) -> impl Iterator<Item = (String, Cow<'_, [f32]>)> {
        let has_masks = has_masks(policy);
        self.0.iter().flat_map(move |(&vertiports, Samples { rows, priced, values })| {
            let Inputs { nodes, aircraft, edges, mask, .. } = rows.inputs();
            let masks = mask.iter().filter(|_| has_masks).map(|&open| f32::from(open));
            let masks = Cow::Owned(masks.collect());
            let [nodes, aircraft, priced, values, edges] =
                [nodes, aircraft, priced, values, edges].map(Cow::Borrowed);
            let numbers = [nodes, aircraft, priced, values, edges, masks];
            let named = TENSORS.iter().map(move |name| tensor_name(vertiports, name)).zip(numbers);
            named.filter(|(_, numbers)| !numbers.is_empty())
        })
    }

    /// Reads the samples of a checkpoint, which has samples for these numbers of vertiports.
    pub(crate) fn read(
        file: &SafeTensors<'_>,
        policy: &Architecture,
        vertiports: &[usize],
    ) -> Result<Self, String> {
        let samples =
            vertiports.iter().map(|&count| Ok((count, Samples::read(file, policy, count)?)));
        Ok(Self(samples.collect::<Result<_, String>>()?))
    }
}

impl Samples {
    /// Reads the samples for one number of vertiports. Memory is allocated only for numbers that
    /// the file contains.
    fn read(
        file: &SafeTensors<'_>,
        policy: &Architecture,
        vertiports: usize,
    ) -> Result<Self, String> {
        if !(1..=MOST_VERTIPORTS).contains(&vertiports) {
            return Err(format!(
                "samples must have 1 to {MOST_VERTIPORTS} vertiports, found {vertiports}"
            ));
        }
        let Shape { node_features, aircraft_features, .. } = policy.shape(vertiports);
        let [nodes, aircraft, priced, values, edges, masks] =
            TENSORS.map(|name| tensor_name(vertiports, name));
        let numbers = file.tensor(&aircraft).map_err(|error| error.to_string())?.data().len() / 4;
        let rows = numbers / aircraft_features;
        let tensor = |name: &str, entries: usize| tensor(file, name, entries);
        let masks = has_masks(policy).then(|| tensor(&masks, rows * vertiports));
        let edges = policy.edges().map(|_| tensor(&edges, rows * vertiports * vertiports));
        let samples = Self {
            rows: Rows::of(
                policy,
                vertiports,
                tensor(&nodes, rows * vertiports * node_features)?,
                tensor(&aircraft, rows * aircraft_features)?,
                edges.transpose()?,
                masks.transpose()?.as_deref(),
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

/// The name of a tensor in a checkpoint. It has not changed since the first checkpoints, so they
/// can still be read.
fn tensor_name(vertiports: usize, name: &str) -> String {
    format!("lessons.{vertiports}.{name}")
}
