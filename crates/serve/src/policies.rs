//! The policies that decide: those that the program has, and weights that were uploaded under names of their own.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError, Weak};

use serde::Serialize;
use utoipa::ToSchema;
use vertifleet_core::Scenario;
use vertifleet_learn::Model;
use vertifleet_study::{PolicySource, PolicySpec, ResolveFor, ResolvedPolicy};

use crate::error::Error;
use crate::store::{Store, StoredPolicy};

/// The number of policies that can be uploaded.
const MOST: usize = 1_000;
/// The policies that the program has and that decide on a day that happens.
const OURS: [&str; 8] =
    ["gcaps-x", "rolling", "prices", "greedy", "lookahead", "gcaps", "mlp", "random"];

/// A policy.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct PolicyInfo {
    /// The name by which requests ask for it.
    pub(crate) name: String,
    /// Whether the program has it; the others were uploaded.
    pub(crate) is_shipped: bool,
    /// What decides by uploaded weights: `gcaps-x`, `gcaps` or `mlp`.
    pub(crate) kind: Option<String>,
    /// SHA-256 of an uploaded weight file.
    pub(crate) weights_sha256: Option<String>,
    /// The network on whose days uploaded weights were trained.
    pub(crate) trained_on: Option<String>,
    /// Number of vertiports that uploaded weights fit; null if any number.
    pub(crate) vertiports: Option<usize>,
}

/// Finds policies. Weights that several days use are in memory once.
#[derive(Debug)]
pub(crate) struct Policies {
    store: Store,
    /// By SHA-256.
    models: Mutex<HashMap<String, Weak<Model>>>,
}

impl PolicyInfo {
    fn ours(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            is_shipped: true,
            kind: None,
            weights_sha256: None,
            trained_on: None,
            vertiports: None,
        }
    }

    fn of(name: &str, model: &Model) -> Self {
        let header = model.header();
        Self {
            name: name.to_owned(),
            is_shipped: false,
            kind: Some(model.kind().to_owned()),
            weights_sha256: Some(model.sha256()),
            trained_on: Some(header.network.clone()),
            vertiports: header.shape.vertiports,
        }
    }
}

impl Policies {
    /// The policies of a store.
    pub(crate) fn new(store: Store) -> Self {
        Self { store, models: Mutex::default() }
    }

    /// The policy with a name, for a day.
    ///
    /// # Errors
    /// Returns an error if there is no such policy, or if it does not fit the day. Traces cannot be replayed, since their
    /// files are not the client's.
    pub(crate) async fn resolve(
        &self,
        name: &str,
        day: &Scenario,
    ) -> Result<ResolvedPolicy, Error> {
        let spec = PolicySpec::parse(name)?;
        if spec.replayed().is_some() {
            return Err(Error::not_found("policy", name));
        }
        let model = if spec.is_own() {
            let found = self.model(name).await?;
            Some(found.ok_or_else(|| Error::not_found("policy", name))?)
        } else {
            None
        };
        let source = model.map(PolicySource::Model);
        let resolved = spec.resolve(source.as_ref(), ResolveFor::Day(day), day.seed)?;
        resolved.check_fits(day)?;
        Ok(resolved)
    }

    /// The weights that were uploaded under a name.
    async fn model(&self, name: &str) -> Result<Option<Arc<Model>>, Error> {
        let Some(StoredPolicy { sha256, .. }) = self.store.policy(name).await? else {
            return Ok(None);
        };
        let known = self.lock().get(&sha256).and_then(Weak::upgrade);
        if known.is_some() {
            return Ok(known);
        }
        let Some(weights) = self.store.weights(name).await? else { return Ok(None) };
        let model = Arc::new(read(&weights, name)?);
        let mut models = self.lock();
        models.retain(|_, model| model.strong_count() > 0);
        models.insert(sha256, Arc::downgrade(&model));
        Ok(Some(model))
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, HashMap<String, Weak<Model>>> {
        self.models.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// All policies: those that the program has, then those that were uploaded.
    ///
    /// # Errors
    /// Returns [`Error::Store`] if they cannot be read.
    pub(crate) async fn list(&self) -> Result<Vec<PolicyInfo>, Error> {
        let mut policies: Vec<PolicyInfo> = OURS.into_iter().map(PolicyInfo::ours).collect();
        for StoredPolicy { name, .. } in self.store.policies().await? {
            if let Some(model) = self.model(&name).await? {
                policies.push(PolicyInfo::of(&name, &model));
            }
        }
        Ok(policies)
    }

    /// Describes a policy.
    ///
    /// # Errors
    /// Returns [`Error::NotFound`] if there is none.
    pub(crate) async fn info(&self, name: &str) -> Result<PolicyInfo, Error> {
        if OURS.contains(&name) {
            return Ok(PolicyInfo::ours(name));
        }
        let model = self.model(name).await?.ok_or_else(|| Error::not_found("policy", name))?;
        Ok(PolicyInfo::of(name, &model))
    }

    /// Keeps weights under a name, which means these weights for good: whoever reads the name in the log of a day knows
    /// what decided.
    ///
    /// # Errors
    /// Returns an error if the bytes are no weight file, [`Error::BadRequest`] if the name is not one of your own or means
    /// other weights, and [`Error::TooMuch`].
    pub(crate) async fn put(
        &self,
        name: &str,
        weights: &[u8],
        now_ms: i64,
    ) -> Result<PolicyInfo, Error> {
        check_name(name)?;
        let info = validate(name, weights)?;
        let known = self.store.policies().await?;
        if known.len() >= MOST && !known.iter().any(|known| known.name == name) {
            return Err(Error::TooMuch { what: "policies", most: MOST as u64 });
        }
        let sha256 = info.weights_sha256.clone().unwrap_or_default();
        let stored = StoredPolicy { name: name.to_owned(), sha256, created_ms: now_ms };
        let there = self.store.add_policy(&stored, weights).await?;
        if there.sha256 != stored.sha256 {
            let rule = format!("policy {name:?} has other weights already: use a new name");
            return Err(Error::BadRequest { rule });
        }
        Ok(info)
    }
}

/// Describes weights that somebody brings.
///
/// # Errors
/// Returns an error if the bytes are no weight file.
pub(crate) fn validate(name: &str, weights: &[u8]) -> Result<PolicyInfo, Error> {
    Ok(PolicyInfo::of(name, &read(weights, "the weights")?))
}

fn read(weights: &[u8], origin: &str) -> Result<Model, Error> {
    Model::from_bytes(weights, origin).map_err(|error| vertifleet_study::Error::from(error).into())
}

/// Checks that a name can be one of the user's own.
fn check_name(name: &str) -> Result<(), Error> {
    let plain =
        |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || matches!(c, '.' | '-' | '_');
    let wrong = |rule: &str| Err(Error::BadRequest { rule: rule.to_owned() });
    if !(1..=40).contains(&name.len()) || !name.chars().all(plain) {
        return wrong(
            "a policy is called by 1 to 40 letters a-z, digits, dots, dashes and underscores",
        );
    }
    if !PolicySpec::parse(name)?.is_own() {
        return wrong("this is the name of a policy that the program has: use another one");
    }
    Ok(())
}
