//! The memory of a policy about the day that it plays.

use vertifleet_sim::{DayKey, Decision, View};

/// A memory of one day at a time. If a policy plays several days by turns, the memory of each is dropped for the next,
/// which costs time but never mixes days up.
#[derive(Debug, Clone)]
pub struct DayMemory<T> {
    kept: Option<Kept<T>>,
}

#[derive(Debug, Clone)]
struct Kept<T> {
    day: DayKey,
    /// Index of the latest decision that was asked for.
    decision: u32,
    memory: T,
}

impl<T> Default for DayMemory<T> {
    fn default() -> Self {
        Self { kept: None }
    }
}

impl<T> DayMemory<T> {
    /// The memory of a decision's day. It is made anew if the day is not the one before, or starts again.
    pub fn of_day(
        &mut self,
        view: View<'_>,
        decision: &Decision,
        make: impl FnOnce() -> T,
    ) -> &mut T {
        let day = view.day();
        let goes_on = |kept: &Kept<T>| kept.day == day && kept.decision <= decision.index;
        let memory = match self.kept.take() {
            Some(kept) if goes_on(&kept) => kept.memory,
            _ => make(),
        };
        &mut self.kept.insert(Kept { day, decision: decision.index, memory }).memory
    }
}
