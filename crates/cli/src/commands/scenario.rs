//! `vertifleet scenario`: draws days of a network.

use std::path::Path;
use std::process::ExitCode;

use vertifleet_core::{DaySeed, Network, Outputs, Scenario};
use vertifleet_progress::Bar;

use crate::args::ScenarioArguments;
use crate::commands::{find_network, warn_unserved_days};
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;
use crate::output::print;

pub(crate) fn run(arguments: &ScenarioArguments) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    let mut outputs = Outputs::new(arguments.force);
    let network = find_network(&arguments.network, &mut outputs)?;
    if let Some(days) = arguments.days {
        let folder = arguments.output.as_deref().unwrap_or(Path::new("."));
        draw_days(&network, arguments.seed, days, folder, &mut outputs)?;
        return Ok(ExitCode::SUCCESS);
    }
    let day = network.draw(DaySeed::comparison(arguments.seed)?);
    if let Some(file) = &arguments.output {
        outputs.writes(file, &Scenario::FILE)?;
    }
    warn_unserved_days([&day]);
    match &arguments.output {
        None => print(&day.to_json())?,
        Some(file) => day.write(file)?,
    }
    Ok(ExitCode::SUCCESS)
}

fn draw_days(
    network: &Network,
    seed: u64,
    days: u32,
    folder: &Path,
    outputs: &mut Outputs,
) -> Result<(), Failure> {
    // The last seed is checked first, so that nothing is written if one of the days cannot be
    // drawn.
    DaySeed::comparison(seed.saturating_add(u64::from(days) - 1))?;
    if folder.exists() {
        for day in 0..u64::from(days) {
            let name = format!("{}-{}.json", network.name(), seed + day);
            outputs.writes(&folder.join(name), &Scenario::FILE)?;
        }
    }
    vertifleet_core::create_folder(folder)?;
    warn_unserved_days([&network.draw(DaySeed::comparison(seed)?)]);
    let progress = Bar::new(u64::from(days), "days");
    for day in 0..u64::from(days) {
        let scenario = network.draw(DaySeed::comparison(seed + day)?);
        scenario.write(folder.join(format!("{}.json", scenario.name)))?;
        progress.advance(1);
    }
    Ok(())
}
