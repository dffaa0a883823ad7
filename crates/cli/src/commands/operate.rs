//! `vertifleet operate`: operates a day through a dispatch service.

use std::process::ExitCode;
use std::sync::Arc;

use vertifleet_core::{DaySeed, Outputs};
use vertifleet_progress::Bar;
use vertifleet_serve::{Operation, OperationReport, operate};

use crate::args::{OperateArguments, Speed};
use crate::commands::find_network;
use crate::failure::Failure;
use crate::interrupt::stop_on_interrupt;
use crate::output::print;

pub(crate) fn run(arguments: &OperateArguments) -> Result<ExitCode, Failure> {
    let stop = stop_on_interrupt()?;
    let network = find_network(&arguments.network, &mut Outputs::new(false))?;
    let day = Arc::new(network.draw(DaySeed::comparison(arguments.seed)?));
    let (start, end) = (day.operations.start, day.operations.end);
    let speed = match arguments.speed {
        Speed::Times(times) => Some(times),
        Speed::Max => None,
    };
    let (url, policy) = (arguments.url.clone(), arguments.policy.clone());
    let trusted = arguments.trust.clone();
    let token = std::env::var("VERTIFLEET_TOKEN").ok();
    let by_hand = arguments.by_hand;
    let time_zone = network.time_zone().map(str::to_owned);
    let operation = Operation { url, day, time_zone, policy, token, trusted, speed, by_hand };
    let bar = Bar::new(u64::from(end.since(start) / 60), "minutes of the day");
    let mut shown = 0;
    let report = operate(&operation, &stop, |now, _| {
        let minute = u64::from(now.since(start) / 60);
        bar.advance(minute - shown);
        shown = minute;
    })?;
    drop(bar);
    let Some(report) = report else { return Ok(ExitCode::FAILURE) };
    if arguments.json {
        print(&serde_json::to_string_pretty(&report).expect("numbers are plain data"))?;
    } else {
        print(&text(&report, arguments))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn text(report: &OperationReport, arguments: &OperateArguments) -> String {
    let OperationReport { totals, .. } = report;
    [
        format!("day {} of {} with {}", report.day, arguments.network, arguments.policy),
        format!("  profit          {:>12.2} $", totals.profit_usd),
        format!(
            "  flights         {:>12}    {} without passengers",
            totals.flights, totals.repositioning_flights
        ),
        format!(
            "  passengers      {:>12}    {} spilled",
            totals.passengers, totals.spilled_passengers
        ),
        format!("  events          {:>12}    {} decisions", report.events, totals.decisions),
        format!(
            "  decision        {:>9.2} ms    99 % within {:.2} ms",
            report.decision_median_ms, report.decision_p99_ms
        ),
    ]
    .join("\n")
}
