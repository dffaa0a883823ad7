//! `vertifleet simulate`: plays a day with one policy.

use std::process::ExitCode;
use std::sync::Arc;

use anstream::println;
use vertifleet_core::Scenario;
use vertifleet_policy::play;
use vertifleet_sim::{Simulation, Summary, Trace};

use crate::args::SimulateArguments;
use crate::commands::read_scenario;
use crate::failure::Failure;
use crate::policies::{self, Choice};

pub(crate) fn run(arguments: &SimulateArguments) -> Result<ExitCode, Failure> {
    let scenario = Arc::new(read_scenario(&arguments.scenario)?);
    let choice =
        Choice { name: &arguments.policy, seed: arguments.seed, model: arguments.model.as_deref() };
    let mut policy = policies::for_scenario(&choice, &scenario)?;
    let mut simulation = Simulation::new(Arc::clone(&scenario));
    let mut trace = Trace::default();
    play(&mut simulation, policy.as_mut(), |row| trace.rows.push(*row))
        .map_err(|error| policies::cannot_play(&arguments.policy, &scenario.name, &error))?;
    if let Some(path) = &arguments.trace {
        trace.write(&scenario, path)?;
    }
    print(&simulation.summary(), &scenario, arguments);
    Ok(ExitCode::SUCCESS)
}

fn print(summary: &Summary, scenario: &Scenario, arguments: &SimulateArguments) {
    if arguments.json {
        println!("{}", serde_json::to_string_pretty(summary).expect("a summary is plain data"));
        return;
    }
    let Summary { flights, repositioning_flights, holds, passengers, spilled_passengers, .. } =
        summary;
    println!("{} with {}", scenario.name, arguments.policy);
    println!("  profit          {:>12.2} $", summary.profit);
    println!("  revenue         {:>12.2} $", summary.revenue);
    println!("  passenger cost  {:>12.2} $", summary.passenger_cost);
    println!("  energy cost     {:>12.2} $  ({:.0} kWh)", summary.energy_cost, summary.energy_kwh);
    println!(
        "  reward          {:>12.5}    of {:.0} $ potential",
        summary.reward, summary.potential
    );
    println!("  flights         {flights:>12}    {repositioning_flights} without passengers");
    println!("  holds           {holds:>12}");
    println!("  passengers      {passengers:>12}    {spilled_passengers} spilled");
    println!("  load factor     {:>11.1} %", 100.0 * summary.load_factor);
}
