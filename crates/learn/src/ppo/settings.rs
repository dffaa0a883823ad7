//! The settings of training by PPO, named as in stable-baselines3, and their two presets.

use serde::{Deserialize, Serialize};
use vertifleet_sim::{Simulation, TraceRow};

use crate::error::Error;
use crate::settings::within;

/// When the reward of a day is paid (§III.H).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Reward {
    /// All of it at the end of the day, as in the paper.
    Terminal,
    /// The share of each flight at its decision, and the fixed costs of the day at the end; over a
    /// day this adds up to the same total.
    Dense,
}

impl Reward {
    /// The reward of a decision, given its outcome and the day after it; `over` is true for the
    /// last decision of the day.
    pub fn of(self, outcome: &TraceRow, day: &Simulation, over: bool) -> f64 {
        match self {
            Self::Dense => {
                // The fixed costs of the day belong to no flight; they are charged with the last
                // decision.
                let fixed_usd = if over { day.ledger().fixed_cost_usd() } else { 0.0 };
                share(outcome.profit_usd() - fixed_usd, day.potential_usd())
            }
            Self::Terminal if over => day.totals().reward,
            Self::Terminal => 0.0,
        }
    }
}

/// The share of the day's reward that one flight pays at its decision; 0 on a day without demand.
fn share(profit_usd: f64, potential_usd: f64) -> f64 {
    if potential_usd > 0.0 { profit_usd / potential_usd } else { 0.0 }
}

/// How the learning rate changes over the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LearningRateSchedule {
    /// It stays constant.
    Constant,
    /// It falls in a straight line to 0 at the end of the run.
    Linear,
}

/// The settings of training by PPO. Names and meanings are those of stable-baselines3 where it has
/// such a setting.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PpoSettings {
    /// Number of decisions to learn from in total, rounded up to whole roll-outs.
    pub total_steps: u64,
    /// Number of days that are played in parallel.
    pub n_envs: usize,
    /// Number of decisions taken on each of those days between two updates. The roll-out buffer
    /// holds `n_envs * n_steps`.
    pub n_steps: usize,
    /// Number of decisions per gradient step.
    pub batch_size: usize,
    /// Number of passes over the buffer per update.
    pub n_epochs: u32,
    /// Adam's step size.
    pub learning_rate: f32,
    /// How the step size changes over the run.
    pub lr_schedule: LearningRateSchedule,
    /// Discount per decision.
    pub gamma: f32,
    /// λ of generalised advantage estimation.
    pub gae_lambda: f32,
    /// Clip range of the probability ratio.
    pub clip_range: f32,
    /// Weight of the entropy bonus.
    pub ent_coef: f32,
    /// Weight of the value loss.
    pub vf_coef: f32,
    /// Largest Euclidean norm of the gradient of a step.
    pub max_grad_norm: f32,
    /// When the reward is paid.
    pub reward: Reward,
    /// The reward is multiplied by this constant before learning; reports show the reward itself.
    pub reward_scale: f32,
    /// Number of updates between two measurements on the validation days; the weights that did best
    /// there are kept.
    pub eval_every: u32,
    /// Number of validation days.
    pub eval_days: u32,
}

impl PpoSettings {
    /// Exactly Table 2. Where the paper gives no value, this is stable-baselines3's default, except
    /// for γ = 1, which a reward at the end of the day requires. The roll-out of 20,000 decisions
    /// is of one environment, as in the public script of the paper's authors.
    pub fn paper() -> Self {
        Self {
            total_steps: 2_000_000,
            n_envs: 1,
            n_steps: 20_000,
            batch_size: 10_000,
            n_epochs: 100,
            learning_rate: 1e-6,
            lr_schedule: LearningRateSchedule::Constant,
            gamma: 1.0,
            gae_lambda: 0.95,
            clip_range: 0.2,
            ent_coef: 0.01,
            vf_coef: 0.5,
            max_grad_norm: 0.5,
            reward: Reward::Terminal,
            reward_scale: 1.0,
            eval_every: 5,
            eval_days: 50,
        }
    }

    /// The default preset, tuned on validation days for the best policy within a quarter of an hour
    /// on two cores.
    pub fn tuned() -> Self {
        Self {
            total_steps: 3_000_000,
            n_envs: 128,
            n_steps: 128,
            batch_size: 2_048,
            n_epochs: 2,
            learning_rate: 4e-4,
            lr_schedule: LearningRateSchedule::Linear,
            gamma: 0.995,
            gae_lambda: 0.95,
            clip_range: 0.2,
            ent_coef: 0.002,
            vf_coef: 0.5,
            max_grad_norm: 0.5,
            reward: Reward::Dense,
            reward_scale: 100.0,
            eval_every: 5,
            eval_days: 100,
        }
    }

    /// Number of decisions per roll-out.
    pub fn buffer_size(&self) -> usize {
        self.n_envs * self.n_steps
    }

    /// Number of updates of the whole run.
    pub fn updates(&self) -> u64 {
        self.total_steps.div_ceil(self.buffer_size() as u64)
    }

    /// The step size of an update, counted from 0.
    pub fn learning_rate_at(&self, update: u64) -> f32 {
        match self.lr_schedule {
            LearningRateSchedule::Constant => self.learning_rate,
            LearningRateSchedule::Linear => {
                self.learning_rate * (1.0 - update as f32 / self.updates() as f32).max(0.0)
            }
        }
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        within("total_steps", self.total_steps as f64, 1.0, 1e12)?;
        within("n_envs", self.n_envs as f64, 1.0, 65_536.0)?;
        within("n_steps", self.n_steps as f64, 1.0, 1e6)?;
        within("n_envs * n_steps", self.buffer_size() as f64, 1.0, 4e6)?;
        within("batch_size", self.batch_size as f64, 1.0, 4e6)?;
        within("n_epochs", f64::from(self.n_epochs), 1.0, 10_000.0)?;
        within("learning_rate", f64::from(self.learning_rate), 0.0, 1.0)?;
        within("gamma", f64::from(self.gamma), 0.0, 1.0)?;
        within("gae_lambda", f64::from(self.gae_lambda), 0.0, 1.0)?;
        within("clip_range", f64::from(self.clip_range), 0.0, 10.0)?;
        within("ent_coef", f64::from(self.ent_coef), 0.0, 10.0)?;
        within("vf_coef", f64::from(self.vf_coef), 0.0, 100.0)?;
        within("max_grad_norm", f64::from(self.max_grad_norm), 1e-9, 1e9)?;
        within("reward_scale", f64::from(self.reward_scale), 1e-9, 1e9)?;
        within("eval_every", f64::from(self.eval_every), 1.0, 1e9)?;
        within("eval_days", f64::from(self.eval_days), 1.0, 100_000.0)
    }
}

#[cfg(test)]
mod tests {
    use super::{PpoSettings, share};

    #[test]
    fn a_day_without_demand_pays_nothing() {
        assert_eq!(share(-10.0, 0.0), 0.0);
    }

    #[test]
    fn the_paper_preset_is_table_2() {
        let paper = PpoSettings::paper();
        assert_eq!(paper.total_steps, 2_000_000);
        assert_eq!((paper.n_envs, paper.n_steps, paper.updates()), (1, 20_000, 100));
        assert_eq!((paper.batch_size, paper.n_epochs), (10_000, 100));
        assert_eq!((paper.learning_rate, paper.ent_coef, paper.vf_coef), (1e-6, 0.01, 0.5));
    }
}
