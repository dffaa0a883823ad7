//! Stores events: those of one append together or not at all, several appends at once, and never on
//! a day that is archived.

use sqlx::{AssertSqlSafe, query, query_scalar};

use super::{DayNotice, Store, StoredAnswer, as_i64};
use crate::error::Error;
use crate::taken_event::TakenEvent;

/// An event that is to be stored.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NewEvent<'a> {
    /// The id of its day.
    pub(crate) day: &'a str,
    /// The append that it belongs to.
    pub(crate) append: AppendId,
    /// The event.
    pub(crate) event: &'a TakenEvent,
}

/// A random number that identifies one append, so that a service recognises its own events among
/// equal events of other services.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct AppendId(i64);

impl AppendId {
    /// Draws a new id.
    ///
    /// # Errors
    /// Returns [`Error::Internal`] if the operating system has no random numbers.
    pub(crate) fn draw() -> Result<Self, Error> {
        let random = getrandom::u64();
        random
            .map(|id| Self(id.cast_signed()))
            .map_err(|error| Error::Internal { cause: error.to_string() })
    }
}

impl Store {
    /// Adds events of several days, all or none.
    ///
    /// # Errors
    /// Returns the errors of [`move_heads`](Self::move_heads), [`Error::Store`], and
    /// [`Error::StoreHangs`], after which the events may still be stored.
    pub(crate) async fn append(
        &self,
        events: &[NewEvent<'_>],
        answers: &[&StoredAnswer],
    ) -> Result<(), Error> {
        let append = async {
            let mut transaction = self.pool.begin().await?;
            let heads = self.move_heads(&mut transaction, events).await?;
            // A statement has at most 32,766 parameters in SQLite.
            for events in events.chunks(4_000) {
                let sql = "INSERT INTO events (day, seq, at_ms, actor, body, notices, chain, append_id) VALUES ";
                let sql = sql.to_owned() + &self.places(events.len(), 8);
                let mut insert = query(AssertSqlSafe(sql));
                for NewEvent { day, append: AppendId(append), event } in events {
                    insert = insert
                        .bind(*day)
                        .bind(as_i64(event.seq))
                        .bind(event.at_ms)
                        .bind(&event.actor)
                        .bind(&event.body)
                        .bind(&event.notices)
                        .bind(i64::from(event.chain))
                        .bind(*append);
                }
                insert.execute(&mut *transaction).await?;
            }
            let at_ms = events.first().map_or(0, |new| new.event.at_ms);
            self.insert_answers(&mut transaction, answers, at_ms).await?;
            let notice =
                |(day, seq): (&str, u64)| DayNotice { day: day.to_owned(), seq: Some(seq) };
            let notices: Vec<DayNotice> = heads.into_iter().map(notice).collect();
            self.notify(&mut transaction, &notices).await?;
            Ok::<_, Error>(transaction.commit().await?)
        };
        self.in_time(append).await
    }

    pub(super) async fn insert_answers(
        &self,
        transaction: &mut sqlx::Transaction<'_, sqlx::Any>,
        answers: &[&StoredAnswer],
        at_ms: i64,
    ) -> Result<(), Error> {
        for answers in answers.chunks(4_000) {
            let sql = "INSERT INTO answers (idempotency_key, request, answer, at_ms) VALUES ";
            let mut insert = query(AssertSqlSafe(sql.to_owned() + &self.places(answers.len(), 4)));
            for answer in answers {
                insert =
                    insert.bind(&answer.key).bind(&answer.request).bind(&answer.answer).bind(at_ms);
            }
            insert.execute(&mut **transaction).await?;
        }
        Ok(())
    }

    /// Whether this append stored the event with a number. Another service may have stored an equal
    /// event, so contents are not compared.
    pub(crate) async fn is_stored_by(
        &self,
        append: AppendId,
        day: &str,
        seq: u64,
    ) -> Result<bool, Error> {
        let select = query_scalar("SELECT append_id FROM events WHERE day = $1 AND seq = $2");
        let select = select.bind(day).bind(as_i64(seq)).fetch_optional(&self.pool);
        let found: Option<i64> = self.in_time(select).await?;
        Ok(found == Some(append.0))
    }

    /// The placeholders of the values of some rows, `(?, ?), (?, ?)`, with numbers for
    /// `PostgreSQL`. `SQLite` would compare each number with all others.
    pub(super) fn places(&self, rows: usize, columns: usize) -> String {
        let place = |at: usize| if self.is_shared() { format!("${at}") } else { "?".to_owned() };
        let row = |row: usize| {
            let places: Vec<String> =
                (1..=columns).map(|column| place(row * columns + column)).collect();
            format!("({})", places.join(", "))
        };
        (0..rows).map(row).collect::<Vec<_>>().join(", ")
    }
}
