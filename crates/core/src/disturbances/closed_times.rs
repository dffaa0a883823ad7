//! The times at which each route is closed: a day's closures by route, with those that overlap or
//! touch joined.

use crate::{Closure, Time, VertiportIx};

/// The times at which the routes of a day are closed, by some of its closures or by all of them. A
/// query looks into a table and allocates no memory.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ClosedTimes {
    vertiports: usize,
    /// Position in `spans` at which those of each route begin, `[from][to]` row by row, and the
    /// number of spans at the end. Empty if nothing is ever closed.
    begins: Vec<u32>,
    spans: Vec<ClosedSpan>,
}

/// A time in which a route is closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct ClosedSpan {
    /// First instant at which the route is closed.
    pub start: Time,
    /// First instant at which the route is open again.
    pub end: Time,
}

impl ClosedTimes {
    /// The times at which the given closures close routes, for a day with `vertiports` vertiports.
    pub fn of<'a>(closures: impl IntoIterator<Item = &'a Closure>, vertiports: usize) -> Self {
        let mut spans = Vec::new();
        for &Closure { route, start, end, .. } in closures {
            let back = route.both_ways.then_some((route.to, route.from));
            let routes = [(route.from, route.to)].into_iter().chain(back);
            spans.extend(routes.map(|(from, to)| (from, to, ClosedSpan { start, end })));
        }
        // A closure without duration closes nothing.
        spans.retain(|(_, _, span)| span.start < span.end);
        if spans.is_empty() {
            return Self::default();
        }
        spans.sort_unstable();
        spans.dedup_by(|(from, to, next), (before_from, before_to, span)| {
            let joins = (&*from, &*to) == (&*before_from, &*before_to) && next.start <= span.end;
            if joins {
                span.end = span.end.max(next.end);
            }
            joins
        });
        let route = |&(from, to, _): &(VertiportIx, VertiportIx, ClosedSpan)| {
            from.at() * vertiports + to.at()
        };
        let begin = |of: usize| {
            let before = spans.partition_point(|span| route(span) < of);
            u32::try_from(before).expect("the readers bound the closures of a day")
        };
        let begins = (0..=vertiports * vertiports).map(begin).collect();
        Self { vertiports, begins, spans: spans.into_iter().map(|(_, _, span)| span).collect() }
    }

    /// Whether nothing is ever closed.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.spans.is_empty()
    }

    /// The spans in which a route is closed, in order, with time between any two of them.
    #[inline]
    pub fn spans(&self, from: VertiportIx, to: VertiportIx) -> &[ClosedSpan] {
        if self.is_empty() {
            return &[];
        }
        let route = from.at() * self.vertiports + to.at();
        &self.spans[self.begins[route] as usize..self.begins[route + 1] as usize]
    }

    /// Whether a route is closed at a time.
    #[inline]
    pub fn is_closed(&self, from: VertiportIx, to: VertiportIx, time: Time) -> bool {
        self.is_closed_throughout(from, to, time, time)
    }

    /// Whether a route is closed at every instant from `first` to `last`, both included.
    #[inline]
    pub fn is_closed_throughout(
        &self,
        from: VertiportIx,
        to: VertiportIx,
        first: Time,
        last: Time,
    ) -> bool {
        let spans = self.spans(from, to);
        let begun = spans.partition_point(|span| span.start <= first);
        begun > 0 && last < spans[begun - 1].end
    }

    /// Every time at which a route closes or opens, in order, each once.
    pub fn changes(&self) -> Vec<Time> {
        let mut changes: Vec<Time> =
            self.spans.iter().flat_map(|span| [span.start, span.end]).collect();
        changes.sort_unstable();
        changes.dedup();
        changes
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::{any, prop, prop_assert, prop_assert_eq, proptest};

    use super::{ClosedSpan, ClosedTimes};
    use crate::{Closure, Route, Time, VertiportIx};

    const VERTIPORTS: u16 = 3;

    fn closure((from, to, both_ways): (u16, u16, bool), start: u32, lasts: u32) -> Closure {
        let route = Route { from: VertiportIx(from), to: VertiportIx(to), both_ways };
        let start = Time::from_seconds(start);
        Closure { route, start, end: start + lasts, known: false }
    }

    #[test]
    fn closures_that_overlap_or_touch_are_one() {
        let there = (0, 1, false);
        let closures = [
            closure(there, 50, 9),
            closure(there, 10, 10),
            closure(there, 20, 5),
            closure(there, 22, 1),
        ];
        let times = ClosedTimes::of(&closures, 3);
        let span = |start, end| ClosedSpan {
            start: Time::from_seconds(start),
            end: Time::from_seconds(end),
        };
        assert_eq!(times.spans(VertiportIx(0), VertiportIx(1)), [span(10, 25), span(50, 59)]);
        assert_eq!(times.spans(VertiportIx(1), VertiportIx(0)), []);
        assert_eq!(times.changes(), [10, 25, 50, 59].map(Time::from_seconds));
    }

    proptest! {
        #[test]
        fn a_route_is_closed_when_one_of_its_closures_is_in_force(
            closures in prop::collection::vec(
                ((0..VERTIPORTS, 1..VERTIPORTS, any::<bool>()), 0_u32..30, 0_u32..9), 0..12
            )
        ) {
            let closures: Vec<Closure> = closures
                .into_iter()
                .map(|((from, on, back), start, lasts)| {
                    closure((from, (from + on) % VERTIPORTS, back), start, lasts)
                })
                .collect();
            let times = ClosedTimes::of(&closures, VERTIPORTS.into());
            let (places, instants) = (VertiportIx::all(VERTIPORTS.into()), 0..45);
            for (from, to) in places.clone().flat_map(|from| places.clone().map(move |to| (from, to))) {
                let closed = |second| {
                    let time = Time::from_seconds(second);
                    closures.iter().any(|one| {
                        one.route.covers(from, to) && (one.start..one.end).contains(&time)
                    })
                };
                for second in instants.clone() {
                    let time = Time::from_seconds(second);
                    prop_assert_eq!(times.is_closed(from, to, time), closed(second));
                    for last in second..45 {
                        prop_assert_eq!(
                            times.is_closed_throughout(from, to, time, Time::from_seconds(last)),
                            (second..=last).all(closed)
                        );
                    }
                }
                prop_assert!(times.spans(from, to).windows(2).all(|two| two[0].end < two[1].start));
            }
        }
    }
}
