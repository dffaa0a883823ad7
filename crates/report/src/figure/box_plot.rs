//! Box plots of each policy's daily results (Fig. 4 and Fig. 5), also as a share of the upper
//! bound.
//!
//! Boxes are horizontal, one row per policy, so that names are readable and each day has a dot
//! below the box. Rows are named, so no information depends on colour.

use vertifleet_picture::axis::Scale;
use vertifleet_picture::canvas::{
    Anchor, Canvas, Lettering, Look, Point, Stroke, shortened, text_width,
};
use vertifleet_picture::numbers::{counted, dollars, grouped, minutes, typeset};
use vertifleet_picture::palette::Paint;

use super::Figure;
use vertifleet_study::ComparisonReport;
use vertifleet_study::comparison::PolicySummary;
use vertifleet_study::statistics::BoxSummary;

const WIDTH: f64 = 760.0;
const TOP: f64 = 96.0;
const ROW: f64 = 58.0;
const BOTTOM: f64 = 52.0;
const BOX_HEIGHT: f64 = 18.0;
const RIGHT: f64 = 92.0;
const LONGEST_NAME: usize = 22;

/// Largest number of days with dots: more would overlap and hide the box.
const MOST_DOTS: usize = 400;

/// The remark below the name of a reference.
const OFFLINE_REMARK: &str = "knows the day";

/// The quantity that a box plot shows for each policy.
struct Measure {
    slug: &'static str,
    title: &'static str,
    subtitle: String,
    axis: &'static str,
    daily: fn(&PolicySummary) -> &[f64],
    boxed: fn(&PolicySummary) -> &BoxSummary,
    mean: fn(&PolicySummary) -> f64,
    written: fn(f64) -> String,
    /// Writes a value of the axis with this many decimals.
    tick: fn(f64, usize) -> String,
    /// A limit that no value exceeds, with its name; drawn as a line.
    limit: Option<(f64, &'static str)>,
}

/// Fig. 5: profit per day.
pub(super) fn daily_profit(summary: &ComparisonReport) -> Figure {
    draw(
        summary,
        &Measure {
            slug: "figure-5-profit",
            title: "Daily profit",
            subtitle: subtitle(summary),
            axis: "profit a day, $",
            daily: |policy| &policy.daily_profit_usd,
            boxed: |policy| &policy.profit_box_usd,
            mean: |policy| policy.profit_usd.mean,
            written: dollars,
            tick: |value, _| dollars(value),
            limit: None,
        },
        corresponds(summary, "Corresponds to Fig. 5 of the paper. "),
    )
}

/// Fig. 4: episode reward per day.
pub(super) fn episode_reward(summary: &ComparisonReport) -> Figure {
    draw(
        summary,
        &Measure {
            slug: "figure-4-reward",
            title: "Episode reward",
            subtitle: subtitle(summary),
            axis: "profit as a share of the revenue if every passenger flew",
            daily: |policy| &policy.daily_reward,
            boxed: |policy| &policy.reward_box,
            mean: |policy| policy.reward.mean,
            written: |value| typeset(&grouped(value, 4)),
            tick: |value, decimals| typeset(&grouped(value, decimals)),
            limit: None,
        },
        corresponds(summary, "Corresponds to Fig. 4 of the paper. "),
    )
}

/// Profit of each day as a share of its upper bound; `None` if bounds were not asked for.
pub(super) fn bound_share(summary: &ComparisonReport) -> Option<Figure> {
    let bound = summary.bound?;
    summary.policies.iter().all(|policy| policy.bound_share_box.is_some()).then_some(())?;
    let measure = Measure {
        slug: "figure-bound-share",
        title: "Share of the upper bound",
        subtitle: subtitle(summary),
        axis: "daily profit as a share of the day’s upper bound, %",
        daily: |policy| &policy.daily_bound_share,
        boxed: |policy| policy.bound_share_box.as_ref().expect("every policy has shares"),
        mean: |policy| policy.bound_share.map_or(0.0, |share| share.mean),
        written: |value| typeset(&grouped(100.0 * value, 2)) + " %",
        tick: |value, decimals| typeset(&grouped(100.0 * value, decimals.saturating_sub(2))),
        limit: Some((1.0, "bound")),
    };
    let source = format!(
        "No schedule of a day earns more than its upper bound, the line at 100 % (proven with slices of {}). ",
        minutes(bound.step_s)
    );
    Some(draw(summary, &measure, &source))
}

/// The corresponding figure of the paper, if the days are those of the paper's network.
fn corresponds(summary: &ComparisonReport, source: &'static str) -> &'static str {
    if summary.is_of_the_paper() { source } else { "" }
}

fn subtitle(summary: &ComparisonReport) -> String {
    let days = counted(summary.days, "day", "days");
    format!(
        "{days} of the “{}” network, the same for every policy",
        shortened(&summary.network, 40)
    )
}

fn draw(summary: &ComparisonReport, measure: &Measure, source: &str) -> Figure {
    let policies = &summary.policies;
    let bottom = TOP + ROW * policies.len() as f64;
    let names = policies.iter().map(|policy| shortened(&policy.name, LONGEST_NAME));
    let remark = policies.iter().any(PolicySummary::knows_the_day).then_some(OFFLINE_REMARK);
    let least = remark.map_or(60.0, |remark| text_width(remark, 12.0));
    let left = names.map(|name| text_width(&name, 13.0)).fold(least, f64::max) + 32.0;
    let values = policies.iter().flat_map(|policy| (measure.daily)(policy).iter().copied());
    let limit = measure.limit.map(|(limit, _)| limit);
    let scale = Scale::around(values.chain(limit), left, WIDTH - RIGHT, 9);

    let mut canvas = Canvas::new(WIDTH, bottom + BOTTOM, measure.title, &measure.subtitle);
    let dots = summary.days <= MOST_DOTS;
    draw_key(&mut canvas, dots);
    let mean_heading = Lettering::SMALL.anchored(Anchor::End);
    canvas.text((WIDTH - 16.0, TOP - 8.0), mean_heading, "mean");
    draw_axis(&mut canvas, &scale, measure, (left, bottom));
    if let Some((limit, name)) = measure.limit {
        draw_limit(&mut canvas, scale.pixel(limit), name, bottom);
    }
    for (position, policy) in policies.iter().enumerate() {
        let middle = TOP + ROW * (position as f64 + 0.42);
        let name = shortened(&policy.name, LONGEST_NAME);
        let lettering = Lettering::LABEL.bold().anchored(Anchor::End);
        canvas.text((left - 14.0, middle + 4.5), lettering, &name);
        if policy.knows_the_day() {
            let lettering = Lettering::SMALL.anchored(Anchor::End);
            canvas.text((left - 14.0, middle + 19.0), lettering, OFFLINE_REMARK);
        }
        let mean = (measure.written)((measure.mean)(policy));
        canvas.text((WIDTH - 16.0, middle + 4.5), Lettering::LABEL.anchored(Anchor::End), &mean);
        if dots {
            draw_dots(&mut canvas, &scale, (measure.daily)(policy), middle + BOX_HEIGHT, position);
        }
        draw_box(&mut canvas, &scale, (measure.boxed)(policy), middle, Paint::Series(position));
        let mark =
            Look { fill: Some((Paint::Ground, 1.0)), stroke: Some(Stroke::solid(Paint::Ink, 1.4)) };
        canvas.diamond((scale.pixel((measure.mean)(policy)), middle), 4.6, mark);
    }
    Figure {
        slug: measure.slug.into(),
        caption: format!(
            "{source}Box: middle half of the days; line in it: median; whiskers: at most 1.5 times as long as the box."
        ),
        svg: canvas.into_svg(),
    }
}

fn draw_axis(canvas: &mut Canvas, scale: &Scale, measure: &Measure, (left, bottom): Point) {
    let decimals = scale.decimals(1.0);
    for tick in scale.ticks() {
        let x = scale.pixel(tick);
        canvas.line((x, TOP), (x, bottom), Stroke::solid(Paint::Grid, 1.0));
        let label = (measure.tick)(tick, decimals);
        canvas.text((x, bottom + 18.0), Lettering::SMALL.anchored(Anchor::Middle), &label);
    }
    canvas.line((left, bottom), (WIDTH - RIGHT, bottom), Stroke::solid(Paint::Muted, 1.0));
    let middle = f64::midpoint(left, WIDTH - RIGHT);
    canvas.text((middle, bottom + 38.0), Lettering::SMALL.anchored(Anchor::Middle), measure.axis);
}

fn draw_limit(canvas: &mut Canvas, x: f64, name: &str, bottom: f64) {
    let stroke = Stroke { paint: Paint::Ink, width: 1.4, dash: Some("6 4") };
    canvas.line((x, TOP), (x, bottom), stroke);
    canvas.text((x, TOP - 8.0), Lettering::SMALL.anchored(Anchor::Middle), name);
}

fn draw_box(canvas: &mut Canvas, scale: &Scale, summary: &BoxSummary, middle: f64, paint: Paint) {
    let x = |value| scale.pixel(value);
    let whisker = Stroke::solid(paint, 1.4);
    let half = BOX_HEIGHT / 2.0;
    for (from, to) in [
        (summary.low_whisker, summary.first_quartile),
        (summary.third_quartile, summary.high_whisker),
    ] {
        canvas.line((x(from), middle), (x(to), middle), whisker);
    }
    for end in [summary.low_whisker, summary.high_whisker] {
        canvas.line((x(end), middle - 5.0), (x(end), middle + 5.0), whisker);
    }
    let corner = (x(summary.first_quartile), middle - half);
    let size = (x(summary.third_quartile) - corner.0, BOX_HEIGHT);
    canvas.rectangle(corner, size, Look::filled(Paint::Ground));
    canvas.rectangle(corner, size, Look { fill: Some((paint, 0.22)), stroke: Some(whisker) });
    let median = x(summary.median);
    canvas.line((median, middle - half), (median, middle + half), Stroke::solid(paint, 2.6));
    for &outlier in &summary.outliers {
        canvas.circle((x(outlier), middle), 3.0, Look::outlined(whisker));
    }
}

/// One dot per day. Consecutive days stand at different heights, so that equal days do not hide
/// each other.
fn draw_dots(canvas: &mut Canvas, scale: &Scale, values: &[f64], top: f64, series: usize) {
    let look = Look { fill: Some((Paint::Series(series), 0.45)), stroke: None };
    for (position, &value) in values.iter().enumerate() {
        let height = (position * 5 % 8) as f64 * 1.5;
        canvas.circle((scale.pixel(value), top + height - 1.0), 1.7, look);
    }
}

fn draw_key(canvas: &mut Canvas, dots: bool) {
    let y = 72.0;
    let grey = Stroke::solid(Paint::Muted, 1.4);
    let text = Lettering::SMALL;
    let box_look = Look { fill: Some((Paint::Muted, 0.18)), stroke: Some(grey) };
    canvas.line((16.0, y), (46.0, y), grey);
    canvas.rectangle((22.0, y - 6.0), (18.0, 12.0), box_look);
    canvas.line((31.0, y - 6.0), (31.0, y + 6.0), Stroke::solid(Paint::Muted, 2.6));
    canvas.text((53.0, y + 4.0), text, "quartiles, median, whiskers");
    canvas.diamond((237.0, y), 4.6, Look::outlined(Stroke::solid(Paint::Ink, 1.4)));
    canvas.text((247.0, y + 4.0), text, "mean");
    canvas.circle((300.0, y), 3.0, Look::outlined(grey));
    canvas.text((309.0, y + 4.0), text, "outlier");
    if dots {
        canvas.circle((371.0, y), 2.2, Look { fill: Some((Paint::Muted, 0.7)), stroke: None });
        canvas.text((379.0, y + 4.0), text, "one day");
    }
}
