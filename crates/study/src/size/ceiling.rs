//! An upper bound on the value of every design: the minimum of several valid bounds, each of which
//! is tight near one design.
//!
//! The highest value of the least of some sums over a box is a linear programme. Its solver works
//! in floating-point numbers and is not trusted: only the weights that it gives the bounds are
//! used, and the price of room for aircraft. Any weights and any price prove a limit, because a
//! weighted mean of bounds is a bound, and its highest value over a box can be read off.

use microlp::{ComparisonOp, OptimizationDirection, Problem, Solution, Variable};

/// A bound as a function of the design: a constant, and so much for each thing above the lowest
/// number, by dimension.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Cut {
    pub(super) constant: f64,
    pub(super) slopes: Vec<f64>,
}

impl Cut {
    /// The bound with this many things above the lowest numbers.
    pub(super) fn at(&self, above: &[u32]) -> f64 {
        let each = self.slopes.iter().zip(above);
        self.constant + each.map(|(slope, &above)| slope * f64::from(above)).sum::<f64>()
    }
}

/// The rule that every aircraft has a stand: how much room one more thing takes by dimension, and
/// how much there is.
#[derive(Debug, Clone)]
pub(super) struct Headroom {
    pub(super) takes: Vec<f64>,
    pub(super) there_is: f64,
}

/// The least of several cuts over a box of designs, within which aircraft have room.
#[derive(Debug, Clone)]
pub(super) struct Ceiling {
    /// Largest increase over each dimension's minimum.
    most: Vec<f64>,
    room: Headroom,
    cuts: Vec<Cut>,
    /// The size of the numbers, by which the solver's are divided.
    scale: f64,
}

impl Ceiling {
    /// A ceiling without cuts over designs of at most this many things above the lowest numbers.
    pub(super) fn new(most: impl IntoIterator<Item = u32>, room: Headroom) -> Self {
        let most = most.into_iter().map(f64::from).collect();
        Self { most, room, cuts: Vec::new(), scale: 1.0 }
    }

    pub(super) fn add(&mut self, cut: Cut) {
        let largest = cut.slopes.iter().zip(&self.most).map(|(slope, most)| (slope * most).abs());
        self.scale = largest.fold(self.scale.max(cut.constant.abs()), f64::max);
        self.cuts.push(cut);
    }

    /// The least of all bounds of a design.
    pub(super) fn at(&self, above: &[u32]) -> f64 {
        self.cuts.iter().map(|cut| cut.at(above)).fold(f64::INFINITY, f64::min)
    }

    /// By how much one more of a dimension raises the bound that is least at a design.
    pub(super) fn slope(&self, above: &[u32], dimension: usize) -> f64 {
        let least = self.cuts.iter().min_by(|one, other| one.at(above).total_cmp(&other.at(above)));
        least.map_or(0.0, |cut| cut.slopes[dimension])
    }

    /// The ceiling with other slopes: `more` for each thing above its lowest number, and `constant`
    /// for all designs. It is what is expected, and proves nothing.
    pub(super) fn corrected(&self, more: &[f64], constant: f64) -> Self {
        let mut corrected = Self { cuts: Vec::new(), ..self.clone() };
        for cut in &self.cuts {
            let slopes = cut.slopes.iter().zip(more).map(|(slope, more)| slope + more).collect();
            corrected.add(Cut { constant: cut.constant + constant, slopes });
        }
        corrected
    }

    /// The ceiling if a policy earns a share of what each thing brings, before its cost, and if
    /// aircraft have less room. It proves nothing.
    pub(super) fn discounted(&self, share: f64, costs: &[f64], room: Headroom) -> Self {
        let mut discounted = Self { room, cuts: Vec::new(), ..self.clone() };
        for cut in &self.cuts {
            let slopes = cut.slopes.iter().zip(costs);
            let slopes = slopes.map(|(slope, cost)| share * (slope + cost) - cost).collect();
            discounted.add(Cut { constant: share * cut.constant, slopes });
        }
        discounted
    }

    /// A design of the highest value near `center`, not in whole numbers.
    pub(super) fn highest(&self, center: &[u32]) -> Option<Vec<f64>> {
        self.toward(center, self.most() - 1e-6 * self.scale)
    }

    /// What no design passes.
    pub(super) fn most(&self) -> f64 {
        let highest = |weights: &[f64], price: f64| {
            let cut = self.mean(weights);
            let slopes = cut.slopes.iter().zip(&self.room.takes);
            let ends = slopes
                .zip(&self.most)
                .map(|((slope, takes), most)| ((slope - price * takes) * most).max(0.0));
            cut.constant + price * self.room.there_is + ends.sum::<f64>()
        };
        let alone = self.alone().map(|weights| highest(&weights, 0.0));
        let alone = alone.fold(f64::INFINITY, f64::min);
        let together = self.weights_of_most();
        let together = together.map_or(f64::INFINITY, |(weights, price)| highest(&weights, price));
        // Far more than the error of these sums.
        alone.min(together) + 1e-9 * self.scale
    }

    /// What no design costs less than, whose value is at least `need`; `costs` are those of one
    /// thing by dimension. Infinite if there is no such design.
    pub(super) fn least_cost(&self, costs: &[f64], need: f64) -> f64 {
        if self.most() < need {
            return f64::INFINITY;
        }
        // A design costs at least its cost less what it passes the need by and the room that it
        // leaves, at any prices of both.
        let lowest = |prices: &[f64], of_room: f64| {
            let all: f64 = prices.iter().sum();
            let cut = if all > 0.0 { self.mean(prices) } else { self.nothing() };
            let slopes = cut.slopes.iter().zip(&self.room.takes);
            let reduced = costs
                .iter()
                .zip(slopes)
                .map(|(cost, (slope, takes))| cost - all * slope + of_room * takes);
            let ends = reduced.zip(&self.most).map(|(reduced, most)| (reduced * most).min(0.0));
            all * (need - cut.constant) - of_room * self.room.there_is + ends.sum::<f64>()
        };
        let prices = self.prices_of_need(costs, need);
        let found = prices.map_or(0.0, |(prices, of_room)| lowest(&prices, of_room));
        (found - 1e-9 * found.abs()).max(0.0)
    }

    /// The design nearest to `center` whose ceiling is at least `level`, not in whole numbers.
    pub(super) fn toward(&self, center: &[u32], level: f64) -> Option<Vec<f64>> {
        let mut problem = Problem::new(OptimizationDirection::Minimize);
        let add = |problem: &mut Problem, most: f64| problem.add_var(0.0, (0.0, most));
        let above: Vec<Variable> = self.most.iter().map(|&most| add(&mut problem, most)).collect();
        for ((&one, &from), &most) in above.iter().zip(center).zip(&self.most) {
            let far = problem.add_var(1.0 / most.max(1.0), (0.0, f64::INFINITY));
            let from = f64::from(from);
            problem.add_constraint([(far, 1.0), (one, -1.0)], ComparisonOp::Ge, -from);
            problem.add_constraint([(far, 1.0), (one, 1.0)], ComparisonOp::Ge, from);
        }
        self.pass(&mut problem, &above, level);
        values(&solved(&problem)?, &above)
    }

    /// The cheapest design whose ceiling is at least `need`, not in whole numbers.
    pub(super) fn cheapest(&self, costs: &[f64], need: f64) -> Option<Vec<f64>> {
        let mut problem = Problem::new(OptimizationDirection::Minimize);
        let dearest = costs.iter().fold(1e-9_f64, |most, cost| most.max(*cost));
        let add = |(&most, &cost): (&f64, &f64)| problem.add_var(cost / dearest, (0.0, most));
        let above: Vec<Variable> = self.most.iter().zip(costs).map(add).collect();
        self.pass(&mut problem, &above, need);
        values(&solved(&problem)?, &above)
    }

    /// Every cut is at least `level`, and aircraft have room.
    fn pass(&self, problem: &mut Problem, above: &[Variable], level: f64) {
        for cut in &self.cuts {
            let terms =
                above.iter().zip(&cut.slopes).map(|(&one, slope)| (one, slope / self.scale));
            let terms: Vec<(Variable, f64)> = terms.collect();
            problem.add_constraint(terms, ComparisonOp::Ge, (level - cut.constant) / self.scale);
        }
        let takes = above.iter().zip(&self.room.takes).map(|(&one, &takes)| (one, takes));
        problem.add_constraint(takes.collect::<Vec<_>>(), ComparisonOp::Le, self.room.there_is);
    }

    /// The weights of the cuts and the price of room at which the highest value is lowest: the dual
    /// of the highest value.
    fn weights_of_most(&self) -> Option<(Vec<f64>, f64)> {
        let mut problem = Problem::new(OptimizationDirection::Minimize);
        let add = |cut: &Cut| problem.add_var(cut.constant / self.scale, (0.0, 1.0));
        let weights: Vec<Variable> = self.cuts.iter().map(add).collect();
        let price = problem.add_var(self.room.there_is, (0.0, f64::INFINITY));
        let ones: Vec<(Variable, f64)> = weights.iter().map(|&weight| (weight, 1.0)).collect();
        problem.add_constraint(ones, ComparisonOp::Eq, 1.0);
        for (dimension, (&most, &takes)) in self.most.iter().zip(&self.room.takes).enumerate() {
            // The mean's slope less the price, times the most things, where it is above 0.
            let end = problem.add_var(1.0, (0.0, f64::INFINITY));
            let mut terms = vec![(end, 1.0), (price, takes * most)];
            terms.extend(
                weights
                    .iter()
                    .zip(&self.cuts)
                    .map(|(&weight, cut)| (weight, -cut.slopes[dimension] * most / self.scale)),
            );
            problem.add_constraint(terms, ComparisonOp::Ge, 0.0);
        }
        let solution = solved(&problem)?;
        let price = values(&solution, &[price])?[0].max(0.0) * self.scale;
        Some((values(&solution, &weights)?, price))
    }

    /// The prices, one for each cut and one for room, at which the need is dearest: the dual of the
    /// least cost.
    fn prices_of_need(&self, costs: &[f64], need: f64) -> Option<(Vec<f64>, f64)> {
        let dearest: f64 = costs.iter().zip(&self.most).map(|(cost, most)| cost * most).sum();
        if dearest <= 0.0 {
            return None;
        }
        let mut problem = Problem::new(OptimizationDirection::Maximize);
        // A price is for a whole scale of value, and in units of the dearest design.
        let add =
            |cut: &Cut| problem.add_var((need - cut.constant) / self.scale, (0.0, f64::INFINITY));
        let prices: Vec<Variable> = self.cuts.iter().map(add).collect();
        let of_room = problem.add_var(-self.room.there_is, (0.0, f64::INFINITY));
        let dimensions = self.most.iter().zip(costs).zip(&self.room.takes).enumerate();
        for (dimension, ((&most, &cost), &takes)) in dimensions {
            let end = problem.add_var(1.0, (f64::NEG_INFINITY, 0.0));
            let mut terms = vec![(end, 1.0), (of_room, -takes * most)];
            terms.extend(
                prices
                    .iter()
                    .zip(&self.cuts)
                    .map(|(&price, cut)| (price, cut.slopes[dimension] * most / self.scale)),
            );
            problem.add_constraint(terms, ComparisonOp::Le, cost * most / dearest);
        }
        let solution = solved(&problem)?;
        let prices = values(&solution, &prices)?.into_iter();
        let prices = prices.map(|price| price.max(0.0) * dearest / self.scale).collect();
        Some((prices, values(&solution, &[of_room])?[0].max(0.0) * dearest))
    }

    /// The mean of the cuts with these weights, none of which counts below 0.
    fn mean(&self, weights: &[f64]) -> Cut {
        let all: f64 = weights.iter().map(|weight| weight.max(0.0)).sum();
        let mut mean = self.nothing();
        for (cut, weight) in self.cuts.iter().zip(weights) {
            let share = weight.max(0.0) / all;
            mean.constant += share * cut.constant;
            for (sum, slope) in mean.slopes.iter_mut().zip(&cut.slopes) {
                *sum += share * slope;
            }
        }
        mean
    }

    fn nothing(&self) -> Cut {
        Cut { constant: 0.0, slopes: vec![0.0; self.most.len()] }
    }

    /// All weight on one cut, for each cut.
    fn alone(&self) -> impl Iterator<Item = Vec<f64>> {
        let cuts = self.cuts.len();
        (0..cuts).map(move |at| (0..cuts).map(|other| f64::from(u8::from(at == other))).collect())
    }
}

/// The best solution; `None` if there is none, or if the solver does not find it.
fn solved(problem: &Problem) -> Option<Solution> {
    problem.solve().ok()?.into_solution().ok()
}

fn values(solution: &Solution, variables: &[Variable]) -> Option<Vec<f64>> {
    let values: Vec<f64> = variables.iter().map(|&one| solution.var_value(one)).collect();
    values.iter().all(|value| value.is_finite()).then_some(values)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::{Strategy, prop_assert, proptest};

    use super::{Ceiling, Cut, Headroom};

    const MOST: [u32; 3] = [5, 4, 3];
    /// The first dimension is a fleet, the second one has the stands.
    const TAKES: [f64; 3] = [1.0, -1.0, 0.0];

    fn any_ceiling() -> impl Strategy<Value = Ceiling> {
        let cut = (0.0..1e5, proptest::array::uniform3(-3e4..3e4));
        let cuts = proptest::collection::vec(cut, 1..7);
        (cuts, 0.0..6.0).prop_map(|(cuts, there_is)| {
            let mut ceiling = Ceiling::new(MOST, Headroom { takes: TAKES.to_vec(), there_is });
            for (constant, slopes) in cuts {
                ceiling.add(Cut { constant, slopes: slopes.to_vec() });
            }
            ceiling
        })
    }

    fn all_designs(ceiling: &Ceiling) -> impl Iterator<Item = [u32; 3]> {
        let has_room = |design: &[u32; 3]| {
            f64::from(design[0]) - f64::from(design[1]) <= ceiling.room.there_is
        };
        (0..=MOST[0])
            .flat_map(|a| (0..=MOST[1]).flat_map(move |b| (0..=MOST[2]).map(move |c| [a, b, c])))
            .filter(has_room)
    }

    proptest! {
        #[test]
        fn no_design_passes_the_most_and_some_mixture_of_designs_reaches_it(ceiling in any_ceiling()) {
            let most = ceiling.most();
            for design in all_designs(&ceiling) {
                prop_assert!(ceiling.at(&design) <= most);
            }
            // The programme has no gap: a point of the box has a ceiling of just below the most.
            let reached = ceiling.toward(&[0, 0, 0], most - 1e-6 * ceiling.scale);
            prop_assert!(reached.is_some(), "{most}");
        }

        #[test]
        fn no_design_that_serves_the_need_costs_less(
            ceiling in any_ceiling(), need in 0.0..2e5, costs in proptest::array::uniform3(0.0..900.0)
        ) {
            let least = ceiling.least_cost(&costs, need);
            let cost = |above: &[f64]| costs.iter().zip(above).map(|(cost, above)| cost * above).sum::<f64>();
            for design in all_designs(&ceiling).filter(|design| ceiling.at(design) >= need) {
                let cost = cost(&design.map(f64::from));
                prop_assert!(cost >= least, "{design:?} costs {cost}, the least is {least}");
            }
            if let Some(cheapest) = ceiling.cheapest(&costs, need) {
                let cost = cost(&cheapest);
                prop_assert!((cost - least).abs() < 1e-3 * (1.0 + cost), "{cost}, {least}");
            }
        }
    }
}
