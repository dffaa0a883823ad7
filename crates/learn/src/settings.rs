//! The settings of a training run, which are those of one of the three ways to learn.

use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::error::Error;
use crate::evolution::EvolutionSettings;
use crate::imitation::ImitationSettings;
use crate::nn::Architecture;
use crate::ppo::PpoSettings;
use crate::run::{RunIdentity, TrainingRequest, TrainingRun};

/// The settings of a training run: those of PPO, which `gcaps` and `mlp` can learn by, or those of
/// imitation or of evolution, which every policy can learn by.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum TrainingSettings {
    /// Proximal policy optimisation.
    Ppo(PpoSettings),
    /// Imitation of roll-outs.
    Imitation(ImitationSettings),
    /// Evolution strategies.
    Evolution(EvolutionSettings),
}

impl TrainingSettings {
    /// The policy's preset with this name: `default` or `evolution`; or, for `gcaps` and `mlp`,
    /// `paper` (Table 2) or `imitation`.
    ///
    /// # Errors
    /// Returns an error if there is no such preset.
    pub fn preset(policy: &Architecture, name: &str) -> Result<Self, Error> {
        // Random networks are of all sizes.
        let share = |usual: f64| if policy.fits_any_size() { usual } else { 0.0 };
        let known = match (policy.learns_by_ppo(), name) {
            (false, "default") | (true, "imitation") => {
                let settings = ImitationSettings::default();
                let random_share = share(settings.random_share);
                Self::Imitation(ImitationSettings { random_share, ..settings })
            }
            (_, "evolution") => {
                let settings = EvolutionSettings::default();
                let random_share = share(settings.random_share);
                Self::Evolution(EvolutionSettings { random_share, ..settings })
            }
            (false, _) => {
                let known = "\"default\" and \"evolution\"";
                return Err(Error::UnknownPreset { name: name.to_owned(), known });
            }
            (true, "default") => Self::Ppo(PpoSettings::tuned()),
            (true, "paper") => Self::Ppo(PpoSettings::paper()),
            (true, _) => {
                let known = "\"default\", \"paper\", \"imitation\" and \"evolution\"";
                return Err(Error::UnknownPreset { name: name.to_owned(), known });
            }
        };
        Ok(known)
    }

    /// Changes settings by name, as `--set name=value` does. If one does not fit, none is changed.
    ///
    /// # Errors
    /// Returns an error if there is no such setting, or if a value does not fit it or the other
    /// settings.
    pub fn set<'a>(
        &mut self,
        pairs: impl IntoIterator<Item = (&'a str, &'a str)>,
    ) -> Result<(), Error> {
        let mut changed = self.clone();
        for (name, value) in pairs {
            changed = match changed {
                Self::Ppo(settings) => Self::Ppo(with_member(&settings, name, value)?),
                Self::Imitation(settings) => Self::Imitation(with_member(&settings, name, value)?),
                Self::Evolution(settings) => Self::Evolution(with_member(&settings, name, value)?),
            };
        }
        changed.check()?;
        *self = changed;
        Ok(())
    }

    /// Parses the settings of a policy's training from a file.
    pub(crate) fn read(policy: &Architecture, value: Value) -> Result<Self, String> {
        // Runs by PPO have no rounds, and only those by evolution have generations.
        let read = if value.get("generations").is_some() {
            serde_json::from_value(value).map(Self::Evolution)
        } else if policy.learns_by_ppo() && value.get("rounds").is_none() {
            serde_json::from_value(value).map(Self::Ppo)
        } else {
            serde_json::from_value(value).map(Self::Imitation)
        };
        let settings = read.map_err(|error| format!("settings: {error}"))?;
        settings.check().map_err(|error| error.to_string())?;
        Ok(settings)
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        match self {
            Self::Ppo(settings) => settings.check(),
            Self::Imitation(settings) => settings.check(),
            Self::Evolution(settings) => settings.check(),
        }
    }

    /// The way to learn.
    pub(crate) fn learner(&self) -> &dyn Learner {
        match self {
            Self::Ppo(settings) => settings,
            Self::Imitation(settings) => settings,
            Self::Evolution(settings) => settings,
        }
    }

    /// Whether there is a setting of this name.
    pub fn has(&self, name: &str) -> bool {
        members(self).contains_key(name)
    }
}

/// A way to learn. Its settings begin a [`TrainingRun`], which makes steps and has a curve with a
/// row for each. A new way is a folder like `ppo/` and a variant of [`TrainingSettings`].
pub(crate) trait Learner {
    /// The first columns of its learning curve, by which the file is recognised.
    fn curve_opening(&self) -> &'static str;

    /// A run before its first step, or one that is resumed from a checkpoint.
    fn begin(
        &self,
        plan: &TrainingRequest,
        identity: RunIdentity,
        from: Option<&Path>,
    ) -> Result<Box<dyn TrainingRun>, Error>;
}

/// Changes the sizes of a policy and the settings of its training by name, as `--set name=value`
/// does. If one does not fit, none is changed.
///
/// # Errors
/// Returns an error if there is no such setting, or if a value does not fit it or the other
/// settings.
pub fn set<'a>(
    policy: &mut Architecture,
    settings: &mut TrainingSettings,
    pairs: impl IntoIterator<Item = (&'a str, &'a str)>,
) -> Result<(), Error> {
    let (mut sized, mut of_training) = (policy.clone(), Vec::new());
    for (name, value) in pairs {
        if !set_size(&mut sized, name, value)? {
            of_training.push((name, value));
        }
    }
    settings.set(of_training)?;
    *policy = sized;
    Ok(())
}

/// Changes a size of a policy; returns false if it has none of this name.
fn set_size(policy: &mut Architecture, name: &str, value: &str) -> Result<bool, Error> {
    let has = |sizes: &Map<String, Value>| sizes.contains_key(name);
    match policy {
        Architecture::Gcaps(sizes)
        | Architecture::GcapsX(sizes)
        | Architecture::GcapsFull(sizes) => {
            let of_graph = members(&sizes.graph);
            if has(&of_graph) {
                sizes.graph = changed(of_graph, name, value)?;
            } else if name == "charge" {
                sizes.charge = value.parse().map_err(|_| Error::BadSetting {
                    name: name.to_owned(),
                    rule: format!("must be true or false, found {value:?}"),
                })?;
            } else if name != "graph" && has(&members(sizes)) {
                *sizes = with_member(sizes, name, value)?;
            } else {
                return Ok(false);
            }
        }
        Architecture::Mlp(sizes) | Architecture::MlpFull(sizes) if has(&members(sizes)) => {
            *sizes = with_member(sizes, name, value)?;
        }
        Architecture::Mlp(_) | Architecture::MlpFull(_) => return Ok(false),
    }
    Ok(true)
}

/// The settings with one of them changed by name.
fn with_member<S: Serialize + DeserializeOwned>(
    settings: &S,
    name: &str,
    value: &str,
) -> Result<S, Error> {
    changed(members(settings), name, value)
}

/// Settings with these members, of which one is changed by name.
fn changed<S: DeserializeOwned>(
    mut members: Map<String, Value>,
    name: &str,
    value: &str,
) -> Result<S, Error> {
    if !members.contains_key(name) {
        let known = members.keys().cloned().collect::<Vec<_>>().join(", ");
        return Err(Error::UnknownSetting { name: name.to_owned(), known });
    }
    // A value is parsed as JSON if that succeeds, and taken as a word otherwise.
    let parsed = serde_json::from_str(value).unwrap_or_else(|_| value.into());
    members.insert(name.to_owned(), parsed);
    serde_json::from_value(members.into())
        .map_err(|error| Error::BadSetting { name: name.to_owned(), rule: error.to_string() })
}

fn members(settings: &impl Serialize) -> Map<String, Value> {
    match serde_json::to_value(settings) {
        Ok(Value::Object(members)) => members,
        other => unreachable!("settings are a JSON object, not {other:?}"),
    }
}

/// The first setting in which two differ, with both values.
pub(crate) fn first_difference(
    own: &impl Serialize,
    other: &impl Serialize,
) -> Option<(String, String, String)> {
    let mut pairs = members(own).into_iter().zip(members(other));
    let differs = pairs.find(|((_, own), (_, other))| own != other);
    differs.map(|((name, own), (_, other))| (name, own.to_string(), other.to_string()))
}

/// Refuses a value outside its bounds.
pub(crate) fn within(name: &str, value: f64, low: f64, high: f64) -> Result<(), Error> {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    let rule = format!("must be from {low} to {high}, found {value}");
    Err(Error::BadSetting { name: name.to_owned(), rule })
}

#[cfg(test)]
mod tests {
    use super::{TrainingSettings, set};
    use crate::nn::{Adjacency, Architecture};
    use vertifleet_core::Coded;

    fn default_of(policy: &str) -> TrainingSettings {
        let policy = Architecture::named(policy).expect("a policy with sizes");
        TrainingSettings::preset(&policy, "default").expect("a preset")
    }

    #[test]
    fn a_setting_changes_by_its_name() {
        let mut settings = default_of("mlp");
        settings.set([("batch_size", "512"), ("reward", "terminal")]).expect("settings");
        let value = serde_json::to_value(&settings).expect("plain data");
        assert_eq!((&value["batch_size"], &value["reward"]), (&512.into(), &"terminal".into()));
        let mut settings = default_of("gcaps-x");
        settings.set([("rounds", "3"), ("rollouts", "5")]).expect("settings");
        let value = serde_json::to_value(&settings).expect("plain data");
        assert_eq!((&value["rounds"], &value["rollouts"]), (&3.into(), &5.into()));
    }

    #[test]
    fn sizes_of_a_policy_change_by_their_names_too() {
        let mut policy = Architecture::named("gcaps-full").expect("a policy with sizes");
        let mut settings = default_of("gcaps-full");
        let pairs = [("width", "32"), ("adjacency", "profit"), ("hops", "1"), ("rounds", "2")];
        set(&mut policy, &mut settings, pairs).expect("sizes and settings");
        let Architecture::GcapsFull(sizes) = &policy else { panic!("{policy:?}") };
        assert_eq!((sizes.width, sizes.graph.hops), (32, 1));
        assert_eq!(sizes.graph.adjacency, Adjacency::Profit);
        let before = (policy.clone(), settings.clone());
        for (name, value) in [("adjacency", "near"), ("width", "-1"), ("graph", "1"), ("wide", "1")]
        {
            set(&mut policy, &mut settings, [("hops", "0"), (name, value)]).expect_err(name);
        }
        assert_eq!((policy, settings), before);
    }

    #[test]
    fn invalid_settings_are_refused_and_change_nothing() {
        let mut settings = default_of("gcaps");
        for (name, value) in
            [("batchsize", "512"), ("batch_size", "-1"), ("gamma", "1.5"), ("reward", "sparse")]
        {
            settings.set([("ent_coef", "0.5"), (name, value)]).expect_err(name);
        }
        assert_eq!(settings, default_of("gcaps"));
    }

    #[test]
    fn a_policy_has_the_presets_of_its_way_to_learn() {
        let policy = Architecture::named("gcaps-x").expect("a policy with sizes");
        let error = TrainingSettings::preset(&policy, "paper").expect_err("PPO's alone");
        assert_eq!(error.code().to_string(), "V301");
    }
}
