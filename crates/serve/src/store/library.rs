//! Uploaded networks and weights of policies in the store, each with a description.
//!
//! A description is the program's answer, as JSON, after it read the network or the weights. It is
//! valid only for that version of the program and until the next upload, so that versions that
//! share a database do not mislead each other. Without one, the service reads the network or the
//! weights again.

use serde::Serialize;
use serde::de::DeserializeOwned;
use sqlx::{AnyConnection, query, query_as, query_scalar};

use super::Store;
use crate::error::Error;

/// The version of the program; only its descriptions are read.
const PROGRAM: &str = env!("CARGO_PKG_VERSION");

/// The kind of an upload.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A network.
    Network,
    /// A policy whose weights were uploaded.
    Policy,
}

/// An upload, without its content.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Uploaded<T> {
    /// Its name.
    pub(crate) name: String,
    /// When it was uploaded, milliseconds of the Unix clock.
    pub(crate) created_ms: i64,
    /// The description by this version of the program, if it has one.
    pub(crate) description: Option<T>,
}

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

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Self::Network => "network",
            Self::Policy => "policy",
        }
    }
}

impl Store {
    /// All uploads of a kind, by their names.
    pub(crate) async fn uploaded<T: DeserializeOwned>(
        &self,
        kind: Kind,
    ) -> Result<Vec<Uploaded<T>>, Error> {
        let select = match kind {
            Kind::Network => {
                "SELECT one.name, one.created_ms, said.description FROM networks AS one
                 LEFT JOIN descriptions AS said ON said.kind = $1 AND said.name = one.name
                 AND said.program = $2 AND said.created_ms = one.created_ms ORDER BY one.name"
            }
            // A policy without weights was deleted; its name stays reserved for them.
            Kind::Policy => {
                "SELECT one.name, one.created_ms, said.description FROM policies AS one
                 LEFT JOIN descriptions AS said ON said.kind = $1 AND said.name = one.name
                 AND said.program = $2 AND said.created_ms = one.created_ms
                 WHERE length(one.weights) > 0 ORDER BY one.name"
            }
        };
        let select = query_as(select).bind(kind.name()).bind(PROGRAM);
        let rows: Vec<(String, i64, Option<String>)> = select.fetch_all(&self.pool).await?;
        let uploaded = |(name, created_ms, description): (_, _, Option<String>)| {
            let description = description.and_then(|text| serde_json::from_str(&text).ok());
            Uploaded { name, created_ms, description }
        };
        Ok(rows.into_iter().map(uploaded).collect())
    }

    /// The number of uploads of a kind with other names.
    pub(crate) async fn number_of_others(&self, kind: Kind, name: &str) -> Result<usize, Error> {
        let select = match kind {
            Kind::Network => "SELECT COUNT(*) FROM networks WHERE name <> $1",
            Kind::Policy => {
                "SELECT COUNT(*) FROM policies WHERE name <> $1 AND length(weights) > 0"
            }
        };
        let count: i64 = query_scalar(select).bind(name).fetch_one(&self.pool).await?;
        Ok(usize::try_from(count).unwrap_or_default())
    }

    /// Stores the description of an upload.
    pub(crate) async fn describe(
        &self,
        kind: Kind,
        name: &str,
        created_ms: i64,
        description: &impl Serialize,
    ) -> Result<(), Error> {
        let mut connection = self.pool.acquire().await?;
        describe(&mut connection, kind, name, created_ms, description).await
    }

    /// Adds a network, or replaces the one with its name.
    pub(crate) async fn put_network(
        &self,
        network: &StoredNetwork,
        description: &impl Serialize,
    ) -> Result<(), Error> {
        let StoredNetwork { name, toml, created_ms } = network;
        let mut transaction = self.pool.begin().await?;
        query(
            "INSERT INTO networks (name, toml, created_ms) VALUES ($1, $2, $3)
             ON CONFLICT (name) DO UPDATE SET toml = excluded.toml, created_ms = excluded.created_ms",
        )
        .bind(name)
        .bind(toml)
        .bind(created_ms)
        .execute(&mut *transaction)
        .await?;
        describe(&mut transaction, Kind::Network, name, *created_ms, description).await?;
        Ok(transaction.commit().await?)
    }

    /// The network with a name.
    pub(crate) async fn network(&self, name: &str) -> Result<Option<StoredNetwork>, Error> {
        let select = "SELECT name, toml, created_ms FROM networks WHERE name = $1";
        let row = query_as(select).bind(name).fetch_optional(&self.pool).await?;
        Ok(row.map(|(name, toml, created_ms)| StoredNetwork { name, toml, created_ms }))
    }

    /// Removes a network. Returns whether there was one.
    pub(crate) async fn delete_network(&self, name: &str) -> Result<bool, Error> {
        let delete = query("DELETE FROM networks WHERE name = $1").bind(name);
        let is_deleted = delete.execute(&self.pool).await?.rows_affected() > 0;
        self.forget_descriptions(Kind::Network, name).await?;
        Ok(is_deleted)
    }

    /// Adds a policy unless other weights have ever had its name. Returns the weights that have the
    /// name.
    pub(crate) async fn add_policy(
        &self,
        policy: &StoredPolicy,
        weights: &[u8],
    ) -> Result<StoredPolicy, Error> {
        query(
            "INSERT INTO policies (name, weights, sha256, created_ms) VALUES ($1, $2, $3, $4)
             ON CONFLICT (name) DO UPDATE SET weights = excluded.weights
             WHERE policies.sha256 = excluded.sha256",
        )
        .bind(&policy.name)
        .bind(weights)
        .bind(&policy.sha256)
        .bind(policy.created_ms)
        .execute(&self.pool)
        .await?;
        let select = "SELECT name, sha256, created_ms FROM policies WHERE name = $1";
        let row = query_as(select).bind(&policy.name).fetch_one(&self.pool).await?;
        Ok(stored_policy(row))
    }

    /// The policy with a name.
    pub(crate) async fn policy(&self, name: &str) -> Result<Option<StoredPolicy>, Error> {
        let select = "SELECT name, sha256, created_ms FROM policies
             WHERE name = $1 AND length(weights) > 0";
        let row = query_as(select).bind(name).fetch_optional(&self.pool).await?;
        Ok(row.map(stored_policy))
    }

    /// The weight file of a policy.
    pub(crate) async fn weights(&self, name: &str) -> Result<Option<Vec<u8>>, Error> {
        let select = "SELECT weights FROM policies WHERE name = $1 AND length(weights) > 0";
        Ok(query_scalar(select).bind(name).fetch_optional(&self.pool).await?)
    }

    /// Removes the weights of a policy. Its name stays reserved for them, since logs of days
    /// contain it. Returns whether there was one.
    ///
    /// # Errors
    /// Returns [`Error::PolicyInUse`] if it decides on days that are not archived.
    pub(crate) async fn delete_policy(&self, name: &str) -> Result<bool, Error> {
        let select = "SELECT COUNT(*) FROM days WHERE policy = $1 AND archived = 0";
        let days: i64 = query_scalar(select).bind(name).fetch_one(&self.pool).await?;
        if days > 0 {
            return Err(Error::PolicyInUse { name: name.to_owned(), days });
        }
        let delete = "UPDATE policies SET weights = $2 WHERE name = $1 AND length(weights) > 0";
        let delete = query(delete).bind(name).bind(&[][..] as &[u8]);
        let is_deleted = delete.execute(&self.pool).await?.rows_affected() > 0;
        self.forget_descriptions(Kind::Policy, name).await?;
        Ok(is_deleted)
    }

    /// Frees space: descriptions of removed uploads are never read.
    async fn forget_descriptions(&self, kind: Kind, name: &str) -> Result<(), Error> {
        let delete = "DELETE FROM descriptions WHERE kind = $1 AND name = $2";
        query(delete).bind(kind.name()).bind(name).execute(&self.pool).await?;
        Ok(())
    }
}

async fn describe(
    connection: &mut AnyConnection,
    kind: Kind,
    name: &str,
    created_ms: i64,
    description: &impl Serialize,
) -> Result<(), Error> {
    let description = serde_json::to_string(description).expect("plain data can be written");
    query(
        "INSERT INTO descriptions (kind, name, program, created_ms, description)
         VALUES ($1, $2, $3, $4, $5)
         ON CONFLICT (kind, name, program)
         DO UPDATE SET created_ms = excluded.created_ms, description = excluded.description",
    )
    .bind(kind.name())
    .bind(name)
    .bind(PROGRAM)
    .bind(created_ms)
    .bind(description)
    .execute(connection)
    .await?;
    Ok(())
}

fn stored_policy((name, sha256, created_ms): (String, String, i64)) -> StoredPolicy {
    StoredPolicy { name, sha256, created_ms }
}
