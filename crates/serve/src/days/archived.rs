//! Days that are closed to writes, opened again, and removed, each only where the writer expects it to be.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use super::{DayCell, Days, Writer};
use crate::error::Error;

impl Days {
    /// Closes a day to writes. It may be closed already.
    ///
    /// # Errors
    /// Returns [`Error::NotFound`], [`Error::Moved`] if the day is at another event than the writer expects, and
    /// [`Error::Store`].
    pub(crate) async fn archive(&self, id: &str, writer: &Writer) -> Result<(), Error> {
        self.set_archived(id, true, writer).await
    }

    /// Opens a day again that was closed to writes. It may be open already.
    ///
    /// # Errors
    /// Returns the errors of [`archive`](Self::archive).
    pub(crate) async fn unarchive(&self, id: &str, writer: &Writer) -> Result<(), Error> {
        self.set_archived(id, false, writer).await
    }

    async fn set_archived(&self, id: &str, archived: bool, writer: &Writer) -> Result<(), Error> {
        let day = self.settled(id, writer).await?;
        self.store.set_archived(id, archived, writer.if_match, &writer.actor).await?;
        self.drop_from_memory(&day);
        Ok(())
    }

    /// Removes a day.
    ///
    /// # Errors
    /// Returns the errors of [`archive`](Self::archive).
    pub(crate) async fn delete(&self, id: &str, writer: &Writer) -> Result<(), Error> {
        let day = self.settled(id, writer).await?;
        self.store.delete(id, writer.if_match, &writer.actor).await?;
        self.drop_from_memory(&day);
        Ok(())
    }

    /// A day that is where the writer expects it to be, when all its events so far are stored. The store has the last word on
    /// where it is, since events may come until then.
    async fn settled(&self, id: &str, writer: &Writer) -> Result<Arc<DayCell>, Error> {
        let day = self.get(id).await?;
        let seq = day.state().seq();
        writer.check(seq)?;
        day.stored_up_to(seq).await?;
        Ok(day)
    }

    /// Has everybody read a day again, those who read its stream or are about to write to it among them.
    fn drop_from_memory(&self, day: &DayCell) {
        day.has_failed.store(true, Ordering::Release);
        self.forget(day.id());
    }
}
