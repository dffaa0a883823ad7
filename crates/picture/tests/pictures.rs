//! Pictures say what a trace says, at every moment of days of every kind.

use std::sync::Arc;

use vertifleet_core::{DaySeed, Network, Scenario, Time, VertiportIx};
use vertifleet_picture::{FRAME, Moment, Whereabouts, day, frame, png, rgb, schedule, text};
use vertifleet_sim::{Simulation, TraceRow};

const NETWORKS: [&str; 6] =
    ["paper", "disrupted", "new-york", "as-coded", "random:3", "random-places:2:1"];

/// A day on which everybody flies to the next feasible vertiport, with its trace.
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
        for svg in [day(&of), schedule(&of, &rows), schedule(&of, &[]), frame(&of, &noon, deciding)]
        {
            assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{name}");
            assert!(png(&svg).starts_with(b"\x89PNG"), "{name}");
        }
        let pixels = rgb(&frame(&of, &noon, None));
        assert_eq!(pixels.len(), (FRAME.0 * FRAME.1 * 3) as usize);
        assert!(pixels.iter().any(|&value| value < 64) && pixels[0] == 255, "dark marks on white");
    }
}

#[test]
fn the_text_of_a_moment_is_a_table_of_the_vertiports() {
    let (day, rows) = played("paper");
    let moment = Moment::of(&day, &rows, Time::from_seconds(9 * 3_600));
    insta::assert_snapshot!(text(&day, &moment, Some(VertiportIx::new(2))));
}
