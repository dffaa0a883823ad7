//! Tokens in the store, as hashes, and the audit of actions other than events of days.

use serde::Serialize;
use sqlx::any::AnyRow;
use sqlx::{AnyConnection, Row as _, query, query_as};

use super::Store;
use crate::error::Error;
use crate::tokens::{Role, StoredToken};

/// An action other than an event of a day.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct AuditRecord {
    /// When, milliseconds of the Unix clock.
    pub at_ms: i64,
    /// The name of the token of the request; empty without tokens, and for actions at the machine.
    pub actor: String,
    /// The action, for example `day deleted`.
    pub action: String,
    /// The id or the name of its target.
    pub target: String,
}

impl Store {
    /// Adds a token, unless one with this name exists or existed.
    ///
    /// # Errors
    /// Returns [`Error::Conflict`] if the name was given before, and [`Error::Store`].
    pub(crate) async fn add_token(&self, token: &StoredToken) -> Result<(), Error> {
        let done = query(
            "INSERT INTO tokens (id, name, role, hash, created_ms, revoked_ms)
             SELECT CAST($1 AS TEXT), CAST($2 AS TEXT), CAST($3 AS TEXT), CAST($4 AS TEXT),
                 CAST($5 AS BIGINT), 0
             WHERE NOT EXISTS (SELECT 1 FROM tokens WHERE name = $2)",
        )
        .bind(&token.id)
        .bind(&token.name)
        .bind(token.role.name())
        .bind(&token.hash)
        .bind(token.created_ms)
        .execute(&self.pool)
        .await?;
        if done.rows_affected() == 0 { Err(Error::Conflict) } else { Ok(()) }
    }

    /// All tokens, including revoked ones.
    pub(crate) async fn tokens(&self) -> Result<Vec<StoredToken>, Error> {
        let select = "SELECT id, name, role, hash, created_ms, revoked_ms FROM tokens ORDER BY created_ms, id";
        let select = query(select).fetch_all(&self.pool);
        let rows = self.in_time(select).await?;
        rows.iter().map(stored_token).collect()
    }

    /// The actions other than events of days, in order.
    pub(crate) async fn audit(&self) -> Result<Vec<AuditRecord>, Error> {
        let select = "SELECT at_ms, actor, action, target FROM audit ORDER BY at_ms";
        let rows = query_as(select).fetch_all(&self.pool).await?;
        let record = |(at_ms, actor, action, target)| AuditRecord { at_ms, actor, action, target };
        Ok(rows.into_iter().map(record).collect())
    }

    /// Revokes a token. Returns whether there was such a token in force.
    pub(crate) async fn revoke_token(&self, id: &str, now_ms: i64) -> Result<bool, Error> {
        let update = "UPDATE tokens SET revoked_ms = $2 WHERE id = $1 AND revoked_ms = 0";
        let done = query(update).bind(id).bind(now_ms).execute(&self.pool).await?;
        Ok(done.rows_affected() > 0)
    }

    /// Records an action other than an event of a day.
    pub(crate) async fn record(
        &self,
        actor: &str,
        action: &str,
        target: &str,
        at_ms: i64,
    ) -> Result<(), Error> {
        let mut connection = self.pool.acquire().await?;
        record(&mut connection, actor, action, target, at_ms).await
    }
}

/// Records an action in the transaction that performs it, so that neither exists without the other.
pub(super) async fn record(
    connection: &mut AnyConnection,
    actor: &str,
    action: &str,
    target: &str,
    at_ms: i64,
) -> Result<(), Error> {
    query("INSERT INTO audit (at_ms, actor, action, target) VALUES ($1, $2, $3, $4)")
        .bind(at_ms)
        .bind(actor)
        .bind(action)
        .bind(target)
        .execute(connection)
        .await?;
    Ok(())
}

fn stored_token(row: &AnyRow) -> Result<StoredToken, Error> {
    let role: String = row.try_get("role")?;
    let bad = || Error::BadData { rule: format!("a token with the role {role:?}") };
    Ok(StoredToken {
        id: row.try_get("id")?,
        name: row.try_get("name")?,
        role: Role::named(&role).ok_or_else(bad)?,
        hash: row.try_get("hash")?,
        created_ms: row.try_get("created_ms")?,
        revoked_ms: row.try_get("revoked_ms")?,
    })
}
