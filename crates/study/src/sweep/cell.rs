//! A cell of a sweep: the network with some members of its file changed.

use rayon::prelude::{IntoParallelIterator, ParallelIterator};
use serde_json::Value;
use vertifleet_core::{Error as CoreError, Network};

use super::design::{Design, Factor};
use crate::error::Error;

/// A cell of a sweep.
#[derive(Debug)]
pub struct Cell {
    /// The values of the factors.
    pub settings: Vec<Value>,
    /// The changed network, or the reason why there is none.
    pub network: Result<Box<Network>, String>,
}

impl Cell {
    /// The cells of a design. A cell whose fleet has no aircraft, or no place, has no network; any
    /// other change that the format refuses is an error.
    ///
    /// # Errors
    /// Returns the errors of [`Design::cells`], those of [`Network::changed`], and [`Error::Asked`]
    /// if no cell has a network.
    pub fn all(base: &Network, factors: &[Factor], design: Design) -> Result<Vec<Self>, Error> {
        let settings = design.cells(factors)?;
        each_counts(base, factors)?;
        let cell = |settings| Self::of(base, factors, settings);
        let cells: Vec<Self> = settings.into_par_iter().map(cell).collect::<Result<_, Error>>()?;
        if cells.iter().any(|cell| cell.network.is_ok()) {
            return Ok(cells);
        }
        let reason = cells.into_iter().find_map(|cell| cell.network.err()).unwrap_or_default();
        Err(Error::Asked {
            rule: format!("no cell of the sweep can be played: {reason}"),
            hint: "vary over smaller fleets or more stands",
        })
    }

    pub(super) fn of(
        base: &Network,
        factors: &[Factor],
        settings: Vec<Value>,
    ) -> Result<Self, Error> {
        let paths = factors.iter().map(|factor| &factor.path);
        let network = match base.changed(paths.zip(&settings)) {
            Ok(network) => Ok(Box::new(network)),
            // A grid over fleets and stands has such fleets in its corners.
            Err(error) if matches!(&error, CoreError::InFile { error, .. } if error.is_fleet_size()) => {
                Err(error.to_string())
            }
            Err(error) => return Err(Error::from(error)),
        };
        Ok(Self { settings, network })
    }
}

/// Sees that no factor is undone by a later one that sets the same members.
fn each_counts(base: &Network, factors: &[Factor]) -> Result<(), Error> {
    let members = |factor: &Factor| -> Vec<String> {
        // A member that the file does not have yet is its own.
        let found = base.members(&factor.path).unwrap_or_default();
        if found.is_empty() {
            return vec![factor.path.clone()];
        }
        found.into_iter().map(|(path, _)| path).collect()
    };
    let all: Vec<Vec<String>> = factors.iter().map(members).collect();
    for (at, own) in all.iter().enumerate() {
        let later =
            all[at + 1..].iter().position(|other| own.iter().all(|one| other.contains(one)));
        if let Some(later) = later {
            return Err(Error::Asked {
                rule: format!(
                    "{:?} is undone by {:?}, which sets the same members",
                    factors[at].path,
                    factors[at + 1 + later].path
                ),
                hint: "vary a member by one path",
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use vertifleet_core::{Coded, Network};

    use super::Cell;
    use crate::sweep::{Design, Factor};

    fn refused(texts: [&str; 2]) -> Option<String> {
        let paper = Network::shipped("paper").expect("a shipped network");
        let factors = texts.map(|text| Factor::parse(text).expect("a factor"));
        let error = Cell::all(&paper, &factors, Design::Grid).err()?;
        Some(format!("{}: {error}", error.code()))
    }

    #[test]
    fn no_factor_is_undone_by_another() {
        let twice = ["vertiports.0.stands=6,7", "vertiports.V1.stands=6,7"];
        let text = refused(twice).expect("the first would change nothing");
        assert!(text.starts_with("V407") && text.contains("undone"), "{text}");
        assert!(refused(["vertiports.V1.stands=6,7", "vertiports.*.stands=6,7"]).is_some());
        assert_eq!(refused(["vertiports.*.stands=6,7", "vertiports.V1.stands=6,7"]), None);
        assert_eq!(refused(["market.elasticity=0,1", "market.demand_factor=1,2"]), None);
    }

    #[test]
    fn a_fleet_without_aircraft_or_without_a_place_is_left_out() {
        let york = Network::shipped("new-york").expect("a shipped network");
        let fleets = ["fleet.midnight.count=0,16,400", "fleet.joby-s4.count=0,8"];
        let factors = fleets.map(|text| Factor::parse(text).expect("a factor"));
        let cells = Cell::all(&york, &factors, Design::Grid).expect("some fleets have a place");
        let sizes = cells.iter().map(|cell| cell.network.as_ref().map(|one| one.fleet_size()));
        let sizes: Vec<Option<usize>> = sizes.map(Result::ok).collect();
        assert_eq!(sizes, [None, Some(8), Some(16), Some(24), None, None]);
        let none = cells[0].network.as_ref().expect_err("no aircraft");
        assert!(none.contains("the fleet has no aircraft"), "{none}");
    }

    #[test]
    fn a_sweep_has_a_cell_that_can_be_played() {
        let text = refused(["fleet.0.count=400,500", "operations.hold_s=600,900"]);
        assert!(text.expect("no fleet has a place").contains("no cell of the sweep can be played"));
    }
}
