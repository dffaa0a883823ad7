//! `vertifleet scenario`: draws days of a network.

use std::path::Path;
use std::process::ExitCode;

use vertifleet_core::{DaySeed, Network};
use vertifleet_progress::Bar;

use crate::args::ScenarioArguments;
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;
use crate::output::print;

pub(crate) fn run(arguments: &ScenarioArguments) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    let network = Network::find(&arguments.network)?;
    match (arguments.days, &arguments.output) {
        (None, None) => {
            print(&network.draw(DaySeed::comparison(arguments.seed)?).to_json())?;
        }
        (None, Some(file)) => {
            network.draw(DaySeed::comparison(arguments.seed)?).write(file)?;
        }
        (Some(days), folder) => {
            let here = Path::new(".");
            draw_days(&network, arguments.seed, days, folder.as_deref().unwrap_or(here))?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn draw_days(network: &Network, seed: u64, days: u32, folder: &Path) -> Result<(), Failure> {
    // The last seed first, so that nothing is written where not everything can be.
    DaySeed::comparison(seed.saturating_add(u64::from(days) - 1))?;
    vertifleet_core::create_folder(folder)?;
    let progress = Bar::new(u64::from(days), "days");
    for day in 0..u64::from(days) {
        let scenario = network.draw(DaySeed::comparison(seed + day)?);
        scenario.write(folder.join(format!("{}.json", scenario.name)))?;
        progress.advance(1);
    }
    Ok(())
}
