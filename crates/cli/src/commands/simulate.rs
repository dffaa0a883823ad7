//! `vertifleet simulate`: plays a day with one policy.

use std::process::ExitCode;
use std::sync::Arc;

use vertifleet_core::{Code, Outputs, Scenario, Stop, write_atomically};
use vertifleet_report::DAY_PAGE;
use vertifleet_sim::{DayTotals, Trace};
use vertifleet_study::account::Account;
use vertifleet_study::{PolicySpec, ResolveFor};

use crate::args::SimulateArguments;
use crate::commands::{read_scenario, reads_policy};
use crate::failure::Failure;
use crate::interrupt::end_on_interrupt;
use crate::output::{print, warn};

pub(crate) fn run(arguments: &SimulateArguments) -> Result<ExitCode, Failure> {
    end_on_interrupt()?;
    let scenario = Arc::new(read_scenario(&arguments.scenario)?);
    let spec = PolicySpec::parse(&arguments.policy)?;
    let days = ResolveFor::Day(&scenario);
    let policy = spec.resolve(arguments.model.as_ref(), days, arguments.seed)?;
    policy.check_fits(&scenario)?;
    claim(arguments, &spec)?;
    if let Some(warning) = policy.warning_for(spec.name(), &scenario) {
        warn(Code(310), &warning);
    }
    // Ctrl-C ends the program itself, so the policy is never asked to stop.
    let (trace, totals) = policy.play(spec.name(), &scenario, &Stop::default())?;
    if let Some(path) = &arguments.trace {
        trace.write(&scenario, path)?;
    }
    if let Some(path) = &arguments.report {
        let account = Account::of(&scenario, spec.name(), trace, totals);
        let replayed = [account.replayed()];
        let page = vertifleet_report::account(&account, &replayed).page();
        write_atomically(path, page.as_bytes())?;
    }
    if arguments.json {
        print(&serde_json::to_string_pretty(&totals).expect("numbers are plain data"))?;
    } else {
        print(&text(&totals, &scenario, spec.name()))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Checks that neither the trace nor the page would replace a file that is read, or one of others.
fn claim(arguments: &SimulateArguments, spec: &PolicySpec) -> Result<(), Failure> {
    let mut outputs = Outputs::new(arguments.force);
    outputs.reads(&arguments.scenario);
    reads_policy(spec, arguments.model.as_ref(), &mut outputs);
    outputs.prints();
    if let Some(trace) = &arguments.trace {
        outputs.writes(trace, &Trace::FILE)?;
    }
    if let Some(page) = &arguments.report {
        outputs.writes(page, &DAY_PAGE)?;
    }
    Ok(())
}

fn text(totals: &DayTotals, scenario: &Scenario, policy: &str) -> String {
    let DayTotals { flights, repositioning_flights, holds, passengers, spilled_passengers, .. } =
        totals;
    let mut lines = vec![
        format!("{} with {policy}", scenario.name),
        format!("  profit          {:>12.2} $", totals.profit_usd),
        format!("  revenue         {:>12.2} $", totals.revenue_usd),
        format!("  passenger cost  {:>12.2} $", totals.passenger_cost_usd),
        format!(
            "  energy cost     {:>12.2} $  ({:.0} kWh)",
            totals.energy_cost_usd, totals.energy_kwh
        ),
    ];
    let fixed_costs = [
        ("flight cost  ", totals.flight_cost_usd),
        ("aircraft cost", totals.aircraft_cost_usd),
        ("site cost    ", totals.site_cost_usd),
    ];
    // What aircraft cost is said also if it is nothing: a network may not know it.
    let fixed_costs =
        fixed_costs.into_iter().filter(|&(name, cost)| cost != 0.0 || name == "aircraft cost");
    lines.extend(fixed_costs.map(|(name, cost)| format!("  {name}   {cost:>12.2} $")));
    lines.extend([
        format!(
            "  reward          {:>12.5}    of {:.0} $ potential",
            totals.reward, totals.potential_usd
        ),
        format!("  flights         {flights:>12}    {repositioning_flights} without passengers"),
        format!("  holds           {holds:>12}"),
        format!("  passengers      {passengers:>12}    {spilled_passengers} spilled"),
        format!("  load factor     {:>11.1} %", 100.0 * totals.load_factor),
    ]);
    lines.join("\n")
}
