//! Runs the steps of several parties in every possible order, for tests.

/// The choices that define one order: the party that takes each next step.
#[derive(Debug, Default)]
pub(crate) struct Choices {
    /// Each choice with the number of alternatives.
    made: Vec<(usize, usize)>,
    /// Number of choices taken so far in this order.
    taken: usize,
}

impl Choices {
    /// The next choice, one of `ways`.
    pub(crate) fn of(&mut self, ways: usize) -> usize {
        if self.taken == self.made.len() {
            self.made.push((0, ways));
        }
        self.taken += 1;
        self.made[self.taken - 1].0
    }

    /// The choices of the next order, if there is one.
    fn next(mut self) -> Option<Self> {
        while self.made.pop_if(|(choice, ways)| *choice + 1 == *ways).is_some() {}
        self.made.last_mut()?.0 += 1;
        Some(Self { taken: 0, ..self })
    }
}

/// Plays every order. Returns how many there are.
pub(crate) fn in_every_order(mut play: impl FnMut(&mut Choices)) -> usize {
    let (mut orders, mut next) = (0, Some(Choices::default()));
    while let Some(mut choices) = next {
        play(&mut choices);
        orders += 1;
        next = choices.next();
    }
    orders
}

#[test]
fn two_parties_with_two_steps_each_have_six_orders() {
    let mut seen = std::collections::BTreeSet::new();
    let orders = in_every_order(|choices| {
        let (mut left, mut order) = ([2, 2], String::new());
        while left != [0, 0] {
            let able: Vec<usize> = (0..2).filter(|party| left[*party] > 0).collect();
            let party = able[choices.of(able.len())];
            left[party] -= 1;
            order.push(['a', 'b'][party]);
        }
        seen.insert(order);
    });
    assert_eq!((orders, seen.len()), (6, 6));
}
