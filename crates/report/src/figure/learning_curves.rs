//! Learning curves: mean reward against decisions learned from, on the training days (Fig. 3) and
//! on the validation days.

use vertifleet_picture::axis::Scale;
use vertifleet_picture::canvas::{Anchor, Canvas, Lettering, Look, Point, Stroke, shortened};
use vertifleet_picture::numbers::{grouped, typeset};
use vertifleet_picture::palette::{Paint, dash};

use super::Figure;
use super::key;
use vertifleet_study::ComparisonReport;
use vertifleet_study::NetworkOrigin;

const WIDTH: f64 = 760.0;
const LEFT: f64 = 70.0;
const RIGHT: f64 = 24.0;
/// The distance from the left end of a line of the key to its name.
const KEY_LINE: f64 = 41.0;
const PLOT_HEIGHT: f64 = 272.0;
const BOTTOM: f64 = 52.0;

/// Number of markers on a line: enough to distinguish lines in grey, few enough not to cover the
/// line.
const MARKERS: usize = 9;

/// The texts of a figure of this kind.
struct Chart {
    slug: &'static str,
    title: &'static str,
    subtitle: &'static str,
    axis: &'static str,
    days: &'static str,
    caption: &'static str,
}

const FIG_3: &str = "figure-3-learning-curves";

const ON_TRAINING_DAYS: Chart = Chart {
    slug: FIG_3,
    title: "Learning curves",
    subtitle: "Mean episode reward on the training days against steps of training",
    axis: "steps of training",
    days: "training days",
    caption: "Reward: profit as a share of the revenue if every passenger flew; a step is one decision.",
};

const ON_VALIDATION_DAYS: Chart = Chart {
    slug: "figure-validation-curves",
    title: "Learning curves on the validation days",
    subtitle: "Mean reward, best choices, against decisions learned from",
    axis: "decisions learned from",
    days: "validation days",
    caption: "Policies that learn in different ways, on one scale: decisions learned from are steps of PPO, and decisions whose choices were \
              tried out of gcaps-x. A thick line with marks is the run whose weights play; thin lines are runs with other \
              seeds. Every policy looks at as many validation days as its settings say.",
};

/// The training runs of a policy; the first is the run whose weights play.
struct PolicyCurves<'a> {
    name: &'a str,
    runs: Vec<Vec<Point>>,
}

/// A policy's lines in pixels, and the series that gives their colour, dash and marker.
struct Lines {
    name: String,
    series: usize,
    runs: Vec<Vec<Point>>,
}

/// Fig. 3; `None` if no curve has a point.
pub(super) fn on_training_days(summary: &ComparisonReport) -> Option<Figure> {
    let policies = summary
        .curves
        .iter()
        .map(|curve| PolicyCurves { name: &curve.name, runs: vec![defined(&curve.points)] });
    draw(summary, &ON_TRAINING_DAYS, policies.collect())
}

/// The learning curves on the validation days, with a line for each run; `None` if no policy was
/// trained.
pub(super) fn on_validation_days(summary: &ComparisonReport) -> Option<Figure> {
    let policies = summary.trainings.iter().map(|training| PolicyCurves {
        name: &training.policy,
        runs: training.curves.iter().map(|run| defined(run)).collect(),
    });
    draw(summary, &ON_VALIDATION_DAYS, policies.collect())
}

/// The points of a curve; before the first day ends there is no mean reward to draw.
fn defined(points: &[(u64, f64)]) -> Vec<Point> {
    let points = points.iter().filter(|point| point.1.is_finite());
    points.map(|&(steps, reward)| (steps as f64, reward)).collect()
}

fn draw(
    summary: &ComparisonReport,
    chart: &Chart,
    mut policies: Vec<PolicyCurves<'_>>,
) -> Option<Figure> {
    policies.retain(|policy| policy.runs.iter().any(|run| !run.is_empty()));
    if policies.is_empty() {
        return None;
    }
    let names: Vec<String> = policies.iter().map(|policy| shortened(policy.name, 22)).collect();
    let (places, last_row) = key::places(&names, KEY_LINE, WIDTH);
    let top = last_row + 24.0;
    let floor = top + PLOT_HEIGHT;
    let values = || policies.iter().flat_map(|policy| &policy.runs).flatten();
    let x = Scale::around(values().map(|p| p.0).chain([0.0]), LEFT, WIDTH - RIGHT, 6);
    let y = Scale::around(values().map(|p| p.1), floor, top, 6);
    let pixels = |run: &Vec<Point>| run.iter().map(|p| (x.pixel(p.0), y.pixel(p.1))).collect();
    let lines = policies.iter().zip(names).enumerate().map(|(position, (policy, name))| Lines {
        name,
        series: series(summary, policy.name, position),
        runs: policy.runs.iter().map(pixels).collect(),
    });
    let lines: Vec<Lines> = lines.collect();

    let mut canvas = Canvas::new(WIDTH, floor + BOTTOM, chart.title, chart.subtitle);
    draw_axes(&mut canvas, &x, chart.axis, &y, floor);
    for lines in &lines {
        draw_lines(&mut canvas, lines);
    }
    for (lines, place) in lines.iter().zip(places) {
        draw_key(&mut canvas, lines, place);
    }
    Some(Figure {
        slug: chart.slug.into(),
        caption: caption(summary, chart),
        svg: canvas.into_svg(),
    })
}

/// Names the network of the curves' days: every policy that has a curve was trained on the network
/// of the study.
fn caption(summary: &ComparisonReport, chart: &Chart) -> String {
    let fig_3 = match chart.slug {
        FIG_3 if summary.is_of_the_paper() => "Corresponds to Fig. 3 of the paper. ",
        _ => "",
    };
    let network = &summary.network;
    let perhaps = match summary.network_origin {
        NetworkOrigin::Changed => {
            " as it was when the policy was trained, perhaps before it was changed"
        }
        _ => "",
    };
    let days = chart.days;
    format!(
        "{fig_3}On {days} of the network “{network}”{perhaps}, not on those compared here. {}",
        chart.caption
    )
}

/// The curve of a policy in the study has the policy's series; other curves take a series that no
/// policy has.
fn series(summary: &ComparisonReport, name: &str, position: usize) -> usize {
    let policy = summary.policies.iter().position(|policy| policy.name == name);
    policy.unwrap_or(summary.policies.len() + position)
}

fn draw_axes(canvas: &mut Canvas, x: &Scale, axis: &str, y: &Scale, floor: f64) {
    let decimals = y.decimals(1.0);
    for tick in y.ticks() {
        let height = y.pixel(tick);
        canvas.line((LEFT, height), (WIDTH - RIGHT, height), Stroke::solid(Paint::Grid, 1.0));
        let label = typeset(&grouped(tick, decimals));
        canvas.text((LEFT - 8.0, height + 4.0), Lettering::SMALL.anchored(Anchor::End), &label);
    }
    let steps = x.ticks();
    let (unit, name) = match steps.last() {
        Some(&last) if last >= 1e6 => (1e6, format!("{axis}, millions")),
        Some(&last) if last >= 1e4 => (1e3, format!("{axis}, thousands")),
        _ => (1.0, axis.to_owned()),
    };
    let decimals = x.decimals(unit);
    for tick in steps {
        let place = x.pixel(tick);
        canvas.line((place, floor), (place, floor + 4.0), Stroke::solid(Paint::Muted, 1.0));
        let label = format!("{:.decimals$}", tick / unit);
        canvas.text((place, floor + 18.0), Lettering::SMALL.anchored(Anchor::Middle), &label);
    }
    canvas.line((LEFT, floor), (WIDTH - RIGHT, floor), Stroke::solid(Paint::Muted, 1.0));
    let middle = f64::midpoint(LEFT, WIDTH - RIGHT);
    canvas.text((middle, floor + 38.0), Lettering::SMALL.anchored(Anchor::Middle), &name);
}

fn draw_lines(canvas: &mut Canvas, lines: &Lines) {
    let Some((played, others)) = lines.runs.split_first() else { return };
    let (paint, dash) = (Paint::Series(lines.series), dash(lines.series));
    for run in others {
        canvas.polyline(run, false, Look::outlined(Stroke { paint, width: 1.0, dash }));
    }
    canvas.polyline(played, false, Look::outlined(Stroke { paint, width: 2.0, dash }));
    // Each series starts its markers a little later, so that the markers of lines that run together
    // do not overlap.
    let every = (played.len() / MARKERS).max(1);
    let first = (lines.series * every / 3) % every;
    for &point in played.iter().skip(first).step_by(every) {
        canvas.marker(point, lines.series);
    }
}

fn draw_key(canvas: &mut Canvas, lines: &Lines, (x, y): Point) {
    let stroke =
        Stroke { paint: Paint::Series(lines.series), width: 2.0, dash: dash(lines.series) };
    canvas.line((x, y), (x + 34.0, y), stroke);
    canvas.marker((x + 17.0, y), lines.series);
    canvas.text((x + KEY_LINE, y + 4.0), Lettering::LABEL, &lines.name);
}
