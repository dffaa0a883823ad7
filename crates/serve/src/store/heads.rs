//! The head in a day's row: the number of its last event and the checksum of its log. A log that
//! lacks its last events does not fit its head, and other services compare heads to detect changes.

use std::collections::{BTreeMap, HashMap};

use sqlx::any::AnyRow;
use sqlx::query::Query;
use sqlx::{Any, AssertSqlSafe, Row as _, Transaction, query, query_scalar};

use super::{NewEvent, Store, as_i64, as_u64};
use crate::error::Error;

/// Number of days in one query.
const MOST_AT_ONCE: usize = 1_000;

/// The number and the checksum of a day's last event, and whether the day is archived.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Head {
    /// The number of its latest event; 0 if it has none.
    pub(crate) seq: u64,
    /// The checksum over all its events.
    pub(crate) chain: u32,
    /// Whether the day is closed to writes.
    pub(crate) archived: bool,
}

/// Events of one day that are added.
#[derive(Debug, Clone, Copy)]
struct Added {
    first: u64,
    last: u64,
    chain: u32,
}

impl Store {
    /// The head of a day; `None` if there is no such day.
    pub(crate) async fn head(&self, day: &str) -> Result<Option<Head>, Error> {
        let select = "SELECT id, seq, chain, archived FROM days WHERE id = $1";
        let select = query(select).bind(day).fetch_optional(&self.pool);
        let row = self.in_time(select).await?;
        row.map(|row| head(&row).map(|(_, head)| head)).transpose()
    }

    /// The heads of days by their ids, without days that do not exist or whose rows are damaged.
    pub(crate) async fn heads(&self, days: &[String]) -> Result<HashMap<String, Head>, Error> {
        let mut heads = HashMap::new();
        for days in days.chunks(MOST_AT_ONCE) {
            let places = self.places(1, days.len());
            let select = format!("SELECT id, seq, chain, archived FROM days WHERE id IN {places}");
            let select = days.iter().fold(query(AssertSqlSafe(select)), Query::bind);
            let select = select.fetch_all(&self.pool);
            for row in self.in_time(select).await? {
                heads.extend(head(&row));
            }
        }
        Ok(heads)
    }

    /// The checksum over the log of a day up to an event; `None` if there is no such event.
    pub(crate) async fn chain_at(&self, day: &str, seq: u64) -> Result<Option<u32>, Error> {
        let select = "SELECT chain FROM events WHERE day = $1 AND seq = $2";
        let select = query_scalar(select).bind(day).bind(as_i64(seq));
        let select = select.fetch_optional(&self.pool);
        let chain: Option<i64> = self.in_time(select).await?;
        Ok(chain.and_then(|chain| u32::try_from(chain).ok()))
    }

    /// The days that have events but no row, and those whose row is missing although they were not
    /// deleted.
    pub(crate) async fn lost_days(&self) -> Result<Vec<String>, Error> {
        let select = "SELECT DISTINCT day FROM events WHERE day NOT IN (SELECT id FROM days)
             UNION SELECT target FROM audit WHERE action = 'day made'
             AND target NOT IN (SELECT id FROM days)
             AND target NOT IN (SELECT target FROM audit WHERE action = 'day deleted')";
        Ok(query_scalar(select).fetch_all(&self.pool).await?)
    }

    /// Moves the heads of days to the last of the events that a transaction adds, and locks the
    /// days until the transaction ends. Returns the days with the numbers of their last events.
    ///
    /// # Errors
    /// Returns [`Error::NotFound`] or [`Error::Archived`] if a day takes no events, and
    /// [`Error::Conflict`] if an event is not the next one of its day, because another service was
    /// quicker.
    pub(super) async fn move_heads<'a>(
        &self,
        transaction: &mut Transaction<'_, Any>,
        events: &[NewEvent<'a>],
    ) -> Result<Vec<(&'a str, u64)>, Error> {
        let mut days: BTreeMap<&'a str, Added> = BTreeMap::new();
        for NewEvent { day, event, .. } in events {
            let (seq, chain) = (event.seq, event.chain);
            let added = days.entry(day).or_insert(Added { first: seq, last: seq, chain });
            (added.last, added.chain) = (seq, chain);
        }
        if self.is_shared() && days.len() > 1 {
            // Services that lock several days do so in one order, or they could wait for each
            // other.
            let places = self.places(1, days.len());
            let lock = format!("SELECT id FROM days WHERE id IN {places} ORDER BY id FOR UPDATE");
            let lock = days.keys().fold(query(AssertSqlSafe(lock)), |query, day| query.bind(*day));
            lock.execute(&mut **transaction).await?;
        }
        let values = self.places(days.len(), 4);
        // Both databases call the columns of bare values `column1` and so on.
        let update = format!(
            "UPDATE days SET seq = new.column3, chain = new.column4 FROM (VALUES {values}) AS new
             WHERE days.id = new.column1 AND days.seq = new.column2 AND days.archived = 0"
        );
        let mut update = query(AssertSqlSafe(update));
        for (day, Added { first, last, chain }) in &days {
            let before = as_i64(first.saturating_sub(1));
            update = update.bind(*day).bind(before).bind(as_i64(*last)).bind(i64::from(*chain));
        }
        let moved = update.execute(&mut **transaction).await?.rows_affected();
        if moved == days.len() as u64 {
            return Ok(days.into_iter().map(|(day, added)| (day, added.last)).collect());
        }
        for day in days.keys() {
            self.check_open(transaction, day).await?;
        }
        Err(Error::Conflict)
    }

    async fn check_open(
        &self,
        transaction: &mut Transaction<'_, Any>,
        day: &str,
    ) -> Result<(), Error> {
        let select = query_scalar("SELECT archived FROM days WHERE id = $1").bind(day);
        match select.fetch_optional(&mut **transaction).await? {
            Some(0_i64) => Ok(()),
            Some(_) => Err(Error::Archived { id: day.to_owned() }),
            None => Err(Error::not_found("day", day)),
        }
    }
}

fn head(row: &AnyRow) -> Result<(String, Head), Error> {
    let chain = u32::try_from(row.try_get::<i64, _>("chain")?);
    let chain =
        chain.map_err(|_| Error::BadData { rule: "a day with an impossible sum".to_owned() })?;
    let (seq, archived) = (row.try_get("seq")?, row.try_get::<i64, _>("archived")? != 0);
    Ok((row.try_get("id")?, Head { seq: as_u64(seq), chain, archived }))
}
