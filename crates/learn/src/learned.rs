//! A trained network as a policy: it chooses the feasible vertiport with the highest logit (§IV.B,
//! greedy decoding).

use std::sync::Arc;

use vertifleet_core::VertiportIx;
use vertifleet_policy::{Policy, PolicyError};
use vertifleet_sim::{Decision, View};

use crate::model::Model;
use crate::scorer::{Scorer, highest};

/// Decides by a trained network. It is deterministic: among equal logits the first vertiport wins.
pub struct Learned(pub(crate) Scorer);

impl Learned {
    /// The policy of a model of any kind but `gcaps-x`.
    pub fn new(model: &Model) -> Self {
        let header = model.header();
        Self(Scorer::new(&header.policy, header.feature_scales, Arc::new(model.weights())))
    }
}

impl Policy for Learned {
    fn choose(&mut self, decision: &Decision, view: &View<'_>) -> Result<VertiportIx, PolicyError> {
        Ok(highest(self.0.score(*view, decision, None)))
    }

    /// Logits.
    fn values(
        &mut self,
        decision: &Decision,
        view: &View<'_>,
        values: &mut [f64],
    ) -> Result<(), PolicyError> {
        self.choose_with_values(decision, view, values).map(|_| ())
    }

    fn choose_with_values(
        &mut self,
        decision: &Decision,
        view: &View<'_>,
        values: &mut [f64],
    ) -> Result<VertiportIx, PolicyError> {
        let logits = self.0.score(*view, decision, None);
        for (value, &logit) in values.iter_mut().zip(logits) {
            *value = if logit.is_finite() { f64::from(logit) } else { f64::NAN };
        }
        Ok(highest(logits))
    }

    fn choose_batch(
        &mut self,
        asked: &mut dyn Iterator<Item = (Decision, View<'_>)>,
        choices: &mut Vec<VertiportIx>,
    ) -> Result<(), PolicyError> {
        let mut asked = asked.peekable();
        while let Some(vertiports) = asked.peek().map(|(_, view)| view.vertiports()) {
            self.0.clear(vertiports);
            let fits = |(_, view): &(Decision, View<'_>)| view.vertiports() == vertiports;
            while !self.0.is_full()
                && let Some((decision, view)) = asked.next_if(fits)
            {
                self.0.push(view, &decision, None);
            }
            self.0.forward();
            choices.extend(self.0.logits().map(highest));
        }
        Ok(())
    }
}
