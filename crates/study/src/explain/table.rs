//! The explanation as text for a terminal.

use vertifleet_picture::numbers::{grouped, signed};

use super::Explanation;
use crate::account::table::{ledger, pairs, periods, types, vertiports, worst_cells};
use crate::record::bound_share;
use crate::table::append_aligned;

/// Most pairs, and most pairs with a period, that are listed; JSON has all of them.
const MOST_PAIRS: usize = 10;

pub(super) fn text(explanation: &Explanation) -> String {
    let account = &explanation.account;
    let totals = &account.totals;
    let mut text = format!(
        "{} with {}: profit {} $, {:.1} % of the upper bound of {} $ (slices of {} min)\n\
         {} passengers are spilled, with a margin of {} ${}\n\n",
        account.day,
        account.policy,
        grouped(totals.profit_usd, 2),
        100.0 * bound_share(totals, explanation.upper_bound_usd),
        grouped(explanation.upper_bound_usd, 2),
        explanation.bound_step_s / 60,
        grouped(totals.spilled_passengers as f64, 0),
        grouped(account.spilled_margin_usd(), 0),
        account.spilled_out_of_reach(|usd| format!("{} $", grouped(usd, 0))),
    );
    append_aligned(&mut text, &ledger(account));
    text += "\ndemand by period\n";
    append_aligned(&mut text, &periods(account));
    text += "\nwhere most money is spilled\n";
    append_aligned(&mut text, &pairs(account, MOST_PAIRS));
    text += "\nwhere and when most money is spilled\n";
    append_aligned(&mut text, &worst_cells(account, MOST_PAIRS));
    text += "\nvertiports\n";
    append_aligned(&mut text, &vertiports(account));
    text += "\naircraft, means by type\n";
    append_aligned(&mut text, &types(account));
    text += "\nwhat a change would be worth on this day after what it costs, solved again\n";
    append_aligned(&mut text, &worth(explanation));
    text + "\nThe policy's difference is that of one day, which chance moves by more than most changes are worth: a sweep \
            measures changes over many days. The bound's is that of what is possible. One more stand is worth its price in \
            the table of vertiports at most, less what it costs.\n"
}

/// What changes are worth after what they cost.
pub(super) fn worth(explanation: &Explanation) -> Vec<Vec<String>> {
    let mut rows = vec![vec![
        "change".to_owned(),
        "cost, $".to_owned(),
        format!("{} after cost, $", explanation.account.policy),
        "bound after cost, $".to_owned(),
    ]];
    rows.extend(explanation.worth.iter().map(|one| {
        let policy = one.policy_usd.map_or_else(|| "n/a".to_owned(), |usd| signed(usd, 0));
        vec![one.change.clone(), grouped(one.cost_usd, 0), policy, signed(one.bound_usd, 0)]
    }));
    rows
}
