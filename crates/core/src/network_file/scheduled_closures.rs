//! `[[closures]]` of the network file: closures at the same times every day, such as a night curfew
//! or a morning fog.

use serde::Deserialize;

use crate::limits::entries;
use crate::raw::{Positions, RawRoute, each};
use crate::{Closure, FormatError, Route, Time, Vertiport, VertiportIx, check};

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the members of a closure")]
pub(crate) struct RawScheduledClosure {
    start: Time,
    end: Time,
    #[serde(default)]
    routes: Vec<RawRoute>,
    #[serde(default)]
    vertiports: Vec<String>,
    /// Closures that come at the same time every day are known in advance by default.
    #[serde(default = "announced")]
    known: bool,
}

fn announced() -> bool {
    true
}

/// The closures that every day has, route by route.
pub(crate) fn closures(
    raw: Vec<RawScheduledClosure>,
    places: &Positions,
    vertiports: &[Vertiport],
) -> Result<Vec<Closure>, FormatError> {
    let mut closures = Vec::new();
    for (at, raw) in raw.into_iter().enumerate() {
        closures.extend(raw.check(at, places, vertiports)?);
        // The length is checked as the list grows, because each vertiport of a closure stands for
        // many routes.
        at_most(closures.len())?;
    }
    Ok(closures)
}

/// Refuses more closures than a day may have, including those that are drawn.
pub(crate) fn at_most(found: usize) -> Result<(), FormatError> {
    if found <= entries::CLOSURES {
        return Ok(());
    }
    let member = "closures, counted by routes, those of disturbances included,";
    check::entry_count(member, found, entries::CLOSURES)
}

impl RawScheduledClosure {
    /// Checks the closure at a position of the list, and returns one for each route that it closes.
    pub(crate) fn check(
        self,
        at: usize,
        places: &Positions,
        vertiports: &[Vertiport],
    ) -> Result<Vec<Closure>, FormatError> {
        let (start, end, known) = (self.start, self.end, self.known);
        let routes = self.routes(&format!("closures[{at}]"), places, vertiports)?;
        Ok(routes.into_iter().map(|route| Closure { route, start, end, known }).collect())
    }

    /// The routes that the entry closes.
    fn routes(
        self,
        member: &str,
        places: &Positions,
        vertiports: &[Vertiport],
    ) -> Result<Vec<Route>, FormatError> {
        check::span(self.start, self.end, || member.to_owned())?;
        let named = self.routes.len() + self.vertiports.len();
        let together = format!("{member}: routes and vertiports together");
        check::entry_count(&together, named, entries::CLOSURES)?;
        let mut routes = each(self.routes, |raw, at| {
            let member = format!("{member}: routes[{at}]");
            let route = raw.check(places, &member)?;
            if route.from != route.to {
                return Ok(route);
            }
            let vertiport = vertiports[route.from.at()].id.clone();
            Err(FormatError::RouteToItself { member, vertiport })
        })?;
        let mut closed = vec![false; vertiports.len()];
        for (at, id) in self.vertiports.iter().enumerate() {
            let place = || format!("{member}: vertiports[{at}]");
            closed[places.position(id, place)?] = true;
        }
        routes.extend(routes_of(&closed));
        Ok(routes)
    }
}

/// The routes from and to every closed vertiport, each once.
fn routes_of(closed: &[bool]) -> impl Iterator<Item = Route> {
    let all = VertiportIx::all(closed.len());
    all.clone().filter(|one| closed[one.at()]).flat_map(move |from| {
        let others = all.clone().filter(move |&to| to != from && !(closed[to.at()] && to < from));
        others.map(move |to| Route { from, to, both_ways: true })
    })
}
