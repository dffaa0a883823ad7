//! The page of a played day: the ledger, its pictures, all tables, and the replay, in one file that
//! needs no other.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, PreEscaped, html};
use vertifleet_picture::PlayedPicture;
use vertifleet_picture::numbers::{dollars, grouped, typeset};

use super::{Account, PAGE, table};
use crate::network_overview::waits;
use crate::page::{document, replay_frame};
use crate::record::{Play, ReplayedDay};
use crate::replay;

/// Most pairs on the page; JSON has all of them.
const MOST_PAIRS: usize = 40;

/// Most pairs and periods on the page; JSON has all of them.
const MOST_CELLS: usize = 20;

/// What a page says beside the account of the day.
pub(crate) struct PageExtras {
    /// The beginning of the page up to its version.
    pub(crate) opening: &'static str,
    /// What the page is about, in a few words.
    pub(crate) subject: &'static str,
    /// The end of a sentence about profit, for example what share of the bound it is.
    pub(crate) share: String,
    /// Further numbers at the head of the page.
    pub(crate) numbers: Markup,
    /// Further sections after the tables.
    pub(crate) sections: Markup,
}

impl Default for PageExtras {
    fn default() -> Self {
        Self {
            opening: PAGE.opening,
            subject: "a day and where its money is",
            share: String::new(),
            numbers: html! {},
            sections: html! {},
        }
    }
}

/// The page as HTML.
pub(crate) fn text(account: &Account, beside: &PageExtras) -> String {
    let body = html! {
        (head(account, beside))
        (figures(account))
        (tables(account))
        (beside.sections)
        (replay_of(account))
    };
    let page = document(&format!("{} with {}", account.day, account.policy), &body);
    page.replacen("<!DOCTYPE html>", &format!("{}1 -->\n", beside.opening), 1)
}

fn head(account: &Account, beside: &PageExtras) -> Markup {
    let totals = &account.totals;
    let (carried, spilled) = (totals.passengers as f64, totals.spilled_passengers as f64);
    html! {
        p.program { "Vertifleet " (env!("CARGO_PKG_VERSION")) " · " (beside.subject) }
        h1 { (account.day) " with " (account.policy) }
        p.headline {
            (account.policy) " earns " (dollars(totals.profit_usd)) (beside.share) ". " (grouped(carried, 0))
            " passengers are carried and " (grouped(spilled, 0)) " are not; these would have brought "
            (dollars(account.spilled_margin_usd())) " more than they cost" (account.spilled_out_of_reach(dollars)) "."
        }
        dl {
            (beside.numbers)
            div { dt { "Flights" } dd { (totals.flights) ", " (totals.repositioning_flights) " empty" } }
            div { dt { "Load factor" } dd { (grouped(100.0 * totals.load_factor, 1)) " %" } }
            div { dt { "Energy" } dd { (grouped(totals.energy_kwh, 0)) " kWh" } }
            div { dt { "Most often full" } dd { (fullest(account)) } }
            @if let Some(waits) = waits(account.scenario.operations.passenger_wait_s) {
                div { dt { "Passengers wait" } dd { (waits) } }
            }
        }
        p.lead {
            a href="#replay" { "The replay" } " at the end of the page shows the day from moment to moment. Below each picture are \
            links to it as files."
        }
    }
}

/// The vertiport that was full for the largest share of the time.
fn fullest(account: &Account) -> String {
    let by_share = |one: &&super::VertiportUse, other: &&super::VertiportUse| {
        one.full_share.total_cmp(&other.full_share)
    };
    match account.vertiports.iter().max_by(by_share) {
        Some(one) if one.full_share > 0.0 => {
            format!("{}, {:.0} % of the time", one.id, 100.0 * one.full_share)
        }
        _ => "none".to_owned(),
    }
}

/// Every picture of the day with its heading, its caption, and links to it as files.
fn figures(account: &Account) -> Markup {
    let (day, rows) = (&account.scenario, &account.trace.rows);
    html! {
        @for picture in PlayedPicture::ALL {
            @let svg = picture.draw(day, rows);
            @let name = format!("{}-{}", account.day, picture.name());
            h2 id=(picture.name()) { (heading(picture)) }
            figure.day {
                (PreEscaped(&svg))
                figcaption {
                    (caption(picture)) " As a file: "
                    a download={ (name) ".svg" } href=(data_link("image/svg+xml", svg.as_bytes())) { "SVG" } ", "
                    a download={ (name) ".png" } href=(data_link("image/png", &vertifleet_picture::png(&svg))) { "PNG" } "."
                }
            }
            @if picture == PlayedPicture::Ledger { (rows_of(&table::ledger(account))) }
            @if picture == PlayedPicture::Demand { (rows_of(&table::periods(account))) }
        }
    }
}

/// A link that holds what it leads to, so that the page stays one file.
fn data_link(kind: &str, bytes: &[u8]) -> String {
    format!("data:{kind};base64,{}", STANDARD.encode(bytes))
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
            "Each cost takes its bar from what is left of the revenue; the rest is profit."
        }
        PlayedPicture::Map => "Both directions of a pair together, to scale.",
        PlayedPicture::Aircraft => {
            "Bars are flights, with take-off and landing; what is neither flight nor charging nor an outage is time on a stand."
        }
        PlayedPicture::Occupancy => {
            "A stand is taken from the decision to fly there until the decision to fly away. All capacities are drawn at the same height; \
             the number beside the dashed line is the capacity, with chargers where these are counted apart."
        }
        PlayedPicture::Demand => {
            "Margin in the table below is what passengers would have paid less what carrying them costs, electricity and flights aside."
        }
    }
}

fn tables(account: &Account) -> Markup {
    let is_worth_known = account.vertiports.iter().any(|one| one.stand_worth.is_some());
    let taken = "Taken is the mean share of stands and chargers with an aircraft there or on its way there.";
    let worth = " One more stand is the shadow price of the bound: by how much the bound rises at most, before what the stand costs.";
    let vertiports = taken.to_owned() + if is_worth_known { worth } else { "" };
    html! {
        (section("Where most money is spilled", "By pair, the most first; pairs that no aircraft can fly are left out.", &table::pairs(account, MOST_PAIRS)))
        (section("Where and when most money is spilled", "By pair and the period in which passengers want to fly.", &table::worst_cells(account, MOST_CELLS)))
        (section("Vertiports", &vertiports, &table::vertiports(account)))
        (section("Types of aircraft", "Means by type, within operations. Profit is that of the flights, before what the aircraft costs.", &table::types(account)))
    }
}

/// The day from moment to moment.
fn replay_of(account: &Account) -> Markup {
    let play = Play {
        policy: account.policy.clone(),
        trace: account.trace.clone(),
        profit_usd: account.totals.profit_usd,
    };
    let day = ReplayedDay { scenario: account.scenario.clone(), plays: vec![play] };
    html! {
        h2 id="replay" { "Replay" }
        p { "The day on a map and along its hours: play, pause, and steps from decision to decision." }
        (replay_frame(&replay::page(&[day])))
    }
}

/// A table with its heading and what to know about it.
pub(crate) fn section(title: &str, lead: &str, rows: &[Vec<String>]) -> Markup {
    html! {
        h2 { (title) }
        p.lead { (lead) }
        (rows_of(rows))
    }
}

/// A table; the first row is that of the columns.
fn rows_of(rows: &[Vec<String>]) -> Markup {
    let (head, rows) = rows.split_first().expect("a table has a heading");
    html! {
        div.wide { table {
            thead { tr { @for cell in head { th scope="col" { (cell) } } } }
            tbody { @for row in rows { tr { @for cell in row { td { (shown(cell)) } } } } }
        } }
    }
}

/// A cell as it is set in type: numbers with a true minus sign, pairs with an arrow, ids as they
/// are.
fn shown(cell: &str) -> String {
    if cell.starts_with('-') { typeset(cell) } else { cell.replace("->", "→") }
}
