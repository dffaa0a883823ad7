//! Properties of roll-outs.

use vertifleet_policy::{DayPrices, RolloutEvaluator, RolloutSettings, Shortlist};
use vertifleet_sim::Simulation;
use vertifleet_testkit::paper_day;

#[test]
fn roll_outs_on_several_threads_have_the_values_of_roll_outs_on_one() {
    let mut simulation = Simulation::new(paper_day(1));
    let start = simulation.next_decision().expect("a day has decisions");
    let prices = DayPrices::of(simulation.view(), start.time);
    // Enough roll-outs to be worth several threads.
    let settings =
        RolloutSettings { horizon_s: 7_200, rollouts: 300, noise: 0.05, price_weight: 1.0 };
    let mut shortlist = Shortlist::default();
    let mut compared = 0;
    while compared < 3 {
        let decision = simulation.next_decision().expect("a day has decisions");
        let listed = shortlist.rank_with_repositioning(&prices, simulation.view(), &decision);
        if listed.len() > 1 {
            let values_usd = || {
                let mut evaluator = RolloutEvaluator::new(settings.clone());
                evaluator.values_usd(&prices, simulation.view(), &decision, listed).to_vec()
            };
            // A thread of a pool rolls out on its own.
            let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
            assert_eq!(values_usd(), pool.install(values_usd));
            compared += 1;
        }
        let choice = prices.best_choice(simulation.view(), &decision);
        simulation.apply(choice).expect("a choice from the mask");
    }
}
