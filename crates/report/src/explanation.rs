//! The report of an explained day: that of the played day, with its bound and the value of changes.

use vertifleet_core::OutputKind;
use vertifleet_picture::numbers::{dollars, grouped, minutes, signed};
use vertifleet_study::explain::Explanation;
use vertifleet_study::record::{ReplayedDay, bound_share};

use crate::account::account;
use crate::comparison::NONE;
use crate::report::{Report, Section, Table};

/// The beginning of every page of an explanation.
pub const EXPLANATION_PAGE: OutputKind = OutputKind {
    name: "explanation of a day",
    skipped: 0,
    opening: "<!DOCTYPE html>\n<!-- vertifleet-explanation/",
};

/// The report of an explanation. `replayed` is the day itself
/// ([`Account::replayed`](vertifleet_study::account::Account::replayed)).
pub fn explanation<'a>(explanation: &Explanation, replayed: &'a [ReplayedDay]) -> Report<'a> {
    let mut report = account(&explanation.account, replayed);
    let bound_usd = explanation.upper_bound_usd;
    let share = 100.0 * bound_share(&explanation.account.totals, bound_usd);
    let of_bound = format!(
        " The profit is {} % of the upper bound of {} (slices of {}).",
        grouped(share, 1),
        dollars(bound_usd),
        minutes(explanation.bound_step_s)
    );
    report.headline += &of_bound;
    report.facts.insert(0, ("Upper bound", dollars(bound_usd)));
    report.sections.push(
        Section::of_table("What a change would be worth", worth(explanation))
            .with_note("each day was solved again with the change, by the policy and by the bound; both differences are net of the cost of the change")
            .with_note("the policy's difference is that of one day, whose noise exceeds the value of most changes: a sweep measures changes over many days")
            .with_note("the bound's is the difference of the upper bounds; one more stand is worth at most its price in the table of vertiports, less its cost"),
    );
    Report {
        subject: "where a day’s money is, and where it is lost",
        kind: Some(&EXPLANATION_PAGE),
        ..report
    }
}

/// Printed for a difference of two bounds that their searches cannot resolve.
const WITHIN_ERROR: &str = "within its error";

/// The value of changes after their cost.
fn worth(explanation: &Explanation) -> Table {
    let by_policy = format!("{} after cost, $", explanation.account.policy);
    let columns = ["change", "cost, $", &by_policy, "bound after cost, $"];
    Table::new(columns).with_rows(explanation.worth.iter().map(|one| {
        let policy = one.policy_usd.map_or_else(|| NONE.to_owned(), |usd| signed(usd, 0));
        let by_bound =
            if one.is_within_error { WITHIN_ERROR.to_owned() } else { signed(one.bound_usd, 0) };
        vec![one.change.clone(), grouped(one.cost_usd, 0), policy, by_bound]
    }))
}
