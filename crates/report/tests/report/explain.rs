//! The parts of an explanation add up to the day, and the value of a change is the difference
//! between two solved days.

use std::sync::Arc;

use vertifleet_core::{DaySeed, Network, Stop};
use vertifleet_optimize::{Bound, Step, upper_bound};
use vertifleet_report::{EXPLANATION_PAGE, explanation};
use vertifleet_sim::Trace;
use vertifleet_study::account::Account;
use vertifleet_study::explain::{Explanation, explain};
use vertifleet_study::{PolicySpec, ResolveFor, ResolvedPolicy};

fn day(network: &str) -> Arc<vertifleet_core::Scenario> {
    let network = Network::find(network).expect("a network");
    Arc::new(network.draw(DaySeed::comparison(3).expect("a seed")))
}

fn explained(network: &str, policy: &ResolvedPolicy) -> Explanation {
    let step = Step::from_minutes(60).expect("a step");
    explain(&day(network), "greedy", policy, step, &Stop::default(), &|_| ()).expect("a day")
}

fn page(explained: &Explanation) -> String {
    explanation(explained, &[explained.account.replayed()]).page()
}

fn text(explained: &Explanation) -> String {
    explanation(explained, &[]).text()
}

fn day_page(account: &Account) -> String {
    vertifleet_report::account(account, &[account.replayed()]).page()
}

fn greedy() -> ResolvedPolicy {
    let spec = PolicySpec::parse("greedy").expect("a policy");
    spec.resolve(None, ResolveFor::Day(&day("paper")), 0).expect("it has no weights")
}

#[test]
fn periods_pairs_and_aircraft_add_up_to_the_day() {
    for network in ["paper", "disrupted"] {
        let found = explained(network, &greedy());
        let totals = &found.account.totals;
        let sum = |numbers: Vec<u64>| numbers.into_iter().sum::<u64>();
        let periods = &found.account.periods;
        assert_eq!(sum(periods.iter().map(|one| one.demand.carried).collect()), totals.passengers);
        assert_eq!(
            sum(periods.iter().map(|one| one.demand.spilled).collect()),
            totals.spilled_passengers
        );
        assert_eq!(
            sum(periods.iter().map(|one| one.flights.into()).collect()),
            u64::from(totals.flights)
        );
        assert_eq!(
            sum(periods.iter().map(|one| one.holds.into()).collect()),
            u64::from(totals.holds)
        );
        let cells = &found.account.spilled;
        assert_eq!(
            sum(cells.iter().map(|one| one.demand.spilled).collect()),
            totals.spilled_passengers
        );
        assert!(cells.iter().all(|one| one.demand.spilled > 0));
        let pairs = &found.account.pairs;
        assert_eq!(sum(pairs.iter().map(|one| one.demand.carried).collect()), totals.passengers);
        assert_eq!(
            sum(pairs.iter().map(|one| one.flights.into()).collect()),
            u64::from(totals.flights)
        );
        assert!(pairs.is_sorted_by(|one, next| !next.can_be_flown
            || one.demand.spilled_margin_usd >= next.demand.spilled_margin_usd));
        let earned = |usd: f64| (usd - totals.profit_usd).abs() < 1e-6 * totals.revenue_usd;
        assert!(earned(pairs.iter().map(|one| one.profit_usd).sum()));
        assert!(earned(found.account.aircraft.iter().map(|one| one.profit_usd).sum()));
        let hours = 12.0;
        for one in &found.account.aircraft {
            let on_the_ground_h = one.charging_h + one.out_of_service_h + one.waiting_h;
            assert!((one.flying_h + on_the_ground_h - hours).abs() < 1e-9, "{one:?}");
        }
        for one in &found.account.vertiports {
            assert!(
                (0.0..=1.0).contains(&one.taken_share) && one.full_share <= one.taken_share + 1e-9
            );
            let worth = one.stand_worth.as_ref().expect("the day has a bound");
            let by_period: f64 = worth.stand_shadow_price_by_period_usd.iter().sum();
            assert!((by_period - worth.stand_shadow_price_usd).abs() < 1e-4, "{one:?}");
        }
    }
}

#[test]
fn a_worth_is_the_difference_of_two_days_that_were_solved() {
    let found = explained("paper", &greedy());
    let words: Vec<&str> = found.worth.iter().map(|one| one.change.as_str()).collect();
    assert_eq!(words.len(), 8 + 3, "{words:?}");
    let seat = found.worth.iter().find(|one| one.change.contains("seat")).expect("a seat");
    let mut changed = vertifleet_core::Scenario::clone(&day("paper")).into_day();
    changed.aircraft_types[0].seats += 1;
    let changed = Arc::new(changed.check("a changed day").expect("a day"));
    let (_, totals) = greedy().play("greedy", &changed, &Stop::default()).expect("a whole day");
    assert_eq!(seat.policy_usd, Some(totals.profit_usd - found.account.totals.profit_usd));
    let bound = upper_bound(&changed, Step::from_minutes(60).expect("a step")).expect("a bound");
    let own = upper_bound(&day("paper"), Step::from_minutes(60).expect("a step")).expect("a bound");
    assert_eq!(seat.bound_usd, bound.upper_bound_usd() - own.upper_bound_usd());
    assert!(
        !seat.is_within_error && seat.bound_usd > 5_000.0,
        "a fifth seat is worth much where flights are full"
    );
}

/// With a passenger a day for each pair, every seat but one stays empty.
#[test]
fn what_nothing_can_be_gained_by_is_within_the_error_of_the_bound() {
    for network in ["paper", "paper-quick"] {
        let mut idle = vertifleet_core::Scenario::clone(&day(network)).into_day();
        for table in &mut idle.demand {
            table.cells_mut().iter_mut().for_each(|passengers| *passengers = (*passengers).min(1));
        }
        let idle = Arc::new(idle.check("a day with few passengers").expect("a day"));
        let step = Step::from_minutes(60).expect("a step");
        let found = explain(&idle, "greedy", &greedy(), step, &Stop::default(), &|_| ());
        let found = found.expect("a day");
        let seat = found.worth.iter().find(|one| one.change.contains("seat")).expect("a seat");
        assert!(seat.is_within_error && seat.bound_usd >= 0.0, "{network}: {seat:?}");
        assert!(text(&found).contains("within its error"), "{network}");
    }
}

/// Batteries that outlast the day need no more energy and no more power.
#[test]
fn energy_that_no_flight_needs_is_worth_nothing() {
    let mut ample = vertifleet_core::Scenario::clone(&day("paper-quick")).into_day();
    ample.aircraft_types[0].battery_kwh = 2_000.0;
    let ample = Arc::new(ample.check("a day with huge batteries").expect("a day"));
    let step = Step::from_minutes(60).expect("a step");
    let found = explain(&ample, "greedy", &greedy(), step, &Stop::default(), &|_| ());
    for worth in &found.expect("a day").worth {
        if worth.change.contains("10 kWh") || worth.change.contains("1 kW") {
            assert!(worth.is_within_error, "{worth:?}");
        }
    }
}

/// The prices of two searches count on both days, and those of other searches on neither.
#[test]
fn bounds_by_the_same_prices_are_compared() {
    let step = Step::from_minutes(60).expect("a step").with_levels(16).expect("levels");
    let day = day("paper-quick");
    let found = explain(&day, "greedy", &greedy(), step, &Stop::default(), &|_| ());
    let found = found.expect("a day");
    let own = upper_bound(&day, step).expect("a bound");
    let rise = |changed: vertifleet_core::Day| {
        let changed = changed.check("a changed day").expect("a day");
        let bound = upper_bound(&changed, step).expect("a bound");
        let across =
            |bound: &Bound, day| bound.of_other_usd(day, &Stop::default()).expect("prices");
        bound.upper_bound_usd().min(across(&own, &changed))
            - own.upper_bound_usd().min(across(&bound, &day))
    };
    let worth = |words: &str| {
        found.worth.iter().find(|one| one.change.contains(words)).expect("a change").bound_usd
    };
    let mut changed = vertifleet_core::Scenario::clone(&day).into_day();
    changed.aircraft_types[0].battery_kwh += 10.0;
    assert_eq!(worth("10 kWh more"), rise(changed));
    let mut changed = vertifleet_core::Scenario::clone(&day).into_day();
    changed.operations.takeoff_s -= 60;
    assert_eq!(worth("a minute less"), rise(changed));
}

#[test]
fn no_change_is_worth_more_by_the_bound_than_it_can_be_nor_less() {
    // San Francisco's stands, chargers and aircraft cost something; the aircraft of `disrupted`
    // have outages.
    for network in ["paper", "disrupted", "san-francisco", "random:7", "random-places:2:1"] {
        let day = day(network);
        let found = explained(network, &greedy());
        let alone = upper_bound(&day, Step::from_minutes(60).expect("a step")).expect("a bound");
        assert!(found.upper_bound_usd <= alone.upper_bound_usd(), "{network}");
        assert!(found.upper_bound_usd >= found.account.totals.profit_usd, "{network}");
        let price_usd = |id: &str| {
            let at = found.account.vertiports.iter().find(|one| one.id == id).expect("an id");
            at.stand_worth.as_ref().expect("the day has a bound").stand_shadow_price_usd
        };
        for one in &found.worth {
            let (worth_usd, about) = (one.bound_usd + one.cost_usd, 1e-4);
            if let Some((_, id)) = one.change.split_once(" at ") {
                let range = -about..=price_usd(id) + about;
                assert!(range.contains(&worth_usd), "{network}: {one:?}, {range:?}");
            } else if one.change.contains("seat") {
                assert!(one.cost_usd == 0.0 && worth_usd >= -about, "{network}: {one:?}");
            } else if one.change.starts_with("one more") {
                assert_eq!(one.cost_usd, day.aircraft_cost_usd, "{network}: {one:?}");
            }
        }
    }
}

#[test]
fn a_trace_is_explained_without_playing_other_days() {
    let (trace, _) = greedy().play("greedy", &day("paper"), &Stop::default()).expect("a day");
    let found = explained("paper", &ResolvedPolicy::Replay(Arc::new(Trace::clone(&trace))));
    assert!(found.worth.iter().all(|one| one.policy_usd.is_none() && one.bound_usd.is_finite()));
    assert_eq!(found.account.totals, explained("paper", &greedy()).account.totals);
}

#[test]
fn page_and_text_have_the_numbers_of_json() {
    let found = explained("paper", &greedy());
    let page = page(&found);
    assert!(page.starts_with(EXPLANATION_PAGE.opening), "the program recognises its own pages");
    for part in [
        "<svg",
        "Ledger",
        "V1 → V2",
        "one more cityairbus",
        "one more stand before its cost, $",
        "profit before aircraft cost, $",
        "iframe",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(text(&found).contains("Where most money is spilled"));
    let json: serde_json::Value = serde_json::from_str(&found.to_json()).expect("JSON");
    assert_eq!(json["format"], "vertifleet-explanation/1");
    assert_eq!(json["worth"].as_array().expect("a list").len(), found.worth.len());
}

#[test]
fn demand_out_of_reach_is_counted_separately_and_not_ranked() {
    // With a battery for the mean distance only, about half of all pairs are out of range.
    let mut near = vertifleet_core::Scenario::clone(&day("paper")).into_day();
    let distances_mi: Vec<f64> = near.distance_mi.cells().to_vec();
    let mean_mi = distances_mi.iter().sum::<f64>() / distances_mi.len() as f64;
    near.aircraft_types[0].battery_kwh = mean_mi * near.aircraft_types[0].energy_kwh_per_mi;
    let near = Arc::new(near.check("a day of short ranges").expect("a day"));
    let (trace, totals) = greedy().play("greedy", &near, &Stop::default()).expect("a whole day");
    let account = Account::of(&near, "greedy", trace, totals);
    let apart = account.cannot_be_flown;
    assert!(apart.spilled > 0 && apart.carried == 0 && apart.spilled == apart.wanted);
    let (first, last) =
        account.pairs.split_at(account.pairs.iter().filter(|one| one.can_be_flown).count());
    assert!(!first.is_empty() && first.iter().all(|one| one.can_be_flown));
    let spilled_usd: f64 = last.iter().map(|one| one.demand.spilled_margin_usd).sum();
    assert!((spilled_usd - apart.spilled_margin_usd).abs() < 1e-6);
    let page = day_page(&account);
    let before_replay = page.split("<iframe").next().expect("a beginning");
    assert!(before_replay.contains("on pairs that no aircraft can fly, for want of"));
    for (pair, is_there) in [(&first[0], true), (&last[0], false)] {
        let row = format!(">{} → {}</th>", pair.from, pair.to);
        assert_eq!(before_replay.contains(&row), is_there, "{row}");
    }
    let everywhere = explained("paper", &greedy());
    assert!(!text(&everywhere).contains("for want of a corridor"));
    assert!(text(&everywhere).contains("Where and when most money is spilled"));
}

#[test]
fn an_outage_does_not_count_as_charging() {
    let found = explained("disrupted", &greedy());
    assert!(found.account.aircraft.iter().any(|one| one.out_of_service_h > 0.0));
    let mut without = vertifleet_core::Scenario::clone(&day("disrupted")).into_day();
    without.disturbances.outages.clear();
    let without = Arc::new(without.check("a day without outages").expect("a day"));
    let (trace, totals) = greedy().play("greedy", &without, &Stop::default()).expect("a whole day");
    let without = Account::of(&without, "greedy", trace, totals);
    assert!(without.aircraft.iter().all(|one| one.out_of_service_h == 0.0));
    // The longest charging of this network's only type is the same with outages and without.
    let most = |account: &Account| {
        let a_flight =
            account.aircraft.iter().map(|one| one.charging_h / f64::from(one.flights.max(1)));
        a_flight.fold(0.0, f64::max)
    };
    assert!(most(&found.account) < 1.5 * most(&without));
    for (account, has) in [(&found.account, true), (&without, false)] {
        let page = day_page(account);
        let before_replay = page.split("<iframe").next().expect("a beginning");
        assert_eq!(before_replay.contains("out of service"), has, "in the picture and the table");
    }
}

#[test]
fn nothing_is_written_as_minus_zero() {
    // On a day without passengers every sum is empty.
    let mut empty = vertifleet_core::Scenario::clone(&day("paper")).into_day();
    for table in &mut empty.demand {
        *table = vertifleet_core::Matrix::from_fn(table.size(), |_, _| 0);
    }
    let empty = Arc::new(empty.check("an empty day").expect("a day"));
    let step = Step::from_minutes(60).expect("a step");
    let found = explain(&empty, "greedy", &greedy(), step, &Stop::default(), &|_| ());
    let found = found.expect("a day");
    for written in [found.to_json(), text(&found), page(&found)] {
        for zero in [": -0.0,", ": -0.0\n", "-0 %", " -0 "] {
            assert!(!written.contains(zero), "{zero}");
        }
    }
}
