//! The replay page: one HTML file that shows days without a service, with its scripts, its days and
//! the part of the base map that they need within it.

use std::collections::BTreeMap;

use rust_embed::RustEmbed;
use serde_json::value::RawValue;

/// How every replay page begins, by which the program recognises its own.
pub const REPLAY_OPENING: &str = "<!doctype html>\n<!-- vertifleet-replay/1 -->\n";

const DOCTYPE: &str = "<!doctype html>\n";
const PAGE: &str = include_str!("../../../web/dist/replay.html");
/// Where the page keeps its days. The base map stands before them.
const DATA: &str = r#"<script type="application/json" id="vertifleet-data">"#;
const BASEMAP: &str = r#"<script type="application/json" id="vertifleet-basemap">"#;

/// The sectors of the base map, as `web/basemap/plugin.ts` writes them.
#[derive(RustEmbed)]
#[folder = "../../web/dist/assets/basemap"]
struct Basemap;

/// Degrees of a side of a sector, and of a cell within it, as `web/src/map/ground/grid.ts` has
/// them.
const SECTOR: i32 = 30;
const CELL: i32 = 5;
/// Degrees around the vertiports that are shown too.
const MARGIN: f64 = 1.5;

/// The replay page with these days in it, as the JSON that `web/src/replay/days.ts` describes.
/// `places` are the latitudes and longitudes of all vertiports that have them; the page gets the
/// base map around these.
///
/// # Panics
/// Panics if the page was built without a place for the days, which a test of this crate rules out.
pub fn replay_page(days: &str, places: &[(f64, f64)]) -> String {
    let page = PAGE.strip_prefix(DOCTYPE).expect("the page is HTML");
    let (head, tail) = page.split_once(DATA).expect("the page has a place for the days");
    let (_, tail) = tail.split_once("</script>").expect("the place has an end");
    // Nothing that the days contain may end the element that they stand in.
    let days = days.replace('<', "\\u003c");
    let map = cells_around(places);
    format!("{REPLAY_OPENING}{head}{BASEMAP}{map}</script>\n    {DATA}{days}</script>{tail}")
}

/// What the replay page runs, and what it looks by: its script and its style sheet. A server of the
/// page that forbids other scripts and styles has to allow these.
///
/// # Panics
/// Panics if the page was built without them, which a test of this crate rules out.
pub fn replay_script_and_style() -> [&'static str; 2] {
    let between = |start, end| {
        let (_, rest) = PAGE.split_once(start).expect("the page has its script and its style");
        rest.split_once(end).expect("elements have an end").0
    };
    [between(r#"<script type="module">"#, "</script>"), between("<style>", "</style>")]
}

/// A sector of the base map: its cells by their names, as they are.
type Sector = BTreeMap<String, Box<RawValue>>;

/// The cells of the base map around places, as one JSON object.
fn cells_around(places: &[(f64, f64)]) -> String {
    let mut found = Sector::new();
    let mut sectors = BTreeMap::new();
    for &(latitude, longitude) in places {
        for south in steps(latitude) {
            for west in steps(longitude) {
                let name = format!("{},{south}", wrapped(west));
                if found.contains_key(&name) {
                    continue;
                }
                let sector = (floor_to(wrapped(west), SECTOR), floor_to(south, SECTOR));
                let cells: &mut Sector = sectors.entry(sector).or_insert_with(|| read(sector));
                found.extend(cells.remove_entry(&name));
            }
        }
    }
    serde_json::to_string(&found).expect("what was read as JSON can be written")
}

/// The cells along an axis that lie within the margin around a coordinate.
fn steps(degrees: f64) -> impl Iterator<Item = i32> {
    #[expect(clippy::cast_possible_truncation, reason = "degrees are small")]
    let cell = |degrees: f64| floor_to(degrees.floor() as i32, CELL);
    (cell(degrees - MARGIN)..=cell(degrees + MARGIN)).step_by(CELL as usize)
}

fn floor_to(degrees: i32, size: i32) -> i32 {
    degrees.div_euclid(size) * size
}

/// A longitude between -180 and 180.
fn wrapped(west: i32) -> i32 {
    (west + 180).rem_euclid(360) - 180
}

/// The cells of a sector; none where there is only sea.
fn read((west, south): (i32, i32)) -> Sector {
    let prefix = format!("{west}_{south}-");
    let file = Basemap::iter().find(|name| name.starts_with(&prefix));
    let file = file.and_then(|name| Basemap::get(&name));
    file.map_or_else(Sector::new, |file| {
        serde_json::from_slice(&file.data).expect("the base map was built as JSON")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The two airports of New York.
    const NEW_YORK: [(f64, f64); 2] = [(40.69, -74.17), (40.64, -73.78)];

    #[test]
    fn the_page_needs_nothing_beside_it() {
        let page = replay_page(r#"{"days": []}"#, &NEW_YORK);
        assert!(page.starts_with(REPLAY_OPENING));
        assert!(page.contains(r#"{"days": []}</script>"#), "the days are in it");
        for outside in ["src=\"", "href=\"", "@import", "url(http"] {
            assert!(!page.contains(outside), "{outside}");
        }
    }

    #[test]
    fn the_page_runs_one_script_and_has_one_style_sheet() {
        let page = replay_page("{}", &[]);
        let [script, style] = replay_script_and_style();
        let others = page.replacen(script, "", 1).replacen(style, "", 1);
        let data = others.matches(r#"<script type="application/json""#).count();
        let texts = others.matches(r#"<script type="text/plain""#).count();
        assert_eq!(others.matches("<script").count(), data + texts + 1);
        assert_eq!(others.matches("<style").count(), 1);
        assert!(script.len() > 1_000 && style.len() > 1_000);
    }

    #[test]
    fn days_cannot_leave_their_place() {
        let page = replay_page(r#"{"days": [{"name": "</script><script>alert(1)"}]}"#, &[]);
        assert!(page.contains(r#"{"name": "\u003c/script>\u003cscript>alert(1)"}]}</script>"#));
        assert_eq!(page.matches(DATA).count(), 1);
    }

    #[test]
    fn the_base_map_is_that_of_the_vertiports() {
        let cells: Sector = serde_json::from_str(&cells_around(&NEW_YORK)).expect("an object");
        let names: Vec<&str> = cells.keys().map(String::as_str).collect();
        assert_eq!(names, ["-75,35", "-75,40", "-80,35", "-80,40"]);
        assert!(cells["-75,40"].get().contains("land"));
        assert_eq!(cells_around(&[]), "{}");
    }

    #[test]
    fn the_base_map_goes_on_beyond_the_antimeridian() {
        // Taveuni in Fiji lies on it.
        let cells: Sector = serde_json::from_str(&cells_around(&[(-16.8, 179.9)])).expect("cells");
        assert!(cells.contains_key("175,-20") && cells.contains_key("-180,-20"), "{cells:?}");
    }
}
