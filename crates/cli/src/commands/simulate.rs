//! `vertifleet simulate`: plays a day with one policy.

use std::process::ExitCode;
use std::sync::Arc;

use vertifleet_core::{Code, Scenario};
use vertifleet_policy::play;
use vertifleet_sim::{Simulation, Summary, Trace};
use vertifleet_study::policies::{self, Choice};

use crate::args::SimulateArguments;
use crate::commands::read_scenario;
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;
use crate::output::{print, warn};

pub(crate) fn run(arguments: &SimulateArguments) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    let scenario = Arc::new(read_scenario(&arguments.scenario)?);
    let choice =
        Choice { name: &arguments.policy, seed: arguments.seed, model: arguments.model.as_ref() };
    let (recipe, warning) = policies::for_scenario(&choice, &scenario)?;
    if let Some(warning) = warning {
        warn(Code(310), &warning);
    }
    let mut simulation = Simulation::new(Arc::clone(&scenario));
    let mut trace = Trace::default();
    play(&mut simulation, recipe.make().as_mut(), |row| trace.rows.push(*row)).map_err(
        |cause| vertifleet_study::Error::Stuck {
            policy: arguments.policy.clone(),
            day: scenario.name.clone(),
            cause,
        },
    )?;
    if let Some(path) = &arguments.trace {
        trace.write(&scenario, path)?;
    }
    let summary = simulation.summary();
    if arguments.json {
        print(&serde_json::to_string_pretty(&summary).expect("a summary is plain data"))?;
    } else {
        print(&text(&summary, &scenario, &arguments.policy))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn text(summary: &Summary, scenario: &Scenario, policy: &str) -> String {
    let Summary { flights, repositioning_flights, holds, passengers, spilled_passengers, .. } =
        summary;
    let lines = [
        format!("{} with {policy}", scenario.name),
        format!("  profit          {:>12.2} $", summary.profit),
        format!("  revenue         {:>12.2} $", summary.revenue),
        format!("  passenger cost  {:>12.2} $", summary.passenger_cost),
        format!(
            "  energy cost     {:>12.2} $  ({:.0} kWh)",
            summary.energy_cost, summary.energy_kwh
        ),
        format!(
            "  reward          {:>12.5}    of {:.0} $ potential",
            summary.reward, summary.potential
        ),
        format!("  flights         {flights:>12}    {repositioning_flights} without passengers"),
        format!("  holds           {holds:>12}"),
        format!("  passengers      {passengers:>12}    {spilled_passengers} spilled"),
        format!("  load factor     {:>11.1} %", 100.0 * summary.load_factor),
    ];
    lines.join("\n")
}
