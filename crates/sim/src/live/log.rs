//! The reports of a live day in order, and corrections: a report that is taken back leaves no
//! trace, because the day is computed again from the other ones.

use std::sync::Arc;

use vertifleet_core::Time;

use super::LiveDay;
use super::notice::Notice;
use super::report::{Report, ReportError};

/// A report that was accepted.
#[derive(Debug, Clone)]
pub(super) struct Accepted {
    time: Time,
    report: Report,
    /// The notices that came with it.
    notices: Vec<Notice>,
    is_corrected: bool,
}

impl LiveDay {
    /// Takes a report in. `time` is when it happened; reports may come late. The day's clock never
    /// runs back, except when a report that advanced it is corrected. Returns the notices for
    /// people.
    ///
    /// # Errors
    /// Returns a [`ReportError`] if the report makes no sense, is a decision that breaks a rule, or
    /// corrects a report that later ones depend on. Nothing has changed then.
    pub fn take(&mut self, time: Time, report: &Report) -> Result<Vec<Notice>, ReportError> {
        let notices = match *report {
            Report::Corrected { event } => {
                self.correct(event)?;
                Vec::new()
            }
            _ => self.apply(time, report)?,
        };
        let (report, kept) = (report.clone(), notices.clone());
        self.log.push(Accepted { time, report, notices: kept, is_corrected: false });
        Ok(notices)
    }

    /// The reports so far, in order; the first has the number 1.
    pub fn reports(&self) -> impl Iterator<Item = &Report> + '_ {
        self.log.iter().map(|accepted| &accepted.report)
    }

    /// The notices that came with reports, with the numbers of these. Those of corrected reports
    /// are not among them.
    pub fn past_notices(&self) -> impl Iterator<Item = (u64, &Notice)> + '_ {
        (1..).zip(&self.log).flat_map(|(number, accepted)| {
            accepted.notices.iter().map(move |notice| (number, notice))
        })
    }

    /// The number of corrections so far.
    pub fn corrections(&self) -> usize {
        let is_correction = |report: &&Report| matches!(report, Report::Corrected { .. });
        self.reports().filter(is_correction).count()
    }

    /// Computes the day again without a report.
    fn correct(&mut self, event: u64) -> Result<(), ReportError> {
        let cannot = |why| ReportError::CannotCorrect { event, why };
        let position = usize::try_from(event).ok().and_then(|number| number.checked_sub(1));
        let accepted = position.and_then(|at| self.log.get(at));
        let accepted = accepted.ok_or_else(|| cannot("the day has no such earlier event"))?;
        if accepted.is_corrected {
            return Err(cannot("it was corrected before"));
        }
        if matches!(accepted.report, Report::Corrected { .. }) {
            return Err(cannot("it is itself a correction; report the first event again"));
        }
        let mut day = Self::new(Arc::clone(self.scenario()));
        for (number, accepted) in (1..).zip(&self.log) {
            let Accepted { time, report, is_corrected, .. } = accepted;
            let is_corrected = *is_corrected || number == event;
            let notices = if is_corrected || matches!(report, Report::Corrected { .. }) {
                Vec::new()
            } else {
                day.apply(*time, report).map_err(|cause| {
                    let cause = Box::new(cause);
                    ReportError::NeededLater { event, later: number, cause }
                })?
            };
            day.log.push(Accepted { time: *time, report: report.clone(), notices, is_corrected });
        }
        // The clock may run back, so policies must not continue from what they remember.
        day.forget();
        *self = day;
        Ok(())
    }
}
