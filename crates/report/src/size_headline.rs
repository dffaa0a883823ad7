//! The result of a search in a few sentences.

use vertifleet_picture::numbers::{counted, dollars, grouped, signed};

use vertifleet_study::size::{Certificate, DesignSummary, SizeReport};
use vertifleet_study::statistics::Estimate;

/// States the design that was found, its profit on days that were not part of the search, and its
/// largest distance from the optimum.
pub(crate) fn headline(report: &SizeReport) -> String {
    let parts = [
        better(report),
        found(report),
        neighbours(report),
        again(report),
        certificate(report),
        doubts(report),
    ];
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" ")
}

/// The warning that the current network, which was not searched, is better than the design found.
fn better(report: &SizeReport) -> String {
    let better = report.left_out.as_ref().filter(|file| file.is_better);
    better.map_or_else(String::new, |file| {
        format!(
            "The network as it is is better than every design that was played, and these numbers leave it out: {} earns {} a day \
             with it and carries {:.1} %.",
            report.policy,
            estimate(&file.profit_usd),
            100.0 * file.served_share
        )
    })
}

fn found(report: &SizeReport) -> String {
    let best = report.found();
    let size = &best.size;
    let chargers =
        if size.chargers > 0 { format!(", {} chargers", size.chargers) } else { String::new() };
    let has = format!(
        "{} and {}{chargers}",
        counted(size.aircraft, "aircraft", "aircraft"),
        counted(size.stands as usize, "stand", "stands")
    );
    let does =
        format!("{} earns {} a day and carries {}", report.policy, earns(best), carries(best));
    if report.goal_is_reached {
        format!("Found: {has}, with which {does}.")
    } else {
        format!(
            "No design that was played carries enough. With the one that carries most, {has}, {does}."
        )
    }
}

/// The designs next to the one that was found.
fn neighbours(report: &SizeReport) -> String {
    match report.neighbours {
        0 => String::new(),
        1 => "The design that differs by a step in one number is not better on these days."
            .to_owned(),
        many => format!(
            "None of the {many} designs that differ by a step in one number is better on these days."
        ),
    }
}

fn again(report: &SizeReport) -> String {
    let days = counted(report.days as usize, "further day", "further days");
    let best = &report.best_on_holdout;
    let does = format!("{}, {} carried", earns(best), carries(best));
    match &report.holdout_gain_usd {
        Some(more) => {
            let half = more
                .half_width_95
                .map_or_else(String::new, |half| format!(" ± {}", grouped(half, 0)));
            let than = report.now_on_holdout.served_share;
            format!(
                "On {days}, which the search did not use: {does}; that is {}{half} $ a day against the network {}, \
                 which carries {:.1} %.",
                signed(more.mean, 0),
                report.name_of_start(),
                100.0 * than
            )
        }
        None => {
            format!(
                "It is the network {}. On {days}, which the search did not use: {does}.",
                report.name_of_start()
            )
        }
    }
}

/// The proven bound.
fn certificate(report: &SizeReport) -> String {
    match report.certificate {
        Certificate::MostProfit { no_design_earns_more_than_usd: most, gap } => format!(
            "No design within these limits earns more than {} a day on the days of the search, under any policy: this one, with {}, \
             is {:.1} % below that, and the bound of this design {:.1} %.",
            dollars(most),
            report.policy,
            100.0 * gap,
            100.0 * vertifleet_optimize::gap(most, report.found().ceiling)
        ),
        Certificate::MostPassengers { no_design_carries_more_than: most, gap } => format!(
            "No design within these limits carries more than {} passengers a day on the days of the search, under any policy, so that \
             at least {} are left behind: this one, with {}, carries {:.1} % less.",
            grouped(most, 1),
            grouped((report.wanted_passengers - most).max(0.0), 1),
            report.policy,
            100.0 * gap
        ),
        Certificate::LeastCost { no_design_costs_less_than_usd: least }
            if !report.goal_is_reached =>
        {
            format!(
                "No design that carries enough on the days of the search costs less than {} a day, under any policy.",
                dollars(least)
            )
        }
        Certificate::FewestAircraft { no_design_has_fewer_than: least }
            if !report.goal_is_reached =>
        {
            format!(
                "No design that carries enough on the days of the search has fewer than {least} aircraft, under any policy.",
            )
        }
        Certificate::LeastCost { no_design_costs_less_than_usd: least } => format!(
            "No design that carries enough on the days of the search costs less than {} a day, under any policy; this one costs {}, \
             {:.0} % more.",
            dollars(least),
            dollars(report.found().size.fixed_cost_usd),
            100.0 * (report.found().size.fixed_cost_usd / least.max(1e-9) - 1.0)
        ),
        Certificate::FewestAircraft { no_design_has_fewer_than: least } => format!(
            "No design that carries enough on the days of the search has fewer than {least} aircraft, under any policy; this one has {}.",
            report.found().size.aircraft
        ),
        Certificate::OutOfReach { no_design_carries_more_than: most } => format!(
            "No design within these limits carries more than {} of the {} passengers a day who would have to be carried on the days \
             of the search, under any policy.",
            grouped(most, 1),
            grouped(report.needed_passengers.unwrap_or(0.0), 1)
        ),
    }
}

/// The limits of the answer.
fn doubts(report: &SizeReport) -> String {
    let mut doubts = Vec::new();
    if !report.goal_is_reached && !matches!(report.certificate, Certificate::OutOfReach { .. }) {
        doubts.push(format!(
            "No bound rules it out: {} may be leaving passengers behind who cost more than they pay.",
            report.policy
        ));
    }
    if let Some(file) = report.left_out.as_ref().filter(|file| !file.is_better) {
        doubts.push(format!(
            "These numbers exclude the current network, with which {} earns {} a day.",
            report.policy,
            estimate(&file.profit_usd)
        ));
    }
    let at_limit = report.dimensions.iter().filter(|one| one.is_at_limit()).count();
    if at_limit > 0 {
        doubts.push(format!(
            "{} at the highest number that was searched, and more might be better.",
            counted(at_limit, "member is", "members are")
        ));
    }
    if report.ended_early {
        doubts.push("The search ended because its days were used up; with more --designs it may find a better one.".to_owned());
    }
    doubts.join(" ")
}

fn earns(design: &DesignSummary) -> String {
    estimate(&design.profit_usd)
}

fn estimate(profit: &Estimate) -> String {
    let half =
        profit.half_width_95.map_or_else(String::new, |half| format!(" ± {}", grouped(half, 0)));
    format!("{}{half}", dollars(profit.mean))
}

fn carries(design: &DesignSummary) -> String {
    format!("{:.1} %", 100.0 * design.served_share)
}
