//! The day cut into slots. In each slot a price stays the same.

use vertifleet_sim::View;

/// Length of a slot, seconds. Prices of shorter slots took longer and earned no more; those of 5
/// minutes earned 0.3 % less.
pub(super) const SLOT_S: u32 = 180;

/// Each number of seconds as a share of a slot, because divisions are slow.
static SHARES: [f64; SLOT_S as usize] = {
    let mut shares = [0.0; SLOT_S as usize];
    let mut second = 0;
    while second < SLOT_S {
        shares[second as usize] = second as f64 / SLOT_S as f64;
        second += 1;
    }
    shares
};

/// The position of a time in the table of slots: the boundary before it, and its distance from
/// there as a share of a slot.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) slot: usize,
    pub(super) share: f64,
}

/// The slots of a day. The last one contains the end of operations.
#[derive(Debug, Clone, Copy)]
pub(super) struct Clock {
    pub(super) start_s: u32,
    pub(super) end_s: u32,
    pub(super) slots: usize,
}

impl Clock {
    pub(super) fn of(view: View<'_>) -> Self {
        let (start_s, end_s) = (view.day_start().seconds(), view.day_end().seconds());
        Self { start_s, end_s, slots: ((end_s - start_s) / SLOT_S + 1) as usize }
    }

    /// First second of a slot.
    #[inline]
    pub(super) fn begin_s(&self, slot: usize) -> u32 {
        self.start_s + SLOT_S * u32::try_from(slot).expect("a day has few slots")
    }

    /// The slot that contains a time, or the number of slots if the time is past the last one.
    #[inline]
    pub(super) fn slot(&self, time_s: u32) -> usize {
        (((time_s - self.start_s) / SLOT_S) as usize).min(self.slots)
    }

    #[inline]
    pub(super) fn place(&self, time_s: u32) -> Place {
        let since_s = time_s - self.start_s;
        let slot = (since_s / SLOT_S) as usize;
        if slot >= self.slots {
            return Place { slot: self.slots - 1, share: 1.0 };
        }
        Place { slot, share: SHARES[(since_s % SLOT_S) as usize] }
    }
}
