//! Reads events: page by page for clients, and quickly for a replay.

use futures_util::TryStreamExt as _;
use sqlx::any::AnyRow;
use sqlx::{Row as _, query, query_as};

use super::{Store, as_i64};
use crate::error::Error;
use crate::taken_event::TakenEvent;

/// Number of rows that are read at once.
pub(crate) const PAGE: u32 = 10_000;
/// Number of events that are read at once for a replay.
const REPLAYED: u32 = 1_000;
/// Approximate number of bytes of events that are read at once, so that neither long events nor
/// many readers fill the memory.
const PAGE_BYTES: usize = 4 << 20;

/// Consecutive events of a day.
#[derive(Debug)]
pub(crate) struct Page {
    pub(crate) events: Vec<TakenEvent>,
    /// Whether these are the last ones.
    pub(crate) is_last: bool,
}

impl Store {
    /// The events of a day after number `after`, at most `limit`, and fewer if they are long.
    pub(crate) async fn events(&self, day: &str, after: u64, limit: u32) -> Result<Page, Error> {
        self.in_time(self.read_events(day, after, limit)).await
    }

    async fn read_events(&self, day: &str, after: u64, limit: u32) -> Result<Page, Error> {
        let mut rows = query(
            "SELECT seq, at_ms, actor, body, notices, chain FROM events
             WHERE day = $1 AND seq > $2 ORDER BY seq LIMIT $3",
        )
        .bind(day)
        .bind(as_i64(after))
        .bind(i64::from(limit))
        .fetch(&self.pool);
        let (mut events, mut bytes) = (Vec::new(), 0);
        while let Some(row) = rows.try_next().await? {
            let event = stored_event(&row)?;
            bytes += event.body.len() + event.notices.len();
            events.push(event);
            if bytes >= PAGE_BYTES {
                return Ok(Page { events, is_last: false });
            }
        }
        let is_last = events.len() < limit as usize;
        Ok(Page { events, is_last })
    }

    /// Some events of a day after number `after`, up to number `until`; none if there are none.
    pub(crate) async fn events_to_replay(
        &self,
        day: &str,
        after: u64,
        until: u64,
    ) -> Result<Vec<TakenEvent>, Error> {
        let limit = u32::try_from(until - after).unwrap_or(REPLAYED).min(REPLAYED);
        self.in_time(self.read_to_replay(day, after, limit)).await
    }

    /// The database returns the events as one row, which takes a third of the time of separate
    /// rows. A long event is read alone.
    async fn read_to_replay(
        &self,
        day: &str,
        after: u64,
        limit: u32,
    ) -> Result<Vec<TakenEvent>, Error> {
        // Events and notices are compact JSON, so none of them contains the end of a line.
        const POSTGRES: &str = "SELECT json_agg(json_build_array(seq, at_ms, chain, actor))::text,
             string_agg(SUBSTR(body, 1, 4096), CHR(10)), string_agg(SUBSTR(notices, 1, 4096), CHR(10)) FROM
             (SELECT * FROM events WHERE day = $1 AND seq > $2 ORDER BY seq LIMIT $3) AS page";
        const SQLITE: &str = "SELECT json_group_array(json_array(seq, at_ms, chain, actor)),
             group_concat(SUBSTR(body, 1, 4096), CHAR(10)), group_concat(SUBSTR(notices, 1, 4096), CHAR(10)) FROM
             (SELECT * FROM events WHERE day = $1 AND seq > $2 ORDER BY seq LIMIT $3) AS page";
        const LONG: usize = 4096;
        let select = query_as(if self.is_shared() { POSTGRES } else { SQLITE });
        let select = select.bind(day).bind(as_i64(after)).bind(i64::from(limit));
        let page: (Option<String>, Option<String>, Option<String>) =
            select.fetch_one(&self.pool).await?;
        let (Some(rows), Some(bodies), Some(notices)) = page else { return Ok(Vec::new()) };
        let rows: Vec<(u64, i64, u32, String)> = serde_json::from_str(&rows)
            .map_err(|error| Error::BadData { rule: format!("events without sense: {error}") })?;
        let texts = bodies.split('\n').zip(notices.split('\n'));
        let is_whole = |(body, notices): &(&str, &str)| body.len().max(notices.len()) < LONG;
        let event = |((seq, at_ms, chain, actor), (body, notices)): (_, (&str, &str))| {
            let (body, notices) = (body.to_owned(), notices.to_owned());
            TakenEvent { seq, chain, at_ms, actor, body, notices }
        };
        let events: Vec<_> = rows.into_iter().zip(texts.take_while(is_whole)).map(event).collect();
        if events.is_empty() {
            return Ok(self.read_events(day, after, 1).await?.events);
        }
        Ok(events)
    }
}

fn stored_event(row: &AnyRow) -> Result<TakenEvent, Error> {
    let number = |name: &str| -> Result<i64, Error> { Ok(row.try_get(name)?) };
    let bad = |name: &str| Error::BadData { rule: format!("an event with an impossible {name}") };
    Ok(TakenEvent {
        seq: u64::try_from(number("seq")?).map_err(|_| bad("number"))?,
        at_ms: number("at_ms")?,
        actor: row.try_get("actor")?,
        body: row.try_get("body")?,
        notices: row.try_get("notices")?,
        chain: u32::try_from(number("chain")?).map_err(|_| bad("sum"))?,
    })
}
