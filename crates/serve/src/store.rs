//! The store: days and their events in `SQLite` or `PostgreSQL`, through one set of statements.
//!
//! Rows of events are only ever added. Each has a checksum over itself and the row before, so that
//! the service detects a row that is missing, changed or torn when it reads the day.

mod append;
mod events;
mod heads;
mod library;
mod notices;
mod open;
mod server;
mod tokens;

use std::path::PathBuf;

use serde::{Deserialize, Serialize};
use sqlx::any::AnyRow;
use sqlx::{Any, AnyPool, Row as _, Transaction, query, query_as, query_scalar};

pub(crate) use self::append::{AppendId, NewEvent};
pub(crate) use self::events::{PAGE, Page};
pub(crate) use self::heads::Head;
pub(crate) use self::library::{Kind, StoredNetwork, StoredPolicy, Uploaded};
pub(crate) use self::notices::DayNotice;
pub(crate) use self::open::make_folder;
use self::server::Server;
pub use self::tokens::AuditRecord;
use crate::clock::now_ms;
use crate::error::Error;

/// The name of the database in the folder of the data.
pub(crate) const DATABASE: &str = "vertifleet.db";
/// The version of the tables and events. A store of a newer version is refused.
const VERSION: &str = "6";

/// The location of the data.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Location {
    /// An `SQLite` database in a folder, which is created if it does not exist.
    Folder(PathBuf),
    /// A `PostgreSQL` database.
    Postgres(String),
}

/// The open store.
#[derive(Debug, Clone)]
pub(crate) struct Store {
    pool: AnyPool,
    /// The server of the database, if other processes may use it too.
    server: Option<Server>,
}

/// A day as it is stored, without its scenario.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct StoredDay {
    /// Its id.
    pub(crate) id: String,
    /// The name of its scenario.
    pub(crate) name: String,
    /// When it was made, milliseconds of the Unix clock.
    pub(crate) created_ms: i64,
    /// Whether it is closed to writes.
    pub(crate) archived: bool,
    /// The default policy of its decisions.
    pub(crate) policy: String,
    /// Its date (`2026-11-23`), or empty.
    pub(crate) date: String,
    /// The time zone of its clock by its name in the IANA database; empty without a date.
    pub(crate) time_zone: String,
}

/// A stored answer, for a request that is repeated with its key.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct StoredAnswer {
    /// The key.
    pub(crate) key: String,
    /// The checksum of the request.
    pub(crate) request: String,
    /// The answer as JSON.
    pub(crate) answer: String,
}

/// Stands for the checksum of a day that an earlier version of the program made.
const NO_SUM: i64 = -1;

impl StoredDay {
    /// The checksum over the parts of a day that never change.
    fn sum(&self, scenario: &str) -> i64 {
        let Self { id, name, created_ms, archived: _, policy, date, time_zone } = self;
        let sum = crc32c::crc32c(&created_ms.to_le_bytes());
        let add = |sum, text: &str| {
            let sum = crc32c::crc32c_append(sum, &(text.len() as u64).to_le_bytes());
            crc32c::crc32c_append(sum, text.as_bytes())
        };
        let texts = [id, name, policy, date, time_zone].map(String::as_str);
        texts.into_iter().chain([scenario]).fold(sum, add).into()
    }
}

impl Store {
    /// Closes all connections. `SQLite` then moves its log into the database.
    pub(crate) async fn close(&self) {
        self.pool.close().await;
    }

    /// Whether other processes may use it too.
    pub(crate) fn is_shared(&self) -> bool {
        self.server.is_some()
    }

    /// Adds a day.
    pub(crate) async fn add_day(
        &self,
        day: &StoredDay,
        scenario: &str,
        answer: Option<&StoredAnswer>,
    ) -> Result<(), Error> {
        let add = async {
            let mut transaction = self.pool.begin().await?;
            query("INSERT INTO scenarios (day, scenario) VALUES ($1, $2)")
                .bind(&day.id)
                .bind(scenario)
                .execute(&mut *transaction)
                .await?;
            query(
                "INSERT INTO days (id, name, created_ms, archived, policy, date, time_zone, sum)
             VALUES ($1, $2, $3, $4, $5, $6, $7, $8)",
            )
            .bind(&day.id)
            .bind(&day.name)
            .bind(day.created_ms)
            .bind(i64::from(day.archived))
            .bind(&day.policy)
            .bind(&day.date)
            .bind(&day.time_zone)
            .bind(day.sum(scenario))
            .execute(&mut *transaction)
            .await?;
            if let Some(answer) = answer {
                self.insert_answers(&mut transaction, &[answer], day.created_ms).await?;
            }
            Ok::<_, Error>(transaction.commit().await?)
        };
        self.in_time(add).await
    }

    /// The days after `after`, in the order of their ids.
    pub(crate) async fn days(&self, after: &str, limit: u32) -> Result<Vec<StoredDay>, Error> {
        let select = query(
            "SELECT id, name, created_ms, archived, policy, date, time_zone FROM days WHERE id > $1
             ORDER BY id LIMIT $2",
        );
        let select = select.bind(after).bind(i64::from(limit)).fetch_all(&self.pool);
        let rows = self.in_time(select).await?;
        rows.iter().map(stored_day).collect()
    }

    /// A day and its scenario.
    ///
    /// # Errors
    /// Returns [`Error::BadData`] if they have changed since they were stored.
    pub(crate) async fn day(&self, id: &str) -> Result<Option<(StoredDay, String)>, Error> {
        let select = query(
            "SELECT id, name, created_ms, archived, policy, date, time_zone, scenario, sum FROM days
             JOIN scenarios ON scenarios.day = days.id WHERE id = $1",
        );
        let select = select.bind(id).fetch_optional(&self.pool);
        let row = self.in_time(select).await?;
        let Some(row) = row else { return Ok(None) };
        let (day, scenario): (_, String) = (stored_day(&row)?, row.try_get("scenario")?);
        let sum: i64 = row.try_get("sum")?;
        if sum != NO_SUM && sum != day.sum(&scenario) {
            let rule = "what the day began with was changed".to_owned();
            return Err(Error::BadData { rule });
        }
        Ok(Some((day, scenario)))
    }

    /// The number of days.
    pub(crate) async fn number_of_days(&self) -> Result<u64, Error> {
        let count = query_scalar("SELECT COUNT(*) FROM days").fetch_one(&self.pool);
        self.in_time(count).await.map(as_u64)
    }

    /// Archives a day or reopens it, if it is at the expected event.
    ///
    /// # Errors
    /// Returns [`Error::NotFound`] if there is no such day, and [`Error::Moved`] if it is at
    /// another event.
    pub(crate) async fn set_archived(
        &self,
        id: &str,
        archived: bool,
        expected: Option<u64>,
        actor: &str,
    ) -> Result<(), Error> {
        let change = async {
            let mut transaction = self.pool.begin().await?;
            let update = "UPDATE days SET archived = $2 WHERE id = $1 RETURNING seq";
            let update = query_scalar(update).bind(id).bind(i64::from(archived));
            check_at(id, update.fetch_optional(&mut *transaction).await?, expected)?;
            let done = if archived { "day archived" } else { "day unarchived" };
            self.commit_change(transaction, id, (actor, done)).await
        };
        self.in_time(change).await
    }

    /// Removes a day with its events, if it is at the expected event.
    ///
    /// # Errors
    /// Returns [`Error::NotFound`] if there is no such day, and [`Error::Moved`] if it is at
    /// another event.
    pub(crate) async fn delete(
        &self,
        id: &str,
        expected: Option<u64>,
        actor: &str,
    ) -> Result<(), Error> {
        let change = async {
            let mut transaction = self.pool.begin().await?;
            let delete = query_scalar("DELETE FROM days WHERE id = $1 RETURNING seq").bind(id);
            check_at(id, delete.fetch_optional(&mut *transaction).await?, expected)?;
            for delete in
                ["DELETE FROM scenarios WHERE day = $1", "DELETE FROM events WHERE day = $1"]
            {
                query(delete).bind(id).execute(&mut *transaction).await?;
            }
            self.commit_change(transaction, id, (actor, "day deleted")).await
        };
        self.in_time(change).await
    }

    /// Records who changed a day, and commits the change.
    async fn commit_change(
        &self,
        mut transaction: Transaction<'_, Any>,
        id: &str,
        (actor, done): (&str, &str),
    ) -> Result<(), Error> {
        tokens::record(&mut transaction, actor, done, id, now_ms()).await?;
        self.notify(&mut transaction, &[DayNotice::changed(id)]).await?;
        Ok(transaction.commit().await?)
    }

    /// The answer that was given to a request with this key.
    pub(crate) async fn answer(&self, key: &str) -> Result<Option<StoredAnswer>, Error> {
        let select = query_as("SELECT request, answer FROM answers WHERE idempotency_key = $1");
        let select = select.bind(key).fetch_optional(&self.pool);
        let row: Option<(String, String)> = self.in_time(select).await?;
        let stored = |(request, answer)| StoredAnswer { key: key.to_owned(), request, answer };
        Ok(row.map(stored))
    }

    /// All keys that requests have used; `None` if other processes may use keys too.
    pub(crate) async fn keys(&self) -> Result<Option<Vec<String>>, Error> {
        if self.is_shared() {
            return Ok(None);
        }
        let keys = query_scalar("SELECT idempotency_key FROM answers").fetch_all(&self.pool);
        Ok(Some(keys.await?))
    }

    /// Writes a copy of everything to a new file. `SQLite` alone can do that.
    pub(crate) async fn copy_to(&self, file: &str) -> Result<(), Error> {
        query("VACUUM INTO $1").bind(file).execute(&self.pool).await?;
        Ok(())
    }

    /// Checks that the store can be written to, by a write that changes nothing.
    ///
    /// # Errors
    /// Returns [`Error::Store`] if it does not.
    pub(crate) async fn check(&self) -> Result<(), Error> {
        // The same value as before, whichever it is: a newer program may have brought the store up
        // to date by now.
        let update = query("UPDATE meta SET value = value WHERE name = 'version'");
        self.in_time(update.execute(&self.pool)).await.map(drop)
    }
}

/// Checks that a day was there, which a transaction has just changed, and that its latest event is
/// the one that is expected. No event can be added until the transaction ends.
fn check_at(id: &str, latest: Option<i64>, expected: Option<u64>) -> Result<(), Error> {
    let found = as_u64(latest.ok_or_else(|| Error::not_found("day", id))?);
    match expected {
        Some(expected) if expected != found => Err(Error::Moved { expected, found }),
        _ => Ok(()),
    }
}

fn as_i64(seq: u64) -> i64 {
    i64::try_from(seq).unwrap_or(i64::MAX)
}

fn as_u64(seq: i64) -> u64 {
    u64::try_from(seq).unwrap_or_default()
}

fn stored_day(row: &AnyRow) -> Result<StoredDay, Error> {
    Ok(StoredDay {
        id: row.try_get("id")?,
        name: row.try_get("name")?,
        created_ms: row.try_get("created_ms")?,
        archived: row.try_get::<i64, _>("archived")? != 0,
        policy: row.try_get("policy")?,
        date: row.try_get("date")?,
        time_zone: row.try_get("time_zone")?,
    })
}
