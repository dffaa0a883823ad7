//! What is learned from: decisions of played days, each with what trying its choices out says they are worth.

use std::collections::BTreeMap;

use vertifleet_core::VertiportIx;

use crate::relative::features::{Rows, Scene};

/// Decisions of days with one number of vertiports.
#[derive(Debug, Clone)]
pub(crate) struct Lessons {
    pub(crate) rows: Rows,
    /// By row and vertiport: what the choice is worth at the prices less the best, in [`Scene::addition_usd`]; what trying out says
    /// it is worth less the mean of the list. 0 for what is not on the list.
    pub(crate) priced: Vec<f32>,
    pub(crate) values: Vec<f32>,
}

impl Lessons {
    pub(crate) fn new(vertiports: usize) -> Self {
        Self { rows: Rows::new(vertiports), priced: Vec::new(), values: Vec::new() }
    }

    /// Adds a decision with what trying out says that each choice is worth, dollars. One with nothing at stake teaches nothing.
    pub(crate) fn push(
        &mut self,
        scene: Scene<'_>,
        listed: &[(f64, VertiportIx)],
        values_usd: &[f64],
    ) {
        let (vertiports, addition_usd) = (self.rows.vertiports(), scene.addition_usd());
        if addition_usd <= 0.0 {
            return;
        }
        self.rows.push(scene, listed);
        let first = self.priced.len();
        self.priced.resize(first + vertiports, 0.0);
        self.values.resize(first + vertiports, 0.0);
        let mean_usd = values_usd.iter().sum::<f64>() / values_usd.len() as f64;
        for (&(priced_usd, to), value) in listed.iter().zip(values_usd) {
            self.priced[first + to.at()] = ((priced_usd - listed[0].0) / addition_usd) as f32;
            self.values[first + to.at()] = ((value - mean_usd) / addition_usd) as f32;
        }
    }

    fn append(&mut self, other: &Self) {
        for row in 0..other.rows.len() {
            self.rows.push_copy(&other.rows, row);
        }
        self.priced.extend(&other.priced);
        self.values.extend(&other.values);
    }
}

/// Lessons of all numbers of vertiports.
#[derive(Debug, Clone, Default)]
pub(crate) struct Library(pub(crate) BTreeMap<usize, Lessons>);

impl Library {
    pub(crate) fn add(&mut self, lessons: &Lessons) {
        let vertiports = lessons.rows.vertiports();
        self.0.entry(vertiports).or_insert_with(|| Lessons::new(vertiports)).append(lessons);
    }

    pub(crate) fn len(&self) -> usize {
        self.0.values().map(|lessons| lessons.rows.len()).sum()
    }
}
