//! The policies that decide: those of the program, and uploaded weights with names that users
//! chose.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError, Weak};

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;
use vertifleet_core::Scenario;
use vertifleet_learn::Model;
use vertifleet_study::{PolicySource, PolicySpec, ResolveFor, ResolvedPolicy};

use crate::error::Error;
use crate::store::{Kind, Store, StoredPolicy, Uploaded};

/// The number of policies that can be uploaded.
const MOST: usize = 1_000;
/// The policies of the program that can decide on a live day.
const OURS: [&str; 8] =
    ["gcaps-x", "rolling", "prices", "gcaps-full", "greedy", "gcaps", "mlp", "random"];

/// A policy.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct PolicyInfo {
    /// Its name in requests.
    pub(crate) name: String,
    /// Whether it belongs to the program; the others were uploaded.
    pub(crate) is_shipped: bool,
    /// The kind of uploaded weights: `gcaps-x`, `gcaps-full`, `mlp-full`, `gcaps` or `mlp`.
    pub(crate) kind: Option<String>,
    /// SHA-256 of an uploaded weight file.
    pub(crate) weights_sha256: Option<String>,
    /// The network on whose days uploaded weights were trained.
    pub(crate) trained_on: Option<String>,
    /// Number of vertiports that uploaded weights fit; null if any number.
    pub(crate) vertiports: Option<usize>,
}

/// The properties of a weight file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub(crate) struct WeightsInfo {
    /// The kind of the weights: `gcaps-x`, `gcaps-full`, `mlp-full`, `gcaps` or `mlp`.
    pub(crate) kind: String,
    /// SHA-256 of the file.
    pub(crate) weights_sha256: String,
    /// The network on whose days the weights were trained.
    pub(crate) trained_on: String,
    /// Number of vertiports that the weights fit; null if any number.
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

    fn of(name: &str, weights: WeightsInfo) -> Self {
        let WeightsInfo { kind, weights_sha256, trained_on, vertiports } = weights;
        Self {
            name: name.to_owned(),
            is_shipped: false,
            kind: Some(kind),
            weights_sha256: Some(weights_sha256),
            trained_on: Some(trained_on),
            vertiports,
        }
    }
}

impl WeightsInfo {
    fn of(model: &Model) -> Self {
        let header = model.header();
        Self {
            kind: model.kind().to_owned(),
            weights_sha256: model.sha256(),
            trained_on: header.network.clone(),
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
    /// Returns an error if there is no such policy, or if it does not fit the day. Traces cannot be
    /// replayed, since their files are not the client's.
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

    /// The weights that were uploaded under a name, for a study.
    ///
    /// # Errors
    /// Returns [`Error::NotFound`] if there are none.
    pub(crate) async fn source(&self, name: &str) -> Result<PolicySource, Error> {
        let found = self.model(name).await?;
        found.map(PolicySource::Model).ok_or_else(|| Error::not_found("policy", name))
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
        for Uploaded { name, created_ms, description } in self.store.uploaded(Kind::Policy).await? {
            let known = match description {
                Some(known) => Some(known),
                None => self.described(&name, created_ms).await?,
            };
            policies.extend(known.map(|known| PolicyInfo::of(&name, known)));
        }
        Ok(policies)
    }

    /// Reads the weights under a name to describe them, and stores the description. `None` if they
    /// are gone.
    async fn described(&self, name: &str, created_ms: i64) -> Result<Option<WeightsInfo>, Error> {
        let Some(model) = self.model(name).await? else { return Ok(None) };
        let info = WeightsInfo::of(&model);
        self.store.describe(Kind::Policy, name, created_ms, &info).await?;
        Ok(Some(info))
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
        Ok(PolicyInfo::of(name, WeightsInfo::of(&model)))
    }

    /// Stores weights under a name, which means these weights permanently: the log of a day then
    /// names the weights that decided.
    ///
    /// # Errors
    /// Returns an error if the bytes are no weight file, [`Error::BadRequest`] if the name is
    /// invalid or means other weights, and [`Error::TooMuch`].
    pub(crate) async fn put(
        &self,
        name: &str,
        weights: &[u8],
        now_ms: i64,
    ) -> Result<PolicyInfo, Error> {
        check_name(name)?;
        let info = validate(weights)?;
        if self.store.number_of_others(Kind::Policy, name).await? >= MOST {
            return Err(Error::TooMuch { what: "policies", most: MOST as u64 });
        }
        let sha256 = info.weights_sha256.clone();
        let stored = StoredPolicy { name: name.to_owned(), sha256, created_ms: now_ms };
        let there = self.store.add_policy(&stored, weights).await?;
        if there.sha256 != stored.sha256 {
            let rule = format!("policy {name:?} has other weights already: use a new name");
            return Err(Error::BadRequest { rule });
        }
        self.store.describe(Kind::Policy, name, there.created_ms, &info).await?;
        Ok(PolicyInfo::of(name, info))
    }
}

/// Describes weights that are uploaded.
///
/// # Errors
/// Returns an error if the bytes are no weight file.
pub(crate) fn validate(weights: &[u8]) -> Result<WeightsInfo, Error> {
    Ok(WeightsInfo::of(&read(weights, "the weights")?))
}

fn read(weights: &[u8], origin: &str) -> Result<Model, Error> {
    Model::from_bytes(weights, origin).map_err(|error| vertifleet_study::Error::from(error).into())
}

/// Checks that a name is valid for a user's policy. The description has the same rule as a pattern.
fn check_name(name: &str) -> Result<(), Error> {
    let plain =
        |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || matches!(c, '.' | '-' | '_');
    let wrong = |rule: &str| Err(Error::BadRequest { rule: rule.to_owned() });
    // A path that consists of dots would lead elsewhere.
    let begins = name.starts_with(|c| plain(c) && c != '.');
    if !begins || name.len() > 40 || !name.chars().all(plain) {
        return wrong(
            "a policy is called by 1 to 40 letters a-z, digits, dots, dashes and underscores, and a dot is not the first",
        );
    }
    if !PolicySpec::parse(name)?.is_own() {
        return wrong("this is the name of a policy that the program has: use another one");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use sqlx::{AnyPool, query};

    use super::{Policies, PolicyInfo};
    use crate::store::{DATABASE, Location, Store};

    const WEIGHTS: &str =
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../models/any/gcaps-x.safetensors");

    #[tokio::test]
    async fn weights_are_read_once_to_be_listed() {
        let folder = tempfile::tempdir().expect("a folder");
        let location = Location::Folder(folder.path().to_owned());
        let policies = Policies::new(Store::open(&location).await.expect("a store"));
        let weights = std::fs::read(WEIGHTS).expect("the shipped weights");
        let put = policies.put("ours", &weights, 1).await.expect("they are taken");
        let url = format!("sqlite://{}", folder.path().join(DATABASE).display());
        let database = AnyPool::connect(&url).await.expect("the database");
        let run = async |sql: &'static str| {
            query(sql).execute(&database).await.expect("a statement").rows_affected()
        };
        let listed = async || policies.list().await.map(|list| list.into_iter().last());
        let same = |found: Option<PolicyInfo>| {
            let found = found.expect("it is listed");
            (found.name, found.weights_sha256) == ("ours".to_owned(), put.weights_sha256.clone())
        };
        // An older program stored no description, and a description of an older upload does not
        // apply to this one.
        for spoilt in ["DELETE FROM descriptions", "UPDATE descriptions SET created_ms = 0"] {
            assert_eq!(run(spoilt).await, 1, "putting or listing described them");
            assert!(same(listed().await.expect("the weights are there")));
        }
        assert_eq!(run("UPDATE policies SET weights = x'00'").await, 1);
        assert!(same(listed().await.expect("the weights are not read")));
        run("DELETE FROM descriptions").await;
        listed().await.expect_err("the weights are read, and are none");
    }
}
