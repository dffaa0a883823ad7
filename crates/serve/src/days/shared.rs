//! Days that other services write to as well, in one database. The service applies their events
//! when a day is used, and while its stream is read.

use std::sync::Arc;
use std::time::{Duration, Instant};

use tokio::sync::OnceCell;
use tokio::time::sleep;

use super::Days;
use crate::day_cell::DayCell;
use crate::error::Error;
use crate::store::{DayNotice, PAGE};

/// Interval at which the days whose streams are read are checked, in case a notice was missed.
const POLL_INTERVAL: Duration = Duration::from_secs(2);

impl Days {
    /// Applies the events that other services have added to a day. Returns false if memory is not a
    /// prefix of the store: an event of this service waits under a number that was taken, or the
    /// day was archived, reopened, deleted or restored from a copy.
    pub(super) async fn catch_up(&self, day: &DayCell) -> Result<bool, Error> {
        let stored = day.stored_seq();
        let Some(head) = self.store.head(day.id()).await? else { return Ok(false) };
        if head.archived != day.stored.archived || head.seq < stored {
            return Ok(false);
        }
        loop {
            let (known, chain) = {
                let state = day.state();
                (state.seq(), state.chain())
            };
            if head.seq <= known {
                // Events of this service may be on their way to the store.
                return Ok(head.seq < known || head.chain == chain);
            }
            let page = self.store.events(day.id(), known, PAGE).await?;
            let mut state = day.state();
            for event in page.events {
                if event.seq == state.seq() + 1 {
                    if state.replay(&event).is_err() {
                        return Ok(false);
                    }
                    day.publish(vec![event]);
                }
            }
            if page.is_last && state.seq() < head.seq {
                return Ok(false);
            }
        }
    }

    /// Follows the changes of other services to the days whose streams are read, until it is
    /// dropped. One connection receives their notices for all readers.
    pub(crate) async fn follow_others(&self) {
        if !self.store.is_shared() {
            return;
        }
        loop {
            if let Err(error) = self.listen().await {
                tracing::warn!(%error, "cannot listen for changes of other services; trying again soon");
            }
            sleep(POLL_INTERVAL).await;
        }
    }

    async fn listen(&self) -> Result<(), Error> {
        let Some(mut listener) = self.store.listener().await? else { return Ok(()) };
        loop {
            // The first pass applies changes from before the connection; later ones apply missed
            // notices.
            self.check_followed_days().await?;
            let checked = Instant::now();
            while let Some(left) = POLL_INTERVAL.checked_sub(checked.elapsed()) {
                match listener.next(left).await? {
                    Some(notice) => self.apply_notice(&notice).await?,
                    None => break,
                }
            }
        }
    }

    async fn apply_notice(&self, DayNotice { day, seq }: &DayNotice) -> Result<(), Error> {
        // Other days are compared with the store when they are used.
        let Some(day) = self.loaded(day).filter(|day| day.is_read()) else { return Ok(()) };
        let is_known = seq.is_some_and(|seq| seq <= day.state().seq());
        if is_known { Ok(()) } else { self.refresh(&day).await }
    }

    /// Compares the days whose streams are read with the store, in one query.
    async fn check_followed_days(&self) -> Result<(), Error> {
        let days: Vec<Arc<DayCell>> = {
            let cells = self.cells();
            let loaded = cells.values().filter_map(|cell| cell.get());
            loaded.filter(|day| day.is_read()).cloned().collect()
        };
        let ids: Vec<String> = days.iter().map(|day| day.id().to_owned()).collect();
        let heads = self.store.heads(&ids).await?;
        for day in days {
            let is_known = heads.get(day.id()).is_some_and(|head| {
                let state = day.state();
                head.archived == day.stored.archived
                    && (head.seq, head.chain) == (state.seq(), state.chain())
            });
            if !is_known {
                self.refresh(&day).await?;
            }
        }
        Ok(())
    }

    /// Applies the changes of other services to a day. A damaged day is dropped; the others are
    /// still followed.
    async fn refresh(&self, day: &DayCell) -> Result<(), Error> {
        match self.catch_up(day).await {
            Ok(true) => {}
            Ok(false) | Err(Error::BadData { .. }) => self.drop_from_memory(day),
            Err(error) => return Err(error),
        }
        Ok(())
    }

    /// A day that is in memory.
    fn loaded(&self, id: &str) -> Option<Arc<DayCell>> {
        self.cells().get(id).and_then(|cell| OnceCell::get(cell)).cloned()
    }
}
