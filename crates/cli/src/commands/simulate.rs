//! `vertifleet simulate`: plays a day with one policy.

use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;

use vertifleet_core::{Code, Outputs, Scenario};
use vertifleet_policy::play;
use vertifleet_sim::{DayTotals, Simulation, Trace};
use vertifleet_study::policies::{self, Choice};

use crate::args::SimulateArguments;
use crate::commands::{read_scenario, reads_models};
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;
use crate::output::{print, warn};

pub(crate) fn run(arguments: &SimulateArguments) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    let scenario = Arc::new(read_scenario(&arguments.scenario)?);
    let choice =
        Choice { name: &arguments.policy, seed: arguments.seed, model: arguments.model.as_ref() };
    let (recipe, warning) = policies::for_scenario(&choice, &scenario)?;
    if let Some(trace) = &arguments.trace {
        claim(trace, arguments)?;
    }
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

/// The trace is none of the files that are read.
fn claim(trace: &Path, arguments: &SimulateArguments) -> Result<(), Failure> {
    let mut outputs = Outputs::new(arguments.force);
    outputs.reads(&arguments.scenario);
    reads_models(&arguments.model, &mut outputs);
    if let Some(replayed) = arguments.policy.strip_prefix("replay:") {
        outputs.reads(Path::new(replayed));
    }
    outputs.prints();
    Ok(outputs.writes(trace, &Trace::FILE)?)
}

fn text(summary: &DayTotals, scenario: &Scenario, policy: &str) -> String {
    let DayTotals { flights, repositioning_flights, holds, passengers, spilled_passengers, .. } =
        summary;
    let mut lines = vec![
        format!("{} with {policy}", scenario.name),
        format!("  profit          {:>12.2} $", summary.profit),
        format!("  revenue         {:>12.2} $", summary.revenue),
        format!("  passenger cost  {:>12.2} $", summary.passenger_cost),
        format!(
            "  energy cost     {:>12.2} $  ({:.0} kWh)",
            summary.energy_cost, summary.energy_kwh
        ),
    ];
    let beside = [("flight cost  ", summary.flight_cost), ("aircraft cost", summary.aircraft_cost)];
    let beside = beside.into_iter().filter(|&(_, cost)| cost != 0.0);
    lines.extend(beside.map(|(name, cost)| format!("  {name}   {cost:>12.2} $")));
    lines.extend([
        format!(
            "  reward          {:>12.5}    of {:.0} $ potential",
            summary.reward, summary.potential
        ),
        format!("  flights         {flights:>12}    {repositioning_flights} without passengers"),
        format!("  holds           {holds:>12}"),
        format!("  passengers      {passengers:>12}    {spilled_passengers} spilled"),
        format!("  load factor     {:>11.1} %", 100.0 * summary.load_factor),
    ]);
    lines.join("\n")
}
