//! Networks and weights of policies that were uploaded, in the store.

use sqlx::any::AnyRow;
use sqlx::{Row as _, query, query_scalar};

use super::Store;
use crate::error::Error;

/// A network that was uploaded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct StoredNetwork {
    /// Its name.
    pub(crate) name: String,
    /// Its text.
    pub(crate) toml: String,
    /// When it was uploaded, milliseconds of the Unix clock.
    pub(crate) created_ms: i64,
}

/// A policy whose weights were uploaded, without them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct StoredPolicy {
    /// Its name.
    pub(crate) name: String,
    /// SHA-256 of its weight file.
    pub(crate) sha256: String,
    /// When it was uploaded, milliseconds of the Unix clock.
    pub(crate) created_ms: i64,
}

impl Store {
    /// Adds a network, or puts it in the place of the one with its name.
    pub(crate) async fn put_network(&self, network: &StoredNetwork) -> Result<(), Error> {
        query(
            "INSERT INTO networks (name, toml, created_ms) VALUES ($1, $2, $3)
             ON CONFLICT (name) DO UPDATE SET toml = excluded.toml, created_ms = excluded.created_ms",
        )
        .bind(&network.name)
        .bind(&network.toml)
        .bind(network.created_ms)
        .execute(self.pool())
        .await?;
        Ok(())
    }

    /// All networks that were uploaded, by their names.
    pub(crate) async fn networks(&self) -> Result<Vec<StoredNetwork>, Error> {
        let select = "SELECT name, toml, created_ms FROM networks ORDER BY name";
        let rows = query(select).fetch_all(self.pool()).await?;
        rows.iter().map(stored_network).collect()
    }

    /// The network with a name.
    pub(crate) async fn network(&self, name: &str) -> Result<Option<StoredNetwork>, Error> {
        let select = "SELECT name, toml, created_ms FROM networks WHERE name = $1";
        let row = query(select).bind(name).fetch_optional(self.pool()).await?;
        row.as_ref().map(stored_network).transpose()
    }

    /// Removes a network. Returns whether there was one.
    pub(crate) async fn delete_network(&self, name: &str) -> Result<bool, Error> {
        let delete = query("DELETE FROM networks WHERE name = $1").bind(name);
        Ok(delete.execute(self.pool()).await?.rows_affected() > 0)
    }

    /// Adds a policy unless there is one with its name. Returns the one that is there then.
    pub(crate) async fn add_policy(
        &self,
        policy: &StoredPolicy,
        weights: &[u8],
    ) -> Result<StoredPolicy, Error> {
        query(
            "INSERT INTO policies (name, weights, sha256, created_ms) VALUES ($1, $2, $3, $4)
             ON CONFLICT (name) DO NOTHING",
        )
        .bind(&policy.name)
        .bind(weights)
        .bind(&policy.sha256)
        .bind(policy.created_ms)
        .execute(self.pool())
        .await?;
        let found = self.policy(&policy.name).await?;
        found.ok_or_else(|| Error::not_found("policy", &policy.name))
    }

    /// All policies that were uploaded, by their names.
    pub(crate) async fn policies(&self) -> Result<Vec<StoredPolicy>, Error> {
        let select = "SELECT name, sha256, created_ms FROM policies ORDER BY name";
        let rows = query(select).fetch_all(self.pool()).await?;
        rows.iter().map(stored_policy).collect()
    }

    /// The policy with a name.
    pub(crate) async fn policy(&self, name: &str) -> Result<Option<StoredPolicy>, Error> {
        let select = "SELECT name, sha256, created_ms FROM policies WHERE name = $1";
        let row = query(select).bind(name).fetch_optional(self.pool()).await?;
        row.as_ref().map(stored_policy).transpose()
    }

    /// The weight file of a policy.
    pub(crate) async fn weights(&self, name: &str) -> Result<Option<Vec<u8>>, Error> {
        let select = query_scalar("SELECT weights FROM policies WHERE name = $1").bind(name);
        Ok(select.fetch_optional(self.pool()).await?)
    }

    /// Removes a policy. Returns whether there was one.
    pub(crate) async fn delete_policy(&self, name: &str) -> Result<bool, Error> {
        let delete = query("DELETE FROM policies WHERE name = $1").bind(name);
        Ok(delete.execute(self.pool()).await?.rows_affected() > 0)
    }
}

fn stored_network(row: &AnyRow) -> Result<StoredNetwork, Error> {
    Ok(StoredNetwork {
        name: row.try_get("name")?,
        toml: row.try_get("toml")?,
        created_ms: row.try_get("created_ms")?,
    })
}

fn stored_policy(row: &AnyRow) -> Result<StoredPolicy, Error> {
    Ok(StoredPolicy {
        name: row.try_get("name")?,
        sha256: row.try_get("sha256")?,
        created_ms: row.try_get("created_ms")?,
    })
}
