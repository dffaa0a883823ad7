//! `report.html` of a study of many networks: like that of a comparison, with one row per network.

use maud::{Markup, html};
use vertifleet_picture::numbers::{counted, dollars, grouped, minutes, p_value, signed, typeset};

use super::{GeneralisationReport, NetworkShare, headline};
use crate::figure::Figure;
use crate::page::{self, estimate};
use crate::share::PolicyShare;

/// The page as HTML.
pub(super) fn text(summary: &GeneralisationReport, figures: &[Figure]) -> String {
    let body = html! {
        (opening(summary))
        (results(summary))
        h2 { "Figures" }
        @for figure in figures { (page::picture(figure)) }
        (networks(summary))
        (closing(figures))
    };
    page::document("Vertifleet on random networks", &body)
}

fn opening(summary: &GeneralisationReport) -> Markup {
    let range = |size| {
        let (least, most) = summary.range(size);
        format!("{least} to {most}")
    };
    html! {
        p.program { "Vertifleet " (summary.program_version) " · policies on networks they never saw" }
        h1 { (counted(summary.policies.len(), "policy", "policies")) " on "
            (counted(summary.networks.len(), "random network", "random networks")) }
        p.headline { (headline::text(summary)) }
        dl {
            div { dt { "Networks" } dd { (summary.networks.len()) } }
            div { dt { "Vertiports" } dd { (range(|network| network.vertiports)) } }
            div { dt { "Aircraft" } dd { (range(|network| network.aircraft)) } }
            div { dt { "Slices of the bounds" } dd { (minutes(summary.bound_step_s)) } }
        }
        pre { (summary.command) }
    }
}

fn results(summary: &GeneralisationReport) -> Markup {
    let first = &summary.first().name;
    html! {
        h2 { "Results" }
        p.lead { "Means over the networks, a day of each. ± is the 95 % interval of the mean (Student’s t). Of bound: profit as a "
            "share of what is proven that no schedule of the day earns more than. Differences are of the same day; p is two-sided, "
            "of paired t-tests, and not adjusted for their number."
            @if summary.policies.iter().any(|policy| policy.knows_the_day) {
                " What knows the day plans it as a whole, beforehand: a reference, no policy."
            } }
        div.wide { table {
            thead { tr {
                th scope="col" { "policy" }
                th scope="col" { "sees" }
                th scope="col" { "of bound, %" }
                th scope="col" { "lowest, %" }
                th scope="col" { "above " (first) }
                th scope="col" { "minus " (first) ", points" }
                th scope="col" { "p" }
            } }
            tbody { @for (position, policy) in summary.policies.iter().enumerate() {
                tr.best[position == summary.best_position()] { (result_cells(policy, summary.networks.len())) }
            } }
        } }
        ul.descriptions { @for policy in &summary.policies {
            @if !policy.description.is_empty() { li { b { (policy.name) } ": " (policy.description) } }
        } }
    }
}

fn result_cells(policy: &PolicyShare, networks: usize) -> Markup {
    let percent = |share: f64| grouped(100.0 * share, 2);
    html! {
        th scope="row" title=(policy.name) {
            (policy.name)
        }
        td { (policy.sees) }
        td { (estimate(&policy.bound_share, percent)) }
        td { (typeset(&percent(policy.lowest_bound_share))) }
        @if let Some(test) = &policy.minus_first {
            td { (test.first_larger) small { " of " (networks) } }
            td {
                (typeset(&signed(100.0 * test.difference.mean, 2)))
                @if let Some(half) = test.difference.half_width_95 { small { " ± " (percent(half)) } }
            }
            td { (p_value(test.p_value)) }
        } @else {
            td { "" } td { "" } td { "" }
        }
    }
}

fn networks(summary: &GeneralisationReport) -> Markup {
    html! {
        h2 { "Networks" }
        p.lead { "What each policy earns on each network’s day, as a share of that day’s bound. Every command takes the network by "
            "the name in the first column; the day has the same number for its seed." }
        div.wide { table {
            thead { tr {
                th scope="col" { "network" }
                th scope="col" { "vertiports" }
                th scope="col" { "aircraft" }
                th scope="col" { "bound, $" }
                @for policy in &summary.policies { th scope="col" { (policy.name) ", %" } }
            } }
            tbody { @for network in &summary.networks { tr { (network_cells(network)) } } }
        } }
    }
}

fn network_cells(network: &NetworkShare) -> Markup {
    html! {
        th scope="row" { (network.network) }
        td { (network.vertiports) }
        td { (network.aircraft) }
        td { (dollars(network.upper_bound_usd).trim_start_matches('$')) }
        @for outcome in &network.results { td { (typeset(&grouped(100.0 * outcome.bound_share, 1))) } }
    }
}

fn closing(figures: &[Figure]) -> Markup {
    html! {
        footer {
            p { "Profit is fares less passenger and energy cost (Eq. 5 of the paper). Every policy met the same days. No training of a "
                "shipped policy has drawn one of these networks." }
            p { "Files beside this page: " a href="networks.csv" { "networks.csv" } ", every policy’s day of every network; "
                a href="summary.json" { "summary.json" } ", all numbers of this page"
                (page::links(figures)) "." }
        }
    }
}
