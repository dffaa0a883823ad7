//! Networks that differ from another one in some members of its file, for questions such as "and
//! with 12 more aircraft?".

mod differences;
mod edit;
mod kept;
mod member_path;

use serde::Serialize;
use serde_json::Value;
use toml_edit::DocumentMut;
use toml_edit::ser::ValueSerializer;

use self::edit::set;
use self::member_path::position;
use crate::parse::shortened;
use crate::{Error, FormatError, Network};

pub use differences::{DemandCell, Difference};
pub use member_path::split_path;

impl Network {
    /// Returns the network whose file differs from this one's in some members. A path names members
    /// from the outside in, separated by dots; a name with a dot in it is written in double quotes.
    /// An entry of a list is named by its `id` (in the fleet by its `type`) or by its position from
    /// 0, and `*` names all of them: `fleet.0.count`, `fleet.midnight.count`,
    /// `vertiports.V3.stands`, `vertiports.*.stands`. Changes are made in order, so that later ones
    /// win. Where stands change, the changed file has `start_stands`, so that aircraft start as
    /// they do on this network. Where fares change and passengers respond, it has
    /// `market.reference`, so that the demand is the one at this network's fares. Everything else
    /// stays as it was written, comments too. The changed file has to obey the format like any
    /// other.
    ///
    /// # Errors
    /// [`Error::NoSuchMember`] if a path leads nowhere, [`FormatError::NotParsed`] if a value has
    /// no form in TOML, and the errors of [`from_toml`](Self::from_toml).
    pub fn changed<'a>(
        &self,
        changes: impl IntoIterator<Item = (&'a String, &'a Value)>,
    ) -> Result<Self, Error> {
        let origin = format!("{}, changed", self.name());
        let mut file: DocumentMut = self.toml().parse().expect("the text has been read before");
        let mut paths = Vec::new();
        for (path, value) in changes {
            let nowhere = |part: &str| nowhere(path, part, String::new());
            let value = value.serialize(ValueSerializer::new()).map_err(|error| {
                let problem = format!("{path}: {error}");
                FormatError::NotParsed { line: 1, column: 1, problem }.in_file(&origin)
            })?;
            let names = member_path::names(path);
            let parts: Vec<&str> = names.iter().map(String::as_str).collect();
            set(file.as_table_mut(), &parts, &value).map_err(|part| nowhere(&part))?;
            paths.push(path);
        }
        kept::keep_start_stands(self, file.as_table_mut());
        kept::keep_reference(self, file.as_table_mut());
        Self::from_toml(&file.to_string(), &origin).map_err(|error| {
            let unknown = paths.iter().find_map(|path| unknown_member(path, &error));
            unknown.unwrap_or(error)
        })
    }

    /// The members of the network's file that a path names, as [`changed`](Self::changed) reads it,
    /// each with a path that names it alone: `fleet.*.count` gives `fleet.midnight.count` and the
    /// others.
    ///
    /// # Errors
    /// [`Error::NoSuchMember`] if the path leads nowhere.
    pub fn members(&self, path: &str) -> Result<Vec<(String, Value)>, Error> {
        let file: toml::Value = toml::from_str(self.toml()).expect("the text has been read before");
        let names = member_path::names(path);
        let parts: Vec<&str> = names.iter().map(String::as_str).collect();
        let mut found = Vec::new();
        let outcome = find(&file, &parts, &mut Vec::new(), &mut found);
        outcome.map_err(|part| nowhere(path, &part, String::new()))?;
        Ok(found)
    }
}

/// The error that a part of a path does not exist.
fn nowhere(path: &str, part: &str, expected: String) -> Error {
    Error::NoSuchMember { path: path.to_owned(), part: shortened(part, 64), expected }
}

/// The error that the format does not know the last part of a path, if this is why a changed file
/// is refused.
fn unknown_member(path: &str, error: &Error) -> Option<Error> {
    let Error::InFile { error: FormatError::WrongMember { problem, .. }, .. } = error else {
        return None;
    };
    let names = member_path::names(path);
    let last = names.last()?;
    let expected = problem.strip_prefix(&format!("unknown field `{last}`"))?;
    Some(nowhere(path, last, shortened(expected, 500)))
}

/// Finds the members that a path leads to. `passed` are the parts of the path before. The error is
/// the part that leads nowhere.
fn find(
    at: &toml::Value,
    path: &[&str],
    passed: &mut Vec<String>,
    found: &mut Vec<(String, Value)>,
) -> Result<(), String> {
    let [part, rest @ ..] = path else {
        found.push((passed.join("."), serde_json::to_value(at).expect("TOML has a form in JSON")));
        return Ok(());
    };
    let lost = || (*part).to_owned();
    let members: Vec<(String, &toml::Value)> = match at {
        toml::Value::Table(members) => {
            vec![((*part).to_owned(), members.get(*part).ok_or_else(lost)?)]
        }
        toml::Value::Array(entries) if *part == "*" => {
            (0..entries.len()).map(|at| (own_name(entries, at), &entries[at])).collect()
        }
        toml::Value::Array(entries) => {
            let at = position(entries.iter().map(name_of), part).ok_or_else(lost)?;
            vec![(own_name(entries, at), &entries[at])]
        }
        _ => return Err(lost()),
    };
    for (name, member) in members {
        passed.push(member_path::quoted(&name).into_owned());
        find(member, rest, passed, found)?;
        passed.pop();
    }
    Ok(())
}

/// The name of an entry: its id or type if this leads to it, else its position.
fn own_name(entries: &[toml::Value], at: usize) -> String {
    let names = || entries.iter().map(name_of);
    let name = name_of(&entries[at]).filter(|name| position(names(), name) == Some(at));
    name.map_or_else(|| at.to_string(), str::to_owned)
}

/// The id of an entry, or, in the fleet, its type.
fn name_of(entry: &toml::Value) -> Option<&str> {
    entry.get("id").or_else(|| entry.get("type")).and_then(toml::Value::as_str)
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use crate::{Coded, DaySeed, Error, Network};

    fn changed(changes: &Value) -> Result<Network, Error> {
        let paper = Network::shipped("paper").expect("a shipped network");
        paper.changed(changes.as_object().expect("changes by their paths"))
    }

    #[test]
    fn a_fleet_may_do_without_a_type_but_not_without_aircraft() {
        let york = Network::shipped("new-york").expect("a shipped network");
        let with = |changes: &Value| york.changed(changes.as_object().expect("changes"));
        let one = with(&json!({"fleet.midnight.count": 0})).expect("a fleet of one type");
        assert_eq!(one.fleet_size(), 16);
        let none = with(&json!({"fleet.*.count": 0})).expect_err("no aircraft");
        assert!(none.to_string().contains("the fleet has no aircraft"), "{none}");
    }

    #[test]
    fn a_path_with_a_star_names_members_one_by_one() {
        let york = Network::shipped("new-york").expect("a shipped network");
        let members = york.members("fleet.*.count").expect("a fleet");
        let own = |path: &str, count: i64| (path.to_owned(), json!(count));
        assert_eq!(members, [own("fleet.midnight.count", 16), own("fleet.joby-s4.count", 16)]);
        let stands = york.members("vertiports.3.stands").expect("a vertiport");
        assert_eq!(stands, [own("vertiports.JFK.stands", 8)]);
        for path in ["fleet.*.cont", "fleet.9.count", "vertiports.JFK.stands.more", "fleets"] {
            let error = york.members(path).expect_err(path);
            assert_eq!(error.code().to_string(), "V123", "{path}");
        }
    }

    #[test]
    fn an_id_with_a_dot_stands_in_quotes() {
        let paper = Network::shipped("paper").expect("a shipped network");
        let text = paper.toml().replace("id = \"V1\"", "id = \"St. V1\"");
        let network = Network::from_toml(&text, "dotted").expect("a network");
        let path = r#"vertiports."St. V1".stands"#.to_owned();
        assert_eq!(network.members("vertiports.0.stands").expect("a vertiport")[0].0, path);
        let more = network.changed([(&path, &json!(9))]).expect("a network");
        let differences = network.differences(&more);
        assert!(
            differences
                .iter()
                .any(|one| one.path.as_ref() == Some(&path) && one.after == Some("9".to_owned()))
        );
    }

    #[test]
    fn later_changes_win() {
        let paper = Network::shipped("paper").expect("a shipped network");
        let (all, one) = ("vertiports.*.stands".to_owned(), "vertiports.V1.stands".to_owned());
        let stands = |changes: [(&String, &Value); 2]| {
            let network = paper.changed(changes).expect("a network");
            network.vertiports()[0].stands
        };
        assert_eq!(stands([(&all, &json!(8)), (&one, &json!(9))]), 9);
        assert_eq!(stands([(&one, &json!(9)), (&all, &json!(8))]), 8);
    }

    #[test]
    fn a_change_is_made_and_nothing_else() {
        let network = changed(&json!({"fleet.0.count": 44, "vertiports.V3.stands": 9}));
        let network = network.expect("a network");
        let paper = Network::shipped("paper").expect("a shipped network");
        assert_eq!(network.fleet_size(), 44);
        let stands = |network: &Network| -> Vec<u16> {
            network.vertiports().iter().map(|vertiport| vertiport.stands).collect()
        };
        let mut expected = stands(&paper);
        expected[2] = 9;
        assert_eq!(stands(&network), expected);
        assert_eq!(paper.vertiports()[2].id, "V3");
        assert_eq!(network.mean_demand(), paper.mean_demand());
        let same = changed(&json!({})).expect("a network");
        let day = |network: &Network| network.draw(DaySeed::comparison(3).expect("a seed"));
        assert_eq!(day(&same), day(&paper), "numbers survive being written");
    }

    #[test]
    fn what_is_not_changed_stays_as_it_was_written() {
        let york = Network::shipped("new-york").expect("a shipped network");
        let change = json!({"fleet.midnight.count": 20, "vertiports.JFK.stands": 9, "operations.passenger_wait_s": 600});
        let text = york.changed(change.as_object().expect("changes")).expect("a network");
        let lines = |network: &Network| -> Vec<String> {
            network.toml().lines().map(str::to_owned).collect()
        };
        let (before, after) = (lines(&york), lines(&text));
        let new: Vec<&str> =
            after.iter().filter(|line| !before.contains(line)).map(String::as_str).collect();
        assert_eq!(after.len(), before.len() + 2, "members that were there are changed in place");
        let [start, wait, stands, count] = new[..] else { panic!("{new:?}") };
        assert!(start.starts_with("start_stands = ["), "{start}");
        assert_eq!((wait, stands), ("passenger_wait_s = 600", "stands = 9"));
        assert!(count.starts_with("count = 20"), "{count}");
    }

    #[test]
    fn lists_may_be_written_within_a_line() {
        let york = Network::shipped("new-york").expect("a shipped network");
        let members = york.members("vertiports.*.stands").expect("stands").len();
        let ports = york.members("vertiports").expect("a list").remove(0).1;
        let inline = york.changed([(&"vertiports".to_owned(), &ports)]).expect("the same");
        let change = json!({"vertiports.JFK.stands": 9, "vertiports.1.stands": 7, "vertiports.*.busy": false});
        let changed = inline.changed(change.as_object().expect("changes")).expect("a network");
        assert_eq!(changed.vertiports().len(), members);
        let stands =
            |id: &str| changed.vertiports().iter().find(|one| one.id == id).map(|one| one.stands);
        assert_eq!((stands("JFK"), stands("JRA"), stands("LGA")), (Some(9), Some(7), Some(6)));
    }

    #[test]
    fn a_star_is_every_entry() {
        let network = changed(&json!({"vertiports.*.stands": 8})).expect("a network");
        assert!(network.vertiports().iter().all(|vertiport| vertiport.stands == 8));
    }

    #[test]
    fn a_network_without_a_market_can_get_one() {
        let network = changed(&json!({"market.elasticity": 1.5, "tariffs.fare_level": 1.1}));
        let paper = Network::shipped("paper").expect("a shipped network");
        let (now, before) = (network.expect("a network").mean_demand(), paper.mean_demand());
        assert!(now[3].cells()[1] < before[3].cells()[1]);
    }

    #[test]
    fn a_path_that_leads_nowhere_is_named() {
        for path in [
            "vertiports.V99.stands",
            "fleet.7.count",
            "operation.hold_s",
            "name.first",
            "fleet.0.colour",
            "tariffs.fare_lev",
            "aircraft_types.*.seatz",
            "colour",
        ] {
            let error = changed(&json!({path: 1})).expect_err("no such member");
            assert_eq!(error.code().to_string(), "V123", "{path}: {error}");
            assert!(error.to_string().contains(path), "{error}");
        }
    }

    #[test]
    fn what_the_format_does_not_know_is_refused() {
        let codes = [
            (json!({"fleet.0.count": "red"}), "V106"),
            (json!({"fleet.0.count": -1}), "V104"),
            (json!({"fleet.0.count": 4000}), "V117"),
            (json!({"fleet.0.count": null}), "V105"),
        ];
        for (changes, code) in codes {
            let error = changed(&changes).expect_err("no such network");
            assert_eq!(error.code().to_string(), code, "{error}");
        }
    }
}
