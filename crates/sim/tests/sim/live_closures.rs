//! Closures of live days: of all reports about a route, the latest counts.

use std::sync::Arc;

use proptest::prelude::{
    Just, ProptestConfig, Strategy, prop, prop_assert_eq, prop_oneof, proptest,
};
use vertifleet_core::{Closure, Disturbances, Route, Scenario, Time, VertiportIx};
use vertifleet_sim::live::{LiveDay, Report, Routes};
use vertifleet_testkit::paper_day;

const VERTIPORTS: usize = 8;

fn at(minutes: u32) -> Time {
    Time::from_seconds(6 * 3_600 + 60 * minutes)
}

/// A day with closures that are known in advance, each one way.
fn day_with(known: &[(usize, usize, u32, u32)]) -> Arc<Scenario> {
    let closures = known.iter().map(|&(from, to, start, end)| Closure {
        route: Route { from: VertiportIx::new(from), to: VertiportIx::new(to), both_ways: false },
        start: at(start),
        end: at(end),
        known: true,
    });
    let mut day = Scenario::clone(&paper_day(1)).into_day();
    day.disturbances = Disturbances { closures: closures.collect(), ..Disturbances::default() };
    Arc::new(day.check("a day with closures").expect("a day"))
}

/// What is reported about routes.
#[derive(Debug, Clone, Copy)]
enum Kind {
    Open,
    Closed,
    /// Closed until a minute.
    Until(u32),
}

/// A report about routes at a minute.
#[derive(Debug, Clone)]
struct Reported {
    routes: Routes,
    time: u32,
    kind: Kind,
}

impl Reported {
    fn is_about(&self, (from, to): (usize, usize)) -> bool {
        let (from, to) = (VertiportIx::new(from), VertiportIx::new(to));
        match self.routes {
            Routes::Way { from: one, to: other } => (one, other) == (from, to),
            Routes::Of(vertiport) => vertiport == from || vertiport == to,
        }
    }

    fn report(&self) -> Report {
        let routes = self.routes;
        match self.kind {
            Kind::Open => Report::Reopened { routes },
            Kind::Closed => Report::Closed { routes, until: None },
            Kind::Until(minute) => Report::Closed { routes, until: Some(at(minute)) },
        }
    }
}

/// Whether a route is closed at a minute: the latest report about it counts, and the closures known
/// in advance that began after it.
fn is_closed(
    known: &[(usize, usize, u32, u32)],
    reports: &[Reported],
    pair: (usize, usize),
    minute: u32,
) -> bool {
    let latest = reports.iter().rfind(|report| report.is_about(pair));
    let begins_later = |start| latest.is_none_or(|report| start > report.time);
    let by_report = match latest.map(|report| report.kind) {
        None | Some(Kind::Open) => false,
        Some(Kind::Closed) => true,
        Some(Kind::Until(until)) => minute < until,
    };
    by_report
        || known.iter().any(|&(from, to, start, end)| {
            (from, to) == pair && begins_later(start) && (start..end).contains(&minute)
        })
}

fn any_routes() -> impl Strategy<Value = Routes> {
    let vertiport = || (0..4_usize).prop_map(VertiportIx::new);
    let way = (vertiport(), vertiport())
        .prop_filter("two vertiports", |(from, to)| from != to)
        .prop_map(|(from, to)| Routes::Way { from, to });
    prop_oneof![3 => way, 1 => vertiport().prop_map(Routes::Of)]
}

/// A kind of report; a closure with an end has its duration.
fn any_kind() -> impl Strategy<Value = Kind> {
    prop_oneof![
        3 => Just(Kind::Open),
        2 => Just(Kind::Closed),
        5 => (0..150_u32).prop_map(Kind::Until),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn the_latest_report_about_a_route_wins(
        known in prop::collection::vec((0..4_usize, 0..3_usize, 0..300_u32, 1..200_u32), 0..5),
        reports in prop::collection::vec(
            (any_routes(), 0..60_u32, any_kind()),
            1..12,
        ),
    ) {
        let known: Vec<_> = known
            .into_iter()
            .map(|(from, to, start, lasts)| (from, (from + 1 + to) % 4, start, start + lasts))
            .collect();
        let mut live = LiveDay::new(day_with(&known));
        let (mut now, mut taken) = (0, Vec::new());
        for (routes, later, kind) in reports {
            now += later;
            let kind = match kind {
                Kind::Until(lasts) => Kind::Until(now + lasts),
                other => other,
            };
            let report = Reported { routes, time: now, kind };
            live.take(at(now), &report.report()).expect("the routes exist");
            taken.push(report);
            let all = (0..VERTIPORTS).flat_map(|from| (0..VERTIPORTS).map(move |to| (from, to)));
            for pair in all.filter(|(from, to)| from != to) {
                let closed = is_closed(&known, &taken, pair, now);
                let (from, to) = (VertiportIx::new(pair.0), VertiportIx::new(pair.1));
                let found = live.view().closed(from).contains(to);
                prop_assert_eq!(found, closed, "{:?} after {:?}", pair, taken);
                // The list has the same times, to the minute, for the whole rest of the day.
                let listed: Vec<_> = live
                    .closed_routes()
                    .filter(|route| (route.from, route.to) == (from, to))
                    .collect();
                for minute in (now..now + 500).step_by(7) {
                    let listed = listed.iter().any(|route| {
                        route.start <= at(minute) && route.until.is_none_or(|end| at(minute) < end)
                    });
                    let closed = is_closed(&known, &taken, pair, minute);
                    prop_assert_eq!(listed, closed, "{:?} at {} after {:?}", pair, minute, taken);
                }
                let opens = (now..3_000).find(|&minute| !is_closed(&known, &taken, pair, minute));
                let opens = opens.filter(|_| closed).map(at);
                prop_assert_eq!(live.opens(from, to), opens, "{:?} after {:?}", pair, taken);
            }
        }
    }
}

#[test]
fn a_closure_whose_end_is_brought_forward_ends_then() {
    let mut live = LiveDay::new(paper_day(1));
    let (v1, v2) = (VertiportIx(0), VertiportIx(1));
    let close = |until| Report::Closed { routes: Routes::Of(v1), until: Some(at(until)) };
    live.take(at(0), &close(360)).expect("the vertiport exists");
    live.take(at(10), &close(180)).expect("the vertiport exists");
    assert_eq!(live.opens(v1, v2), Some(at(180)));
    live.take(at(180), &Report::Clock).expect("a time");
    assert!(!live.view().closed(v1).contains(v2));
    assert_eq!(live.closed_routes().count(), 0);
}
