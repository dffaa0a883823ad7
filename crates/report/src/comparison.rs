//! The report of a comparison.

use std::fmt::Write as _;

use maud::{Markup, html};
use vertifleet_core::Purpose;
use vertifleet_picture::numbers::{counted, dollars, duration, grouped, minutes, p_value};
use vertifleet_study::comparison::{PairedDifference, PolicySummary};
use vertifleet_study::published::NOTE;
use vertifleet_study::record::ReplayedDay;
use vertifleet_study::statistics::Estimate;
use vertifleet_study::{ComparisonRecords, ComparisonReport, DayRecord, NetworkOrigin};

use crate::comparison_headline::headline;
use crate::figure;
use crate::report::{DataFile, Files, Place, Report, Section, Table, difference};

/// The note below tables with a column of information classes.
pub(crate) const SEES: &str =
    "sees: the present; the forecast too; or the whole day beforehand, a reference and no policy";

/// The text of a cell without a number.
pub(crate) const NONE: &str = "n/a";

/// The report of a comparison, as a page that needs no other file.
pub fn comparison<'a>(summary: &ComparisonReport, replayed: &'a [ReplayedDay]) -> Report<'a> {
    let days = match summary.days_from {
        None => counted(summary.days, "unseen day", "unseen days"),
        Some(_) => counted(summary.days, "day", "days"),
    };
    let mut sections = vec![results(summary)];
    sections.push(Section {
        title: "Figures".to_owned(),
        figures: figure::of_comparison(summary),
        place: Place::Page,
        ..Section::default()
    });
    if !summary.comparisons.is_empty() {
        sections.push(tests(summary));
    }
    sections.extend((!summary.trainings.is_empty()).then(|| trainings(summary)));
    sections.extend((!summary.published.is_empty()).then(|| published(summary)));
    Report {
        title: format!("Vertifleet comparison: {}", summary.network),
        opening: opening(summary),
        subject: "comparison of policies",
        heading: format!("{} on {days}", counted_competitors(summary)),
        headline: headline(summary),
        facts: facts(summary),
        command: summary.command.clone(),
        remarks: remarks(summary),
        sections,
        replayed,
        closing: vec![
            "Profit is fares less passenger and energy cost (Eq. 5 of the paper), and less what flights and aircraft cost \
             besides where the network has such costs. Reward is profit as a share of the revenue if every passenger flew \
             (§III.H). Every policy met the same days. Vertifleet’s documentation lists under “Concepts: the model” what the \
             paper leaves open, and what was assumed instead."
                .to_owned(),
        ],
        ..Report::default()
    }
}

/// The report of a comparison with its files, as a folder.
pub fn comparison_folder<'a>(
    summary: &'a ComparisonReport,
    records: &'a ComparisonRecords,
) -> Report<'a> {
    let files = vec![
        DataFile::new("days.csv", "every policy’s every day", || days_csv(records)),
        DataFile::new("summary.json", "all numbers of this page", || {
            (summary.to_json() + "\n").into_bytes()
        }),
    ];
    Report { files: Files::Beside(files), ..comparison(summary, &records.replayed) }
}

fn opening(summary: &ComparisonReport) -> String {
    let changed = if summary.network_origin == NetworkOrigin::Changed { " (changed)" } else { "" };
    let mut text =
        format!("network {}{changed}, {}", summary.network, counted(summary.days, "day", "days"));
    if let Some(first) = summary.seed {
        let _ = match summary.split {
            Purpose::Comparison => write!(text, ", seed {first}"),
            split => write!(text, ", {} days from number {first} on", split.name()),
        };
    }
    if let Some(from) = &summary.days_from {
        let _ = write!(text, " of one's own from {from}");
    }
    text
}

fn facts(summary: &ComparisonReport) -> Vec<(&'static str, String)> {
    let origin = match summary.network_origin {
        NetworkOrigin::Shipped => "as shipped",
        NetworkOrigin::Changed => "changed",
        NetworkOrigin::Own => "not shipped",
    };
    let mut facts = vec![
        ("Network", format!("{}, {origin}", summary.network)),
        ("Days", summary.days.to_string()),
    ];
    facts.extend(summary.days_from.clone().map(|from| ("Days of one’s own", from)));
    facts.extend(summary.seed.map(|seed| ("Seed", seed.to_string())));
    if summary.split != Purpose::Comparison {
        facts.push(("Days of", format!("{}, not for results", summary.split.name())));
    }
    let seeds = |(first, last)| ("Days drawn from seeds", format!("{first} to {last}"));
    facts.extend(summary.day_seeds.map(seeds));
    let bound_usd = summary.bound.as_ref().map(|bound| bound.upper_bound_usd.mean);
    facts.extend(bound_usd.map(|usd| ("Upper bound a day", dollars(usd))));
    facts
}

fn remarks(summary: &ComparisonReport) -> Vec<String> {
    let changed = format!(
        "These days are of a changed copy of the network “{}”, not of the network that Vertifleet ships under that name. \
         Published and measured results of the shipped network do not apply here, and the shipped policies were trained on \
         days of that one.",
        summary.network
    );
    (summary.network_origin == NetworkOrigin::Changed).then_some(changed).into_iter().collect()
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

/// A row for each policy, highest profit first.
fn results(summary: &ComparisonReport) -> Section {
    const SHARE_COLUMN: usize = 4;
    let mut table = Table::new([
        "policy",
        "sees",
        "profit, $ a day",
        "sd, $",
        "of bound, %",
        "reward",
        "sd",
        "flights",
        "reposition",
        "holds",
        "passengers",
        "load factor",
        "decision median",
        "p99",
    ])
    .with_rows(summary.policies.iter().map(policy_row));
    let mut notes = vec!["means a day; ± is the 95 % interval of the mean".to_owned()];
    match &summary.bound {
        None => table.rows.iter_mut().for_each(|row| drop(row.remove(SHARE_COLUMN))),
        Some(bound) => notes.push(format!(
            "of bound: share of the certified bound, which no schedule passes: $ {} (slices of {})",
            bound.upper_bound_usd.written(|value| grouped(value, 0)),
            minutes(bound.step_s)
        )),
    }
    notes.push(SEES.to_owned());
    table.best = vec![summary.best_position()];
    let described = summary.policies.iter().filter(|policy| !policy.description.is_empty());
    let below = html! {
        ul.descriptions { @for policy in described { li { b { (policy.name) } ": " (policy.description) } } }
    };
    Section { notes, below: Some(below), ..Section::of_table("Results", table) }
}

fn policy_row(policy: &PolicySummary) -> Vec<String> {
    let time = |time: Option<u64>| time.map_or(NONE.to_owned(), duration);
    let share = |share: &Estimate| share.written(|value| grouped(100.0 * value, 2));
    vec![
        policy.name.clone(),
        policy.sees.to_string(),
        policy.profit_usd.written(|value| grouped(value, 0)),
        policy.profit_usd.standard_deviation.map_or(NONE.to_owned(), |value| grouped(value, 0)),
        policy.bound_share.as_ref().map_or(NONE.to_owned(), share),
        policy.reward.written(|value| format!("{value:.4}")),
        policy.reward.standard_deviation.map_or(NONE.to_owned(), |value| format!("{value:.5}")),
        grouped(policy.flights, 1),
        grouped(policy.repositioning_flights, 1),
        grouped(policy.holds, 1),
        grouped(policy.passengers, 1),
        format!("{:.3}", policy.load_factor),
        time(policy.decision_ns.map(|time| time.median)),
        time(policy.decision_ns.map(|time| time.p99)),
    ]
}

/// A row for each pair of policies.
fn tests(summary: &ComparisonReport) -> Section {
    let row = |comparison: &PairedDifference| {
        let test = &comparison.profit_usd;
        vec![
            format!("{} - {}", comparison.first, comparison.second),
            difference(&test.difference, 1.0, 0),
            test.t.map_or(NONE.to_owned(), |t| grouped(t, 2)),
            test.degrees_of_freedom.to_string(),
            p_value(test.p_value),
            format!("{} of {}", test.first_larger, counted(summary.days, "day", "days")),
        ]
    };
    let table = Table::new(["first - second", "difference, $", "t", "df", "p", "first ahead"])
        .with_rows(summary.comparisons.iter().map(row));
    let section = Section::of_table("paired t-tests of the daily profit, two-sided", table);
    if summary.comparisons.len() < 2 {
        return section;
    }
    section.with_note(format!(
        "p is not corrected for the number of tests: of {} tests of equal policies, one in twenty has p < 0.05",
        summary.comparisons.len()
    ))
}

fn trainings(summary: &ComparisonReport) -> Section {
    let reward = |value: f64| format!("{value:.5}");
    let columns = [
        "policy",
        "runs",
        "decisions learned from",
        "validation reward",
        "sd",
        "lowest",
        "highest",
    ];
    let table = Table::new(columns).with_rows(summary.trainings.iter().map(|training| {
        let deviation = training.validation_reward.standard_deviation;
        vec![
            training.policy.clone(),
            training.runs.to_string(),
            grouped(training.decisions, 0),
            reward(training.validation_reward.mean),
            deviation.map_or(NONE.to_owned(), reward),
            reward(training.range.0),
            reward(training.range.1),
        ]
    }));
    let note = format!(
        "mean reward at the end of training, with best choices, on the validation days of the network “{}”, on which these \
         policies were trained; they are not the days of this report",
        summary.network
    );
    let section = Section { place: Place::Page, ..Section::of_table("Training", table) };
    section
        .with_note(note)
        .with_note("runs differ in their seeds alone, and the weights of the first one play here")
        .with_note("sd: standard deviation between runs")
}

fn published(summary: &ComparisonReport) -> Section {
    let columns = [
        "method",
        "published profit, $",
        "flights",
        "reward, end of training",
        "this run",
        "profit, $",
        "flights",
        "reward",
    ];
    let table = Table::new(columns).with_rows(summary.published.iter().map(|result| {
        let mut row = vec![
            result.name.to_owned(),
            format!(
                "{} ± {}",
                grouped(result.profit_usd, 0),
                grouped(result.standard_deviation_usd, 0)
            ),
            grouped(result.flights, 0),
            result
                .reward_at_convergence
                .map_or("not stated".to_owned(), |reward| format!("about {reward:.3}")),
            result.policy.to_owned(),
        ];
        match summary.policies.iter().find(|policy| policy.name == result.policy) {
            None => row.extend(["not in this run", "", ""].map(str::to_owned)),
            Some(ours) => {
                let deviation = ours.profit_usd.standard_deviation;
                let deviation = deviation.map(|deviation| format!(" ± {}", grouped(deviation, 0)));
                row.extend([
                    grouped(ours.profit_usd.mean, 0) + &deviation.unwrap_or_default(),
                    grouped(ours.flights, 0),
                    format!("{:.3}", ours.reward.mean),
                ]);
            }
        }
        row
    }));
    let below: Markup = html! { div.note { @for paragraph in NOTE { p { (paragraph) } } } };
    Section {
        below: Some(below),
        place: Place::Page,
        ..Section::of_table("Beside the published figures", table)
    }
    .with_note(
        "§V.B of S. Paul and S. Chowdhury, “A Graph-based Reinforcement Learning Framework for Urban Air Mobility Fleet \
         Scheduling”, on its authors’ 100 test days; ours on the days of this report",
    )
    .with_note("± is the standard deviation between days, as the paper gives it")
}

/// One row for every policy and day; policies in the order in which they were named.
fn days_csv(study: &ComparisonRecords) -> Vec<u8> {
    const TO_MEMORY: &str = "memory takes every row";
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    let days = || {
        study.policies.iter().flat_map(|policy| policy.days.iter().map(move |day| (policy, day)))
    };
    let (_, first) = days().next().expect("a study has a day");
    let names = first.totals.numbers().map(|(name, _)| name);
    let names = ["policy", "day", "seed"].into_iter().chain(names);
    writer.write_record(names.chain(["upper_bound_usd", "bound_share"])).expect(TO_MEMORY);
    for (policy, day) in days() {
        let DayRecord { day: name, seed, totals, upper_bound_usd, .. } = day;
        let row = (&policy.name, name, seed, totals, upper_bound_usd, day.bound_share());
        writer.serialize(row).expect(TO_MEMORY);
    }
    writer.into_inner().expect(TO_MEMORY)
}
