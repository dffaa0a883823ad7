//! Archives, reopens and deletes days, each only at the event that the writer expects.

use std::sync::Arc;

use tokio::sync::OnceCell;

use super::{Days, TRIES, Writer};
use crate::day_cell::DayCell;
use crate::error::Error;

impl Days {
    /// Archives a day or reopens it. It may already be in that state.
    ///
    /// # Errors
    /// Returns [`Error::NotFound`], [`Error::Moved`] if the day is at another event than the writer
    /// expects, and [`Error::Store`].
    pub(crate) async fn set_archived(
        &self,
        id: &str,
        archived: bool,
        writer: &Writer,
    ) -> Result<(), Error> {
        let day = self.settled(id, writer).await?;
        self.store.set_archived(id, archived, writer.if_match, &writer.actor.name).await?;
        self.drop_from_memory(&day);
        Ok(())
    }

    /// Removes a day.
    ///
    /// # Errors
    /// Returns the errors of [`set_archived`](Self::set_archived).
    pub(crate) async fn delete(&self, id: &str, writer: &Writer) -> Result<(), Error> {
        let day = self.settled(id, writer).await?;
        self.store.delete(id, writer.if_match, &writer.actor.name).await?;
        self.drop_from_memory(&day);
        Ok(())
    }

    /// A day at the event that the writer expects, when all its events so far are stored. The store
    /// makes the final check, since events may arrive in the meantime.
    async fn settled(&self, id: &str, writer: &Writer) -> Result<Arc<DayCell>, Error> {
        for _ in 0..TRIES {
            let day = self.get(id).await?;
            let seq = day.state().seq();
            writer.check(seq)?;
            match day.stored_up_to(seq).await {
                Err(Error::Conflict) => {}
                stored => return stored.map(|()| day),
            }
        }
        Err(Error::Conflict)
    }

    /// Makes all users of a day read it again, including readers of its stream and writers.
    pub(super) fn drop_from_memory(&self, day: &DayCell) {
        day.fail();
        let mut cells = self.cells();
        // A day that was read again in the meantime stays. One that is being read may have been
        // read too early.
        let is_dropped = |cell: &Arc<OnceCell<Arc<DayCell>>>| {
            cell.get().is_none_or(|kept| std::ptr::eq(&raw const **kept, day))
        };
        if cells.get(day.id()).is_some_and(is_dropped) {
            cells.remove(day.id());
        }
    }
}
