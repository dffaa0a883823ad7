//! A cell of a sweep: the network with some members of its file changed.

use rayon::prelude::{IntoParallelIterator, ParallelIterator};
use serde_json::Value;
use vertifleet_core::{Coded, Network};

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
    /// The cells of a design. A cell whose fleet has no place has no network; any other change that the format refuses is an
    /// error.
    ///
    /// # Errors
    /// Returns the errors of [`Design::cells`], those of [`Network::changed`], and [`Error::Asked`] if no cell has a network.
    pub fn all(base: &Network, factors: &[Factor], design: Design) -> Result<Vec<Self>, Error> {
        let settings = design.cells(factors)?;
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
            // A fleet without a place is what a grid over fleets and stands has in its corner.
            Err(error) if error.code().0 == 117 => Err(error.to_string()),
            Err(error) => return Err(Error::from(error)),
        };
        Ok(Self { settings, network })
    }
}
