//! Notices between services that share a `PostgreSQL` database: which days have changed (LISTEN and
//! NOTIFY). Notices can be lost, so they only save time.

use std::str::FromStr as _;
use std::time::Duration;

use sqlx::postgres::{PgConnectOptions, PgListener, PgPoolOptions};
use sqlx::{Any, AssertSqlSafe, Transaction, query};

use super::Store;
use super::server::TIMEOUT;
use crate::error::Error;

/// The channel of the database.
const CHANNEL: &str = "vertifleet_days";

/// A change of a day.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct DayNotice {
    /// The id of the day.
    pub(crate) day: String,
    /// The number of its latest event; `None` if it was archived, reopened or deleted.
    pub(crate) seq: Option<u64>,
}

impl DayNotice {
    /// A day that was archived, reopened or deleted.
    pub(super) fn changed(day: &str) -> Self {
        Self { day: day.to_owned(), seq: None }
    }

    fn read(text: &str) -> Option<Self> {
        let (seq, day) = text.split_once(' ')?;
        let seq = if seq == "-" { None } else { Some(seq.parse().ok()?) };
        Some(Self { day: day.to_owned(), seq })
    }

    fn write(&self) -> String {
        match self.seq {
            Some(seq) => format!("{seq} {}", self.day),
            None => format!("- {}", self.day),
        }
    }
}

/// Receives the notices of all services, including its own.
pub(crate) struct Listener(PgListener);

impl Listener {
    /// The next notice; `None` if notices may have been lost, because the connection broke or none
    /// has arrived for `patience`.
    ///
    /// # Errors
    /// Returns [`Error::Store`] if the database cannot be reached.
    pub(crate) async fn next(&mut self, patience: Duration) -> Result<Option<DayNotice>, Error> {
        match tokio::time::timeout(patience, self.0.try_recv()).await {
            Ok(heard) => Ok(heard?.and_then(|notice| DayNotice::read(notice.payload()))),
            Err(_) => Ok(None),
        }
    }
}

impl Store {
    /// Notifies other services that use the store, once the transaction is committed.
    pub(super) async fn notify(
        &self,
        transaction: &mut Transaction<'_, Any>,
        notices: &[DayNotice],
    ) -> Result<(), Error> {
        if !self.is_shared() || notices.is_empty() {
            return Ok(());
        }
        let calls: Vec<String> =
            (1..=notices.len()).map(|place| format!("('{CHANNEL}', ${place})")).collect();
        let values = calls.join(", ");
        let notify = format!(
            "SELECT 1 FROM (VALUES {values}) AS new, LATERAL pg_notify(new.column1, new.column2)"
        );
        let notify = query(AssertSqlSafe(notify));
        let notify = notices.iter().fold(notify, |query, notice| query.bind(notice.write()));
        notify.execute(&mut **transaction).await?;
        Ok(())
    }

    /// A connection that receives the notices of services; `None` if the store has one service.
    ///
    /// # Errors
    /// Returns [`Error::Store`] if the database cannot be reached.
    pub(crate) async fn listener(&self) -> Result<Option<Listener>, Error> {
        let Some(server) = &self.server else { return Ok(None) };
        let pool = PgPoolOptions::new()
            .max_connections(1)
            .acquire_timeout(TIMEOUT)
            .connect_with(PgConnectOptions::from_str(&server.url)?)
            .await?;
        let mut listener = PgListener::connect_with(&pool).await?;
        listener.ignore_pool_close_event(true);
        listener.listen(CHANNEL).await?;
        Ok(Some(Listener(listener)))
    }
}
