//! `report.html` of a comparison.

use maud::{Markup, html};
use vertifleet_core::Purpose;
use vertifleet_picture::numbers::{
    counted, dollars, duration, grouped, minutes, p_statement, signed_dollars, typeset,
};

use super::headline;
use super::summary::{ComparisonReport, PolicySummary};
use crate::figure::Figure;
use crate::origin::NetworkOrigin;
use crate::page::{document, estimate, links, picture, replay_frame};
use crate::published::{NOTE, PublishedResult};

/// The replay of days, which is shown within the page.
#[derive(Debug)]
pub(crate) struct Replay<'a> {
    /// The number of days.
    pub(crate) days: usize,
    /// The page that replays them.
    pub(crate) page: &'a str,
}

/// The page as HTML. The other files of the report stand beside it, or it is all that there is.
pub(crate) fn text(
    summary: &ComparisonReport,
    figures: &[Figure],
    replayed: Option<&Replay<'_>>,
    has_files: bool,
) -> String {
    let body = html! {
        (opening(summary))
        (results(summary))
        @if let Some(replayed) = replayed { (replay(replayed, has_files)) }
        h2 { "Figures" }
        @for figure in figures { (picture(figure)) }
        @if !summary.comparisons.is_empty() { (tests(summary)) }
        @if !summary.trainings.is_empty() { (trainings(summary)) }
        @if !summary.published.is_empty() { (published(summary)) }
        (closing(has_files.then_some(figures)))
    };
    document(&format!("Vertifleet comparison: {}", summary.network), &body)
}

fn opening(summary: &ComparisonReport) -> Markup {
    let days = match summary.days_from {
        None => counted(summary.days, "unseen day", "unseen days"),
        Some(_) => counted(summary.days, "day", "days"),
    };
    let changed = summary.network_origin == NetworkOrigin::Changed;
    html! {
        p.program { "Vertifleet " (summary.program_version) " · comparison of policies" }
        h1 { (counted_competitors(summary)) " on " (days) }
        p.headline { (headline::text(summary)) }
        dl {
            div { dt { "Network" } dd { (summary.network) ", " (origin(summary.network_origin)) } }
            div { dt { "Days" } dd { (summary.days) } }
            @if let Some(from) = &summary.days_from {
                div { dt { "Days of one’s own" } dd { (from) } }
            }
            @if let Some(seed) = summary.seed { div { dt { "Seed" } dd { (seed) } } }
            @if summary.split != Purpose::Comparison {
                div { dt { "Days of" } dd { (summary.split.name()) ", not for results" } }
            }
            @if let Some((first, last)) = summary.day_seeds {
                div { dt { "Days drawn from seeds" } dd { (first) " to " (last) } }
            }
            @if let Some(bound) = &summary.bound {
                div { dt { "Upper bound a day" } dd { (dollars(bound.upper_bound_usd.mean)) } }
            }
        }
        @if changed {
            p { "These days are of a changed copy of the network “" (summary.network) "”, not of the network that "
                "Vertifleet ships under that name. What was published or measured of the shipped network does not apply "
                "here, and the shipped policies were trained on days of that one." }
        }
        pre { (summary.command) }
    }
}

/// A remark about the origin of the network.
fn origin(origin: NetworkOrigin) -> &'static str {
    match origin {
        NetworkOrigin::Shipped => "as shipped",
        NetworkOrigin::Changed => "changed",
        NetworkOrigin::Own => "not shipped",
    }
}

/// A text such as `4 policies and 1 reference`.
fn counted_competitors(summary: &ComparisonReport) -> String {
    let references = summary.policies.iter().filter(|policy| policy.knows_the_day()).count();
    let policies = summary.policies.len() - references;
    let counts = [
        (policies, counted(policies, "policy", "policies")),
        (references, counted(references, "reference", "references")),
    ];
    let present = counts.into_iter().filter(|(count, _)| *count > 0).map(|(_, text)| text);
    present.collect::<Vec<_>>().join(" and ")
}

fn results(summary: &ComparisonReport) -> Markup {
    html! {
        h2 { "Results" }
        p.lead { "Means a day, highest profit first. ± is the 95 % interval of the mean (Student’s t), sd the standard "
            "deviation between days."
            @if let Some(bound) = &summary.bound {
                " Of bound: profit as a share of what is proven that no schedule of the day earns more than (slices of "
                (minutes(bound.step_s)) ")."
            }
            @if summary.policies.iter().any(PolicySummary::knows_the_day) {
                " What knows the day plans it as a whole, beforehand: a reference, no policy."
            } }
        div.wide { table {
            thead { tr {
                th scope="col" { "policy" }
                th scope="col" { "sees" }
                th scope="col" { "profit, $" }
                th scope="col" { "sd, $" }
                @if summary.bound.is_some() { th scope="col" { "of bound, %" } }
                th scope="col" { "reward" }
                th scope="col" { "sd" }
                th scope="col" { "flights" }
                th scope="col" { "reposition" }
                th scope="col" { "holds" }
                th scope="col" { "passengers" }
                th scope="col" { "load" br; "factor" }
                th scope="col" { "time per decision" br; small { "median / 99 %" } }
            } }
            tbody { @for (position, policy) in summary.policies.iter().enumerate() {
                tr.best[position == summary.best_position()] { (result_cells(policy)) }
            } }
        } }
        ul.descriptions { @for policy in &summary.policies {
            @if !policy.description.is_empty() { li { b { (policy.name) } ": " (policy.description) } }
        } }
    }
}

fn result_cells(policy: &PolicySummary) -> Markup {
    html! {
        th scope="row" title=(policy.name) {
            (policy.name)
        }
        td { (policy.sees) }
        td { (estimate(&policy.profit_usd, |value| grouped(value, 0))) }
        td { (policy.profit_usd.standard_deviation.map_or("n/a".to_owned(), |value| grouped(value, 0))) }
        @if let Some(share) = &policy.bound_share {
            td { (estimate(share, |value| grouped(100.0 * value, 2))) }
        }
        td { (estimate(&policy.reward, |value| format!("{value:.4}"))) }
        td { (policy.reward.standard_deviation.map_or("n/a".to_owned(), |value| format!("{value:.5}"))) }
        td { (grouped(policy.flights, 1)) }
        td { (grouped(policy.repositioning_flights, 1)) }
        td { (grouped(policy.holds, 1)) }
        td { (grouped(policy.passengers, 1)) }
        td { (format!("{:.3}", policy.load_factor)) }
        @if let Some(latency) = policy.decision_ns {
            td { (duration(latency.median)) small { " / " (duration(latency.p99)) } }
        } @else {
            td { "n/a" }
        }
    }
}

fn tests(summary: &ComparisonReport) -> Markup {
    html! {
        h2 { "Paired t-tests" }
        p.lead { "Mean difference of the daily profit, row minus column, on the same days. Two-sided p, not adjusted for "
            "the number of tests; tinted below 0.05." }
        div.wide { table.tests {
            thead { tr {
                th scope="col" { "row − column" }
                @for policy in &summary.policies { th scope="col" { (policy.name) } }
            } }
            tbody { @for row in 0..summary.policies.len() { tr {
                th scope="row" { (summary.policies[row].name) }
                @for column in 0..summary.policies.len() { (test_cell(summary, row, column)) }
            } } }
        } }
    }
}

fn test_cell(summary: &ComparisonReport, row: usize, column: usize) -> Markup {
    let pair = (row.min(column), row.max(column));
    let Some(comparison) = summary.comparisons.iter().find(|comparison| comparison.pair == pair)
    else {
        return html! { td { "" } };
    };
    let test = &comparison.profit_usd;
    let sign = if row < column { 1.0 } else { -1.0 };
    html! {
        td.clear[test.is_significant()] {
            (signed_dollars(sign * test.difference.mean)) small { (p_statement(test.p_value)) }
        }
    }
}

fn trainings(summary: &ComparisonReport) -> Markup {
    let reward = |value: f64| format!("{value:.5}");
    html! {
        h2 { "Training" }
        p.lead { "Mean reward at the end of training, with best choices, on the validation days of the network “"
            (summary.network) "”, on which these policies were trained; they are not the days of this report. Runs "
            "differ in their seeds alone, and the weights of the first one play here. sd: standard deviation between "
            "runs." }
        div.wide { table {
            thead { tr {
                th scope="col" { "policy" }
                th scope="col" { "runs" }
                th scope="col" { "decisions learned from" }
                th scope="col" { "validation reward" }
                th scope="col" { "sd" }
                th scope="col" { "lowest" }
                th scope="col" { "highest" }
            } }
            tbody { @for training in &summary.trainings { tr {
                th scope="row" { (training.policy) }
                td { (training.runs) }
                td { (grouped(training.decisions, 0)) }
                td { (reward(training.validation_reward.mean)) }
                td { (training.validation_reward.standard_deviation.map_or("n/a".to_owned(), reward)) }
                td { (reward(training.range.0)) }
                td { (reward(training.range.1)) }
            } } }
        } }
    }
}

fn published(summary: &ComparisonReport) -> Markup {
    html! {
        h2 { "Beside the published figures" }
        p.lead { "§V.B of S. Paul and S. Chowdhury, “A Graph-based Reinforcement Learning Framework for Urban Air "
            "Mobility Fleet Scheduling”, on its authors’ 100 test days; ours on the days of this report. ± is the standard "
            "deviation between days, as the paper gives it." }
        div.wide { table {
            thead {
                tr {
                    th.group { "" }
                    th.group colspan="3" { "published" }
                    th.group.second colspan="4" { "this run" }
                }
                tr {
                    th scope="col" { "method" }
                    th scope="col" { "profit, $" }
                    th scope="col" { "flights" }
                    th.before-second scope="col" { "reward, end of training" }
                    th.second scope="col" { "policy" }
                    th scope="col" { "profit, $" }
                    th scope="col" { "flights" }
                    th scope="col" { "reward" }
                }
            }
            tbody { @for result in summary.published { tr { (published_cells(summary, result)) } } }
        } }
        div.note { @for paragraph in NOTE { p { (paragraph) } } }
    }
}

fn published_cells(summary: &ComparisonReport, result: &PublishedResult) -> Markup {
    let ours = summary.policies.iter().find(|policy| policy.name == result.policy);
    html! {
        th scope="row" { (result.name) }
        td { (grouped(result.profit_usd, 0)) small { " ± " (grouped(result.standard_deviation_usd, 0)) } }
        td { (grouped(result.flights, 0)) }
        td.before-second { (result.reward_at_convergence.map_or("not stated".to_owned(), |reward| format!("about {reward:.3}"))) }
        td.second { (result.policy) }
        @if let Some(policy) = ours {
            td {
                (typeset(&grouped(policy.profit_usd.mean, 0)))
                @if let Some(deviation) = policy.profit_usd.standard_deviation {
                    small { " ± " (grouped(deviation, 0)) }
                }
            }
            td { (grouped(policy.flights, 0)) }
            td { (format!("{:.3}", policy.reward.mean)) }
        } @else {
            td colspan="3" { "not in this run" }
        }
    }
}

/// The days that can be watched, in a frame of their own, which keeps their style and their scripts
/// apart from the page.
fn replay(&Replay { days, page }: &Replay<'_>, has_files: bool) -> Markup {
    let which =
        if days == 1 { "The first day".to_owned() } else { format!("The first {days} days") };
    html! {
        h2 { "Replay" }
        p { (which) " as each policy played " (if days == 1 { "it" } else { "them" })
            ": on a map, along the day, and two policies side by side with their first difference."
            @if has_files {
                " The file " a href="replay.html" { "replay.html" } " shows the same in a whole window."
            } }
        (replay_frame(page))
    }
}

/// What to know about the page, and links to the files beside it.
fn closing(files: Option<&[Figure]>) -> Markup {
    html! {
        footer {
            p { "Profit is fares less passenger and energy cost (Eq. 5 of the paper), and less what flights and aircraft cost beside "
                "them where the network says so. Reward is profit as a share of the "
                "revenue if every passenger flew (§III.H). Every policy met the same days. What the paper leaves open, and "
                "what was assumed instead, is listed under " em { "Concepts: the model" } " in Vertifleet’s documentation." }
            @if let Some(figures) = files {
                p { "Files beside this page: " a href="days.csv" { "days.csv" } ", every policy’s every day; "
                    a href="summary.json" { "summary.json" } ", all numbers of this page"
                    (links(figures)) "." }
            }
        }
    }
}
