//! The explanation as a page: that of the played day, with its bound and with what changes would be
//! worth.

use maud::html;
use vertifleet_picture::numbers::{dollars, grouped, minutes};

use super::{Explanation, PAGE, table};
use crate::account::page::{self, PageExtras, section};
use crate::record::bound_share;

/// The page as HTML.
pub(super) fn text(explanation: &Explanation) -> String {
    let bound_usd = explanation.upper_bound_usd;
    let share = 100.0 * bound_share(&explanation.account.totals, bound_usd);
    let slices = minutes(explanation.bound_step_s);
    let beside = PageExtras {
        opening: PAGE.opening,
        subject: "where a day’s money is, and where it is lost",
        share: format!(", {} % of what no schedule can pass", grouped(share, 1)),
        numbers: html! {
            div { dt { "Upper bound" } dd { (dollars(bound_usd)) " (slices of " (slices) ")" } }
        },
        sections: section(
            "What a change would be worth",
            "Each day was solved again with the change, by the policy and by the bound; both differences are after what the \
             change costs. The policy’s difference is that of one day, which chance moves by more than most changes are worth: a \
             sweep measures changes over many days. The bound’s is that of what is possible.",
            &table::worth(explanation),
        ),
    };
    page::text(&explanation.account, &beside)
}
