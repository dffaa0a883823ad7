//! Imagining the rest of a day allocates memory only the first time.

use std::sync::Arc;

use allocation_counter::measure;
use proptest::prelude::{ProptestConfig, any, prop, prop_assert, prop_assert_eq, proptest};
use vertifleet_sim::{Imagined, Simulation};

use vertifleet_testkit::energy_day;

/// Plays an imagined day to its end, with choices made by a fixed rule.
fn play_on(imagined: &mut Imagined) -> f64 {
    while let Some(decision) = imagined.next_decision() {
        let mask = imagined.view().feasible(&decision);
        let choice = mask.nth(decision.index % mask.len()).expect("a rank within the mask");
        imagined.apply(choice).expect("a choice from the mask");
    }
    imagined.ledger().profit_usd()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn a_second_imagined_course_takes_no_memory(
        day in energy_day(), another in energy_day(),
        draws in prop::collection::vec(any::<u32>(), 1..20)
    ) {
        let mut room = None;
        let first = measure(|| room = Some(Simulation::new(another).view().imagined()));
        prop_assert!(first.count_total > 0, "the first imagined day takes memory, or nothing was measured");
        let mut simulation = Simulation::new(Arc::clone(&day));
        // The memory of another day is resized to fit.
        simulation.view().imagined_in(&mut room);
        let mut other = room.clone();
        while let Some(decision) = simulation.next_decision() {
            let fresh_usd = play_on(&mut simulation.view().imagined());
            let (mut first_usd, mut second_usd) = (0.0, 0.0);
            let taken = measure(|| {
                simulation.view().imagined_in(&mut room);
                other.clone_from(&room);
                first_usd = play_on(simulation.view().imagined_in(&mut room));
                second_usd = play_on(other.as_mut().expect("a course"));
            });
            prop_assert_eq!(taken.count_total, 0);
            prop_assert_eq!((first_usd, second_usd), (fresh_usd, fresh_usd));
            let mask = simulation.view().feasible(&decision);
            let rank = draws[decision.index as usize % draws.len()] % mask.len();
            simulation.apply(mask.nth(rank).expect("a rank within the mask")).expect("feasible");
        }
    }
}
