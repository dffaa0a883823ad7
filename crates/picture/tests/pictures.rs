//! Pictures agree with the trace, at every moment of days of every kind.

use std::sync::Arc;

use vertifleet_core::{DaySeed, Matrix, Network, Scenario, Time, VertiportIx};
use vertifleet_picture::{
    FRAME, Moment, Occupancy, PlayedPicture, Whereabouts, day, frame, ledger_lines, network, png,
    rgb, schedule, text,
};
use vertifleet_sim::{Simulation, TraceRow};

const NETWORKS: [&str; 6] =
    ["paper", "disrupted", "new-york", "as-coded", "random:3", "random-places:2:1"];

/// A day on which every aircraft flies to the next feasible vertiport, with its trace.
fn played(network: &str) -> (Arc<Scenario>, Vec<TraceRow>) {
    let network = Network::find(network).expect("a network");
    let day = Arc::new(network.draw(DaySeed::comparison(1).expect("a seed")));
    let (mut simulation, mut rows) = (Simulation::new(Arc::clone(&day)), Vec::new());
    while let Some(decision) = simulation.next_decision() {
        let feasible = simulation.view().feasible(&decision);
        let size = day.vertiports.len();
        let next = (1..=size).map(|step| VertiportIx::new((decision.at.at() + step) % size));
        let choice = next.into_iter().find(|&at| feasible.contains(at)).expect("hold is feasible");
        rows.push(simulation.apply(choice).expect("it is feasible"));
    }
    (day, rows)
}

#[test]
fn every_aircraft_is_somewhere_and_no_vertiport_is_too_full() {
    for name in NETWORKS {
        let (day, rows) = played(name);
        let end = rows.iter().map(|row| row.ready).max().expect("a day has decisions");
        for time in (day.operations.start.seconds()..=end.seconds()).step_by(431) {
            let moment = Moment::of(&day, &rows, Time::from_seconds(time));
            let there: u32 = moment.standing.iter().chain(&moment.coming).sum();
            assert_eq!(there as usize, day.aircraft.len(), "{name} at {time}");
            for (at, one) in day.vertiports.iter().enumerate() {
                let stands = u32::from(one.stands) + u32::from(one.chargers.unwrap_or(0));
                assert!(moment.standing[at] + moment.coming[at] <= stands, "{name} at {time}");
            }
            for place in moment.aircraft {
                if let Whereabouts::Flying { share, load, .. } = place {
                    assert!((0.0..1.0).contains(&share) && (0.0..=1.0).contains(&load));
                }
            }
        }
        let whole = Moment::of(&day, &rows, end);
        let carried: u64 = rows.iter().map(|row| u64::from(row.passengers)).sum();
        assert_eq!(whole.passengers, carried, "{name}");
    }
}

#[test]
fn all_pictures_can_be_painted_and_none_has_a_number_that_is_none() {
    for name in NETWORKS {
        let (of, rows) = played(name);
        let noon = Moment::of(&of, &rows, Time::from_seconds(12 * 3_600));
        let deciding = Some(VertiportIx::new(1));
        let found = Network::find(name).expect("a network");
        let mut pictures = vec![
            day(&of),
            network(&found.mean_day(), &found.mean_demand()),
            schedule(&of, &rows),
            schedule(&of, &[]),
            frame(&of, &noon, deciding),
        ];
        for picture in PlayedPicture::ALL {
            pictures.extend([picture.draw(&of, &rows), picture.draw(&of, &[])]);
        }
        for svg in pictures {
            assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{name}");
            assert!(png(&svg).starts_with(b"\x89PNG"), "{name}");
        }
        let pixels = rgb(&frame(&of, &noon, None));
        assert_eq!(pixels.len(), (FRAME.0 * FRAME.1 * 3) as usize);
        assert!(pixels.iter().any(|&value| value < 64) && pixels[0] == 255, "dark marks on white");
    }
}

#[test]
fn a_network_is_drawn_from_its_means_and_not_from_rounded_passengers() {
    let day = Network::shipped("paper").expect("shipped").mean_day();
    let size = day.vertiports.len();
    let drawn = |mean: f64| {
        let table = Matrix::from_fn(size, |from, to| if from == to { 0.0 } else { mean });
        network(&day, &vec![table; day.periods.len()])
    };
    let lines = |svg: &str| svg.matches("<line").count();
    let (thin, thick) = (drawn(0.1), drawn(10.0));
    assert_eq!(lines(&thin), lines(&thick), "a line for each pair, however few passengers it has");
    let all = 0.1 * (size * (size - 1) * day.periods.len()) as f64;
    assert!(thin.contains(&format!(", {all:.0} passengers, ")), "{all}");
    let found = Network::shipped("san-francisco").expect("shipped");
    let picture = network(&found.mean_day(), &found.mean_demand());
    assert!(picture.contains(", 3,000 passengers, "), "the mean, as the table has it");
}

#[test]
fn the_occupancy_of_a_vertiport_is_that_of_every_moment() {
    for name in NETWORKS {
        let (day, rows) = played(name);
        for at in VertiportIx::all(day.vertiports.len()) {
            let occupancy = Occupancy::of(&day, &rows, at);
            assert!(occupancy.steps.is_sorted_by(|(one, _), (next, _)| one < next));
            for &(time, taken) in &occupancy.steps {
                let moment = Moment::of(&day, &rows, time);
                assert_eq!(moment.standing[at.at()] + moment.coming[at.at()], taken, "{name}");
                assert!(taken <= occupancy.room, "{name}");
            }
            let (mean, full) = (occupancy.mean_share(), occupancy.full_share());
            assert!((0.0..=1.0).contains(&full) && full <= mean + 1e-9 && mean <= 1.0 + 1e-9);
        }
    }
}

#[test]
fn the_ledger_leads_from_revenue_to_the_profit_of_the_day() {
    for name in NETWORKS {
        let (day, rows) = played(name);
        let lines = ledger_lines(&day, &rows);
        let (&(last, profit_usd), before) = lines.split_last().expect("a ledger has lines");
        assert_eq!((lines[0].0, last), ("revenue", "profit"));
        let left_usd = before.iter().map(|(_, usd)| usd).sum::<f64>();
        let end = rows.iter().map(|row| row.ready).max().expect("a day has decisions");
        let of_moment = Moment::of(&day, &rows, end).profit_usd;
        let about = |usd: f64| (usd - profit_usd).abs() < 1e-6 * lines[0].1.max(1.0);
        assert!(about(left_usd) && about(of_moment), "{name}: {lines:?}");
    }
}

#[test]
fn the_text_of_a_moment_is_a_table_of_the_vertiports() {
    let (day, rows) = played("paper");
    let moment = Moment::of(&day, &rows, Time::from_seconds(9 * 3_600));
    insta::assert_snapshot!(text(&day, &moment, Some(VertiportIx::new(2))));
}
