//! What a policy remembers of the day that it plays.

use vertifleet_sim::{DayKey, Decision, View};

/// A memory of one day at a time. Asked about several days by turns, it forgets each for the next, which costs time and
/// never mixes them up.
#[derive(Debug, Clone)]
pub struct DayMemory<T> {
    kept: Option<Kept<T>>,
}

#[derive(Debug, Clone)]
struct Kept<T> {
    day: DayKey,
    /// Index of the latest decision asked about.
    decision: u32,
    memory: T,
}

impl<T> Default for DayMemory<T> {
    fn default() -> Self {
        Self { kept: None }
    }
}

impl<T> DayMemory<T> {
    /// The memory of the day of a decision; a new one if that day is another than the one before, or begins again.
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
