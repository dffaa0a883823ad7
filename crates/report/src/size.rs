//! The report of a search for a design.

use vertifleet_export::{Cells, TypedColumn, csv_table};
use vertifleet_picture::numbers::{counted, grouped, minutes, signed};
use vertifleet_study::size::{DesignSummary, SizeReport};

use crate::figure;
use crate::report::{DataFile, Files, Place, Report, Section, Table, stands};
use crate::size_headline::headline;

/// The report of a search with its files. `best` is the network file of the design that was found.
pub fn size<'a>(report: &'a SizeReport, best: &'a str) -> Report<'a> {
    let mut facts = vec![
        ("Policy", report.policy.clone()),
        ("Designs played", report.designs.len().to_string()),
        ("Days of each design", format!("{} ({})", report.days, report.split)),
        ("Passengers who want to fly", format!("{} a day", grouped(report.wanted_passengers, 0))),
    ];
    let need = report.needed_passengers;
    facts.extend(need.map(|need| ("Passengers to carry", format!("{} a day", grouped(need, 0)))));
    facts.push(("Slices of the bounds", minutes(report.bound_step_s)));
    let json = || (report.to_json() + "\n").into_bytes();
    Report {
        title: format!("Sizing {}", report.network),
        subject: "how many aircraft, stands and chargers",
        heading: format!("A design of “{}” for the goal {}", report.network, report.goal),
        headline: headline(report),
        facts,
        command: report.command.clone(),
        sections: vec![
            dimensions(report),
            Section { place: Place::Terminal, ..designs_that_matter(report) },
            Section { place: Place::Page, ..designs(report) },
        ],
        closing: vec![
            "The best of many designs looks better than it is on the days that it was chosen on. The rows of further days \
             do not have this bias."
                .to_owned(),
        ],
        files: Files::Beside(vec![
            DataFile::new("best.toml", "the network file of the design", || best.as_bytes().to_vec()),
            DataFile::new("designs.csv", "the designs in the order of play", || csv_table(&columns(report))),
            DataFile::new("summary.json", "all numbers of this page", json),
        ]),
        ..Report::default()
    }
}

/// The dimensions that were searched.
fn dimensions(report: &SizeReport) -> Section {
    let is_money = report.goal == "profit";
    let unit = if is_money { "$" } else { "passengers" };
    let worth = format!("one more adds at most, {unit} a day");
    let row = |one: &vertifleet_study::size::DimensionSummary| {
        let step = if one.step > 1 { format!(" by {}", one.step) } else { String::new() };
        vec![
            one.member.clone(),
            format!("{} to {}{step}", one.lowest, one.highest),
            one.now.to_string(),
            one.found.to_string() + if one.is_at_limit() { " (limit)" } else { "" },
            signed(one.one_more_is_worth_at_most, usize::from(!is_money)),
        ]
    };
    let mut table = Table::new(["member", "searched", "now", "found", &worth])
        .with_rows(report.dimensions.iter().map(row));
    let changed = report.dimensions.iter().enumerate().filter(|(_, one)| one.found != one.now);
    table.best = changed.map(|(position, _)| position).collect();
    let more = if is_money { "earns more, after its cost," } else { "carries more" };
    let figures = figure::of_size(report);
    Section { figures, ..Section::of_table("Result", table) }.with_note(format!(
        "the bound proves what one more adds: with one more of it and the rest as found, no schedule of the days {more} than the \
         bound of this design plus this amount"
    ))
}

const NUMBERS: [&str; 6] =
    ["aircraft", "stands", "fixed cost, $ a day", "profit, $ a day", "passengers a day", "served"];

fn numbers(design: &DesignSummary) -> [String; 6] {
    [
        design.size.aircraft.to_string(),
        stands(&design.size),
        grouped(design.size.fixed_cost_usd, 0),
        design.profit_usd.written(|usd| grouped(usd, 0)),
        grouped(design.passengers, 0),
        format!("{:.1} %", 100.0 * design.served_share),
    ]
}

/// The current network and the design that was found, on the days of the search and on other days.
fn designs_that_matter(report: &SizeReport) -> Section {
    let row = |name: &str, design: &DesignSummary| {
        [name.to_owned()].into_iter().chain(numbers(design)).collect()
    };
    let (start, found) = (report.name_of_start(), report.name_of_best());
    let table = Table::new([""].into_iter().chain(NUMBERS)).with_rows([
        row(start, report.as_it_is()),
        row(found, report.found()),
        row(&format!("{start}, further days"), &report.now_on_holdout),
        row(&format!("{found}, further days"), &report.best_on_holdout),
    ]);
    Section::of_table("Designs", table)
}

/// All designs in the order of play.
fn designs(report: &SizeReport) -> Section {
    let bound = if report.goal == "profit" { "bound of profit, $" } else { "bound of passengers" };
    let members = report.dimensions.iter().map(|one| one.member.as_str());
    let columns = ["design"].into_iter().chain(members).chain(NUMBERS).chain([bound]);
    let row = |name: String, design: &DesignSummary| {
        let members = design.numbers.iter().map(u32::to_string);
        let bound = [grouped(design.ceiling, 0)];
        [name].into_iter().chain(members).chain(numbers(design)).chain(bound).collect()
    };
    let name = |number: usize| match number {
        _ if number == report.best => format!("{number}, {}", report.name_of_best()),
        _ if number == report.now => format!("{number}, {}", report.name_of_start()),
        _ => number.to_string(),
    };
    let played = report.designs.iter().enumerate().map(|(number, one)| row(name(number), one));
    let further = [
        row(format!("{}, further days", report.name_of_start()), &report.now_on_holdout),
        row(format!("{}, further days", report.name_of_best()), &report.best_on_holdout),
    ];
    let mut table = Table::new(columns).with_rows(played.chain(further));
    table.best = vec![report.best];
    let count = counted(report.designs.len(), "design was", "designs were");
    Section::of_table("Designs", table)
        .with_note(format!(
            "{count} played, in this order; ± is the 95 % interval of the mean over the days"
        ))
        .with_note(
            "fixed cost is the daily cost of fleet, stands and chargers; profits are net of it",
        )
        .with_note("the bound holds for the design under any policy")
}

/// The columns of `designs.csv`.
fn columns(report: &SizeReport) -> Vec<TypedColumn> {
    let all = &report.designs;
    let whole = |name: &str, number: &dyn Fn(usize, &DesignSummary) -> i64| {
        let cells = all.iter().enumerate().map(|(at, design)| number(at, design));
        TypedColumn::new(name, Cells::Whole(cells.collect()))
    };
    let number = |name: &str, number: fn(&DesignSummary) -> f64| {
        TypedColumn::new(name, Cells::Number(all.iter().map(number).collect()))
    };
    let count = |count: usize| i64::try_from(count).expect("counts are far below 2^63");
    let half = all.iter().map(|one| one.profit_usd.half_width_95).collect();
    let mut columns = vec![whole("played", &|at, _| count(at))];
    columns.extend(
        report.dimensions.iter().enumerate().map(|(dimension, one)| {
            whole(&one.member, &|_, design| design.numbers[dimension].into())
        }),
    );
    columns.extend([
        whole("aircraft", &|_, one| count(one.size.aircraft)),
        whole("stands", &|_, one| one.size.stands.into()),
        whole("chargers", &|_, one| one.size.chargers.into()),
        number("fixed_cost_usd", |one| one.size.fixed_cost_usd),
        number("profit_usd", |one| one.profit_usd.mean),
        TypedColumn::new("profit_half_width_95", Cells::OptionalNumber(half)),
        number("passengers", |one| one.passengers),
        number("spilled_passengers", |one| one.spilled_passengers),
        number("served_share", |one| one.served_share),
        number("ceiling", |one| one.ceiling),
        whole("is_found", &|at, _| i64::from(at == report.best)),
    ]);
    columns
}
