//! The report of a played day, and the parts that an explanation shares with it.

use vertifleet_core::OutputKind;
use vertifleet_picture::PlayedPicture;
use vertifleet_picture::numbers::{dollars, grouped};
use vertifleet_study::account::{Account, Loss, VertiportUse};
use vertifleet_study::record::ReplayedDay;

use crate::account_tables as tables;
use crate::figure::Figure;
use crate::network::waits;
use crate::report::{Files, Place, Report, Section};

/// The beginning of every page of a played day.
pub const DAY_PAGE: OutputKind = OutputKind {
    name: "page of a day",
    skipped: 0,
    opening: "<!DOCTYPE html>\n<!-- vertifleet-day/",
};

/// Largest number of pairs, and of pairs with a period, in a list; JSON has all of them.
const MOST_ROWS: usize = 20;

/// The report of a day: ledger, map, aircraft, stands, demand, all tables, and the replay.
/// `replayed` is the day itself ([`Account::replayed`]).
pub fn account<'a>(account: &Account, replayed: &'a [ReplayedDay]) -> Report<'a> {
    let totals = &account.totals;
    let (carried, spilled) = (totals.passengers as f64, totals.spilled_passengers as f64);
    let headline = format!(
        "{} earns {}. {} passengers are carried and {} are not; these would have brought {} more than they cost{}.",
        account.policy,
        dollars(totals.profit_usd),
        grouped(carried, 0),
        grouped(spilled, 0),
        dollars(account.spilled_margin_usd()),
        spilled_out_of_reach(account),
    );
    let mut facts = vec![
        ("Flights", format!("{}, {} empty", totals.flights, totals.repositioning_flights)),
        ("Load factor", format!("{} %", grouped(100.0 * totals.load_factor, 1))),
        ("Energy", format!("{} kWh", grouped(totals.energy_kwh, 0))),
        ("Most often full", fullest(account)),
    ];
    let waits = waits(account.scenario().operations.passenger_wait_s);
    facts.extend(waits.map(|waits| ("Passengers wait", waits)));
    let played = format!("{} with {}", account.day, account.policy);
    Report {
        title: played.clone(),
        opening: played.clone(),
        subject: "a day and where its money is",
        heading: played,
        headline,
        facts,
        sections: sections(account),
        replayed,
        files: Files::Within(account.day.clone()),
        kind: Some(&DAY_PAGE),
        ..Report::default()
    }
}

/// How much of the spilled money no aircraft can earn, as the end of a sentence; empty if no
/// passenger is out of reach.
fn spilled_out_of_reach(account: &Account) -> String {
    let Loss { spilled, spilled_margin_usd, .. } = account.cannot_be_flown;
    if spilled == 0 {
        return String::new();
    }
    format!(
        "; {} of it and {} of these passengers are on pairs that no aircraft can fly, for want of a corridor or of range",
        dollars(spilled_margin_usd),
        grouped(spilled as f64, 0),
    )
}

/// The vertiport that was full for the largest share of the time.
fn fullest(account: &Account) -> String {
    let by_share =
        |one: &&VertiportUse, other: &&VertiportUse| one.full_share.total_cmp(&other.full_share);
    match account.vertiports.iter().max_by(by_share) {
        Some(one) if one.full_share > 0.0 => {
            format!("{}, {:.0} % of the time", one.id, 100.0 * one.full_share)
        }
        _ => "none".to_owned(),
    }
}

/// Every picture of the day, with the tables that belong to it, and the other tables.
fn sections(account: &Account) -> Vec<Section> {
    let mut sections: Vec<Section> = PlayedPicture::ALL.map(|one| picture(account, one)).into();
    let is_worth_known = account.vertiports.iter().any(|one| one.stand_worth.is_some());
    let pairs = tables::pairs(account, MOST_ROWS);
    let cells = tables::worst_cells(account, MOST_ROWS);
    let mut vertiports = Section::of_table("Vertiports", tables::vertiports(account)).with_note(
        "taken is the mean share of stands and chargers with an aircraft there or on its way there",
    );
    if is_worth_known {
        vertiports = vertiports.with_note(
            "one more stand is the shadow price of the bound: the largest rise of the bound, before the cost of the stand",
        );
    }
    sections.extend([
        Section::of_table("Where most money is spilled", pairs)
            .with_note("by pair, the most first; pairs that no aircraft can fly are left out"),
        Section::of_table("Where and when most money is spilled", cells)
            .with_note("by pair and the period in which passengers want to fly"),
        vertiports,
        Section::of_table("Types of aircraft", tables::types(account))
            .with_note("means by type, within operations")
            .with_note("profit is that of the flights, before the cost of the aircraft"),
    ]);
    sections
}

fn picture(account: &Account, picture: PlayedPicture) -> Section {
    let svg = picture.draw(account.scenario(), &account.trace().rows);
    let caption = caption(picture).to_owned();
    let table = match picture {
        PlayedPicture::Ledger => Some(tables::ledger(account)),
        PlayedPicture::Demand => Some(tables::periods(account)),
        PlayedPicture::Map | PlayedPicture::Aircraft | PlayedPicture::Occupancy => None,
    };
    Section {
        title: heading(picture).to_owned(),
        figures: vec![Figure { slug: picture.name().into(), caption, svg }],
        place: if table.is_some() { Place::Everywhere } else { Place::Page },
        table,
        ..Section::default()
    }
}

fn heading(picture: PlayedPicture) -> &'static str {
    match picture {
        PlayedPicture::Ledger => "Ledger",
        PlayedPicture::Map => "Map",
        PlayedPicture::Aircraft => "Aircraft",
        PlayedPicture::Occupancy => "Stands",
        PlayedPicture::Demand => "Demand by hour",
    }
}

fn caption(picture: PlayedPicture) -> &'static str {
    match picture {
        PlayedPicture::Ledger => {
            "Each cost takes its bar from the remaining revenue; the rest is profit."
        }
        PlayedPicture::Map => "Both directions of a pair together, to scale.",
        PlayedPicture::Aircraft => {
            "Bars are flights, with take-off and landing; all other time without charging or an outage is time on a stand."
        }
        PlayedPicture::Occupancy => {
            "A stand is taken from the decision to fly there until the decision to fly away. All capacities are drawn at the same height; \
             the number next to the dashed line is the capacity, with chargers where these are counted apart."
        }
        PlayedPicture::Demand => {
            "Margin in the table below is the fares of the passengers less the cost of carrying them, without electricity and flight costs."
        }
    }
}
