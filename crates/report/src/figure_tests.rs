//! Properties of every figure: it is well-formed, its texts fit into it, it can be converted to
//! PNG, and it names its marks.

use resvg::usvg::roxmltree::Document;
use vertifleet_picture::palette::style_sheet;
use vertifleet_picture::png;
use vertifleet_sim::DayTotals;

use vertifleet_study::{
    ComparisonRecords, ComparisonReport, DayRecord, LatencySummary, LearningCurve, NetworkOrigin,
    PolicyRecord, ValidationCurves,
};

use super::{Figure, of_comparison as all};

/// A name that a user could give, with characters that XML treats specially or forbids.
const HOSTILE: &str = "a<b>&\"c'\u{0}\u{ffff} with a name much longer than any row";

fn summary(names: &[&str], days: u32) -> ComparisonReport {
    ComparisonReport::of(&study(names, days)).expect("a sound study")
}

/// The same study with an upper bound for every day.
fn bounded(names: &[&str], days: u32) -> ComparisonReport {
    let mut study = study(names, days);
    study.bound_step_s = Some(180);
    for day in study.policies.iter_mut().flat_map(|policy| &mut policy.days) {
        day.upper_bound_usd = Some(3_500.0 + day.totals.profit_usd / 10.0);
    }
    ComparisonReport::of(&study).expect("a sound study")
}

fn study(names: &[&str], days: u32) -> ComparisonRecords {
    let policies = names.iter().zip(0u32..).map(|(&name, policy)| PolicyRecord {
        name: name.to_owned(),
        description: String::new(),
        days: (0..days).map(|day| record(policy, day)).collect(),
        // Every third policy is a reference that knows the day in advance.
        sees: vertifleet_study::Sees::Present,
        weights_sha256: None,
        training_seed: None,
        decision_ns: (policy % 3 != 2).then(LatencySummary::default),
    });
    let curves = names.iter().zip(0u32..).map(|(&name, policy)| LearningCurve {
        name: name.to_owned(),
        points: (0..4)
            .map(|step| (u64::from(step) * 500, f64::from(step + policy) / 20.0))
            .chain([(9_999, f64::NAN)])
            .collect(),
    });
    ComparisonRecords {
        network: "small & odd".to_owned(),
        network_origin: NetworkOrigin::Own,
        seed: Some(3),
        split: vertifleet_core::Purpose::Comparison,
        days_from: None,
        days: days as usize,
        bound_step_s: None,
        command: "vertifleet compare".to_owned(),
        trainings: curves
            .clone()
            .map(|curve: LearningCurve| ValidationCurves {
                name: curve.name,
                runs: vec![curve.points[..2].to_vec(), curve.points[..3].to_vec()],
            })
            .collect(),
        curves: curves.collect(),
        policies: policies.collect(),
        replayed: Vec::new(),
    }
}

/// The last policy earns most; the third day is an outlier.
fn record(policy: u32, day: u32) -> DayRecord {
    let odd = if day == 2 { 900.0 } else { 0.0 };
    let profit_usd = 1_000.0 + f64::from(100 * policy + 10 * (day * 7 % 5)) + odd;
    DayRecord {
        day: format!("day-{day}"),
        seed: u64::from(day),
        totals: DayTotals {
            profit_usd,
            revenue_usd: 3_000.0,
            passenger_cost_usd: 1_500.0,
            energy_cost_usd: 100.0,
            flight_cost_usd: 0.0,
            aircraft_cost_usd: 0.0,
            site_cost_usd: 0.0,
            energy_kwh: 500.0,
            potential_usd: 10_000.0,
            reward: profit_usd / 10_000.0,
            flights: 30,
            repositioning_flights: 2,
            holds: 5,
            decisions: 35,
            passengers: 100,
            spilled_passengers: 10,
            load_factor: 0.8,
        },
        upper_bound_usd: None,
        choices: Vec::new(),
    }
}

fn slugs(figures: &[Figure]) -> Vec<&str> {
    figures.iter().map(|figure| &*figure.slug).collect()
}

#[test]
fn the_box_plot_of_a_small_study() {
    let figures = all(&summary(&["random", "greedy"], 6));
    insta::assert_snapshot!(figures[0].svg);
}

#[test]
fn the_learning_curves_of_a_small_study() {
    let figures = all(&summary(&["random", "greedy"], 6));
    insta::assert_snapshot!(figures[3].svg);
}

#[test]
fn any_name_and_any_number_of_days_make_well_formed_pictures() {
    let many: Vec<String> =
        (0..14).map(|policy| format!("policy number {policy} of many")).collect();
    let many: Vec<&str> = many.iter().map(String::as_str).collect();
    for (names, days) in
        [(vec![HOSTILE, "greedy"], 5), (many, 3), (vec!["alone"], 1), (vec!["a", "b"], 450)]
    {
        for figure in all(&bounded(&names, days)) {
            let document = Document::parse(&figure.svg).expect("well-formed XML");
            for text in document.descendants().filter(|node| node.has_tag_name("text")) {
                let place = |name| text.attribute(name).and_then(|value| value.parse::<f64>().ok());
                assert!(place("x").is_some_and(|x| (0.0..=760.0).contains(&x)), "{}", figure.slug);
            }
            assert!(!figure.svg.contains("NaN") && !figure.svg.contains("inf"), "{}", figure.slug);
            assert!(png(&figure.svg).starts_with(b"\x89PNG"));
        }
    }
}

#[test]
fn a_figure_is_drawn_only_where_there_are_numbers_for_it() {
    let full = summary(&["random", "greedy"], 4);
    let whole = [
        "figure-5-profit",
        "figure-4-reward",
        "figure-day-by-day",
        "figure-3-learning-curves",
        "figure-validation-curves",
    ];
    assert_eq!(slugs(&all(&full)), whole);

    let with_bounds = all(&bounded(&["random", "greedy"], 4));
    assert!(
        with_bounds[1].svg.contains(">bound</text>") && with_bounds[1].svg.contains(">100</text>")
    );
    let with_bounds = slugs(&with_bounds);
    assert_eq!(with_bounds[1], "figure-bound-share");
    assert_eq!([&with_bounds[..1], &with_bounds[2..]].concat(), whole);

    let untrained = ComparisonReport { curves: Vec::new(), trainings: Vec::new(), ..full };
    assert_eq!(slugs(&all(&untrained)), whole[..3]);
    let alone =
        ComparisonReport { curves: Vec::new(), trainings: Vec::new(), ..summary(&["greedy"], 4) };
    assert_eq!(slugs(&all(&alone)), whole[..2]);
}

#[test]
fn letters_of_a_png_come_from_the_embedded_font() {
    let figure = |label: &str| {
        format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='90' height='20'><text y='15'>{label}</text></svg>"
        )
    };
    assert_ne!(png(&figure("−$1,234 ± µ")), png(&figure("")));
}

#[test]
fn every_class_of_a_figure_has_a_colour_on_dark_ground() {
    let rules = style_sheet();
    for figure in all(&summary(&["a", "b", "c"], 6)) {
        let document = Document::parse(&figure.svg).expect("well-formed XML");
        let classes = document.descendants().filter_map(|node| node.attribute("class"));
        for class in classes.flat_map(str::split_whitespace) {
            assert!(rules.contains(&format!(".{class}{{")), "{class}");
        }
    }
}
