//! Joins parts of a study that were played separately, perhaps on different machines.

use crate::error::Error;
use crate::record::{ComparisonRecords, LatencySummary, PolicyRecord};

impl ComparisonRecords {
    /// Joins parts into the study of all of their days. Each part must begin with the day after the
    /// last day of the part before it.
    ///
    /// The records are the same as those of one study of all days, except for the times per
    /// decision: the percentiles of all decisions do not follow from those of the parts, so each is
    /// the highest of the parts' percentiles, which no part exceeded.
    ///
    /// # Errors
    /// Returns [`Error::Empty`] if there are no parts, and [`Error::PartsDiffer`] if they do not
    /// have the same network and policies, or if days are missing or occur twice.
    pub fn join(parts: Vec<Self>) -> Result<Self, Error> {
        let mut parts = parts.into_iter();
        let mut whole = parts.next().ok_or(Error::Empty { policies: 0, days: 0 })?;
        for part in parts {
            whole.check_goes_on(&part)?;
            whole.days += part.days;
            // The origin was determined from the days of a part, and one part may have missed that
            // the network was changed.
            whole.network_origin = whole.network_origin.with(part.network_origin);
            for (policy, part) in whole.policies.iter_mut().zip(part.policies) {
                policy.decision_ns = slower(policy.decision_ns, part.decision_ns);
                policy.days.extend(part.days);
            }
        }
        Ok(whole)
    }

    fn check_goes_on(&self, part: &Self) -> Result<(), Error> {
        let names = |study: &Self| -> Vec<String> {
            study.policies.iter().map(|policy: &PolicyRecord| policy.name.clone()).collect()
        };
        // No day has a seed that high, but a study that was read from a file may claim so.
        let next_seed = self.seed.map(|seed| seed.saturating_add(self.days as u64));
        let rule = if part.network != self.network {
            format!("network {:?} after {:?}", part.network, self.network)
        } else if part.split != self.split {
            format!("{} days after {} days", part.split.name(), self.split.name())
        } else if part.bound_step_s != self.bound_step_s {
            format!("bound step {:?} s after {:?} s", part.bound_step_s, self.bound_step_s)
        } else if names(part) != names(self) {
            format!("policies {:?} after {:?}", names(part), names(self))
        } else {
            match (part.seed, next_seed) {
                (Some(seed), Some(next)) if seed == next => return Ok(()),
                (Some(seed), Some(next)) => {
                    format!("days from seed {seed} after those up to {}", next.saturating_sub(1))
                }
                _ => "days of one's own have no order; compare them all at once".to_owned(),
            }
        };
        Err(Error::PartsDiffer { rule })
    }
}

fn slower(one: Option<LatencySummary>, other: Option<LatencySummary>) -> Option<LatencySummary> {
    let (one, other) = (one?, other?);
    Some(LatencySummary {
        median_ns: one.median_ns.max(other.median_ns),
        p99_ns: one.p99_ns.max(other.p99_ns),
    })
}

#[cfg(test)]
mod tests {
    use vertifleet_core::{Coded, Network, Stop};

    use crate::comparison::{Comparison, DrawnDays};
    use crate::competitor::Selection;
    use crate::record::{ComparisonRecords, DayRecord};
    use crate::study::Unwatched;

    fn study(policies: &[&str], seed: u64, days: u32) -> ComparisonRecords {
        let network = Network::shipped("paper").expect("a shipped network");
        let policies: Vec<String> = policies.iter().map(|&name| name.to_owned()).collect();
        let selection = Selection { policies: &policies, models: &[], seed: 0 };
        let never = Stop::default();
        let comparison = Comparison::new(
            &network,
            &selection,
            DrawnDays::of_comparison(seed, days),
            None,
            &never,
        )
        .expect("days");
        comparison.run(String::new(), &never, &Unwatched).expect("played days")
    }

    #[test]
    fn a_study_in_parts_is_the_study_of_all_days() {
        let policies = ["random", "greedy"];
        let parts = vec![study(&policies, 5, 2), study(&policies, 7, 1), study(&policies, 8, 3)];
        let (joined, whole) =
            (ComparisonRecords::join(parts).expect("parts"), study(&policies, 5, 6));
        let days = |study: &ComparisonRecords| -> Vec<Vec<DayRecord>> {
            study.policies.iter().map(|policy| policy.days.clone()).collect()
        };
        assert_eq!(days(&joined), days(&whole));
        assert_eq!((joined.seed, joined.days), (whole.seed, whole.days));
    }

    #[test]
    fn parts_that_do_not_go_together_are_refused() {
        let first = || study(&["greedy"], 5, 2);
        for other in [study(&["greedy"], 8, 1), study(&["random"], 7, 1), study(&["greedy"], 6, 1)]
        {
            let error =
                ComparisonRecords::join(vec![first(), other]).expect_err("no parts of one study");
            assert_eq!(error.code().to_string(), "V409");
        }
        assert_eq!(
            ComparisonRecords::join(Vec::new()).expect_err("no parts").code().to_string(),
            "V402"
        );
    }
}
