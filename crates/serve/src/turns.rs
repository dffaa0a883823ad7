//! Turns for computations that take long, and for large bodies. Only a few run at once.
//!
//! The next turn goes to a token that may dispatch before one that may only read, then to the token
//! with the fewest running computations, and among equal ones to the earliest request. No token has
//! all turns, and those that may only read leave one to others. So a token with many requests
//! delays itself and not others.

use std::cmp::Reverse;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tokio::runtime::Handle;
use tokio::sync::oneshot;
use vertifleet_core::Stop;

use crate::access::Actor;
use crate::error::Error;
use crate::tokens::Role;

/// Turns of one kind.
#[derive(Debug, Clone)]
pub(crate) struct Turns(Arc<Mutex<State>>);

/// An object that only one computation uses at a time.
pub(crate) type Key = usize;

#[derive(Debug)]
struct State {
    /// The number of turns.
    all: usize,
    running: Vec<Running>,
    /// In the order of arrival.
    waiting: Vec<Waiting>,
    /// The number of turns that were given so far.
    given: u64,
}

#[derive(Debug)]
struct Running {
    number: u64,
    actor: Actor,
    key: Option<Key>,
}

#[derive(Debug)]
struct Waiting {
    actor: Actor,
    key: Option<Key>,
    turn: oneshot::Sender<Turn>,
}

/// A turn, which ends when this is dropped.
#[derive(Debug)]
pub(crate) struct Turn {
    turns: Turns,
    number: u64,
}

impl Turns {
    /// Turns of which at most `all` run at once; at least three, so that one remains besides those
    /// of a token and of readers.
    pub(crate) fn new(all: usize) -> Self {
        let state = State { all: all.max(3), running: Vec::new(), waiting: Vec::new(), given: 0 };
        Self(Arc::new(Mutex::new(state)))
    }

    /// Whether a request waits for a turn.
    pub(crate) fn are_awaited(&self) -> bool {
        self.state().waiting.iter().any(|waiting| !waiting.turn.is_closed())
    }

    /// Runs work on a blocking thread when it is the token's turn, and no other work with the key
    /// runs. The work is asked to stop when
    /// the caller drops this future, because the client has disconnected or the request has timed
    /// out.
    pub(crate) async fn work<T: Send + 'static>(
        &self,
        actor: &Actor,
        key: Option<Key>,
        work: impl FnOnce(&Stop) -> Result<T, Error> + Send + 'static,
    ) -> Result<T, Error> {
        let turn = self.take(actor, key).await;
        let stop = Stop::default();
        let waits = StopWhenDropped(stop.clone());
        // The turn lasts as long as the work, even after the future is dropped.
        let work = move || {
            let outcome = work(&stop);
            drop(turn);
            outcome
        };
        let died = |error| Error::Internal { cause: format!("{error}") };
        let outcome = tokio::task::spawn_blocking(work).await.map_err(died)?;
        drop(waits);
        outcome
    }

    /// Runs a future that computes for long on a blocking thread when it is the token's turn, so
    /// that other requests continue. It ends when the caller drops this future.
    pub(crate) async fn run<T: Send + 'static>(
        &self,
        actor: &Actor,
        future: impl Future<Output = Result<T, Error>> + Send + 'static,
    ) -> Result<T, Error> {
        let runtime = Handle::current();
        let (waits, gone) = oneshot::channel::<()>();
        let until_gone = async {
            tokio::select! {
                outcome = future => outcome,
                _ = gone => Err(Error::Internal { cause: "the client has gone".to_owned() }),
            }
        };
        let outcome = self.work(actor, None, move |_| runtime.block_on(until_gone)).await;
        drop(waits);
        outcome
    }

    /// Waits for a turn.
    pub(crate) async fn take(&self, actor: &Actor, key: Option<Key>) -> Turn {
        let (turn, wait) = oneshot::channel();
        self.state().waiting.push(Waiting { actor: actor.clone(), key, turn });
        self.give();
        wait.await.expect("a turn is passed on when it ends")
    }

    /// Gives the free turns to those who wait.
    fn give(&self) {
        loop {
            let mut state = self.state();
            let Some(Waiting { actor, key, turn }) = state.next() else { return };
            let number = state.given;
            state.given += 1;
            state.running.push(Running { number, actor, key });
            drop(state);
            // A turn that is not taken is dropped here, and passed on.
            drop(turn.send(Turn { turns: self.clone(), number }));
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    /// Removes the next request that may run, among those whose caller still waits.
    fn next(&mut self) -> Option<Waiting> {
        self.waiting.retain(|waiting| !waiting.turn.is_closed());
        let may_run = |(_, waiting): &(usize, &Waiting)| self.may_run(&waiting.actor, waiting.key);
        let rank = |(_, Waiting { actor, .. }): &(usize, &Waiting)| {
            (Reverse(actor.role > Role::Read), self.running_of(actor))
        };
        let next = self.waiting.iter().enumerate().filter(may_run).min_by_key(rank);
        next.map(|(at, _)| at).map(|at| self.waiting.remove(at))
    }

    fn running_of(&self, actor: &Actor) -> usize {
        self.running.iter().filter(|running| running.actor.name == actor.name).count()
    }

    /// Whether a request may run now.
    fn may_run(&self, actor: &Actor, key: Option<Key>) -> bool {
        let is_free = self.running.len() < self.all;
        if !is_free || key.is_some() && self.running.iter().any(|running| running.key == key) {
            return false;
        }
        // Without tokens, all requests have the same name.
        if actor.name.is_empty() {
            return true;
        }
        let own = self.running_of(actor);
        if actor.role > Role::Read {
            return own < self.all - 1;
        }
        let reads = |running: &&Running| running.actor.role == Role::Read;
        own < self.all - 2 && self.running.iter().filter(reads).count() < self.all - 1
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        self.turns.state().running.retain(|running| running.number != self.number);
        self.turns.give();
    }
}

struct StopWhenDropped(Stop);

impl Drop for StopWhenDropped {
    fn drop(&mut self) {
        self.0.request();
    }
}

#[cfg(test)]
mod tests {
    use std::pin::{Pin, pin};
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::sync::{Arc, mpsc};
    use std::task::{Context, Poll, Wake};
    use std::time::Duration;

    use futures_util::poll;

    use super::{Turn, Turns};
    use crate::access::Actor;
    use crate::orders::{Choices, in_every_order};
    use crate::tokens::Role;

    fn reader(name: &str) -> Actor {
        Actor { name: name.to_owned(), role: Role::Read }
    }

    fn dispatcher(name: &str) -> Actor {
        Actor { name: name.to_owned(), role: Role::Dispatch }
    }

    /// Whether a waiting request was woken.
    #[derive(Default)]
    struct Woken(AtomicBool);

    impl Wake for Woken {
        fn wake(self: Arc<Self>) {
            self.0.store(true, Ordering::Relaxed);
        }
    }

    /// A request for a turn.
    #[derive(Default)]
    enum Request {
        #[default]
        Unasked,
        Waits(Pin<Box<dyn Future<Output = Turn>>>, Arc<Woken>),
        Runs(#[expect(dead_code, reason = "it is only held")] Turn),
        Over,
    }

    impl Request {
        /// The number of possible next steps: ask; take the turn if it was woken, or go away; end.
        fn ways_on(&self) -> usize {
            match self {
                Self::Waits(_, woken) => 1 + usize::from(woken.0.load(Ordering::Relaxed)),
                Self::Unasked | Self::Runs(_) => 1,
                Self::Over => 0,
            }
        }

        fn go_on(&mut self, way: usize, turns: &Turns, actor: &'static str) {
            let (mut future, woken) = match std::mem::take(self) {
                Self::Unasked => {
                    let turns = turns.clone();
                    let take = async move { turns.take(&reader(actor), None).await };
                    (Box::pin(take) as Pin<Box<_>>, Arc::default())
                }
                Self::Waits(future, woken) if way == 1 => (future, woken),
                _ => return *self = Self::Over,
            };
            let waker = Arc::clone(&woken).into();
            *self = match future.as_mut().poll(&mut Context::from_waker(&waker)) {
                Poll::Ready(turn) => Self::Runs(turn),
                Poll::Pending => Self::Waits(future, woken),
            };
        }
    }

    /// Plays one order of the steps of three requests.
    fn play(all: usize, choices: &mut Choices) {
        let turns = Turns::new(all);
        let actors = ["one", "one", "one"];
        let mut requests: [Request; 3] = Default::default();
        loop {
            let ways: Vec<(usize, usize)> = (0..requests.len())
                .flat_map(|at| (0..requests[at].ways_on()).map(move |way| (at, way)))
                .collect();
            if ways.is_empty() {
                break;
            }
            let (at, way) = ways[choices.of(ways.len())];
            requests[at].go_on(way, &turns, actors[at]);
            let state = turns.state();
            let running = state.running.len();
            assert!(running <= state.all, "no turn is given twice: {choices:?}");
            let held = requests.iter().filter(|one| matches!(one, Request::Runs(_))).count();
            assert!(held <= running, "no turn is lost: {choices:?}");
            let open = |waiting: &&super::Waiting| !waiting.turn.is_closed();
            assert!(
                !state.waiting.iter().filter(open).any(|one| state.may_run(&one.actor, None)),
                "no request waits that may run: {choices:?}"
            );
        }
        assert!(turns.state().running.is_empty() && !turns.are_awaited());
    }

    #[test]
    fn in_every_order_of_requests_no_turn_is_lost_or_given_twice() {
        for all in [3, 4] {
            assert!(in_every_order(|choices| play(all, choices)) > 100);
        }
    }

    #[tokio::test]
    async fn the_token_with_fewer_turns_comes_first() {
        let turns = Turns::new(3);
        let take = |actor: Actor| {
            let turns = turns.clone();
            Box::pin(async move { turns.take(&actor, None).await })
        };
        let (first, second) = (take(dispatcher("greedy")).await, take(dispatcher("greedy")).await);
        let third = take(dispatcher("")).await;
        let mut more = take(dispatcher("greedy"));
        let mut other = take(dispatcher("modest"));
        assert!(poll!(&mut more).is_pending() && poll!(&mut other).is_pending());
        drop(first);
        assert!(poll!(&mut more).is_pending(), "it came first, but has a turn already");
        let modest = other.await;
        drop(second);
        let fourth = more.await;
        drop((modest, third, fourth));
        let state = turns.state();
        assert!(state.running.is_empty() && state.waiting.is_empty());
    }

    #[tokio::test]
    async fn a_token_that_may_only_read_leaves_turns_to_others_and_dispatchers_come_first() {
        let turns = Turns::new(3);
        let take = |actor: Actor| {
            let turns = turns.clone();
            Box::pin(async move { turns.take(&actor, None).await })
        };
        let first = take(reader("screen")).await;
        let mut flood: Vec<_> = (0..8).map(|_| take(reader("screen"))).collect();
        for one in &mut flood {
            assert!(poll!(one).is_pending(), "the token has a turn");
        }
        let second = take(reader("analyst")).await;
        let mut third = take(reader("auditor"));
        assert!(poll!(&mut third).is_pending(), "readers leave a turn to dispatchers");
        let anna = take(dispatcher("anna")).await;
        let mut ben = take(dispatcher("ben"));
        assert!(poll!(&mut ben).is_pending(), "all turns are taken");
        drop(first);
        let ben = ben.await;
        drop((anna, ben, second));
        let third = third.await;
        drop(third);
        for one in flood {
            drop(one.await);
        }
        assert!(turns.state().running.is_empty());
    }

    #[tokio::test]
    async fn work_with_the_same_key_does_not_run_together_and_leaves_its_turn_to_others() {
        let turns = Turns::new(3);
        let anna = dispatcher("anna");
        let first = turns.take(&anna, Some(7)).await;
        let mut same = pin!(turns.take(&anna, Some(7)));
        assert!(poll!(&mut same).is_pending());
        let other = turns.take(&anna, Some(8)).await;
        drop(other);
        assert!(poll!(&mut same).is_pending());
        drop(first);
        drop(same.await);
        assert!(turns.state().running.is_empty());
    }

    #[tokio::test]
    async fn a_request_that_goes_away_gives_the_turn_up_and_the_work_stops() {
        let turns = Turns::new(3);
        let one = reader("one");
        let (begun, has_begun) = mpsc::channel();
        let (ended, has_ended) = mpsc::channel();
        let work = turns.work(&one, None, move |stop| {
            begun.send(()).expect("the test waits");
            while !stop.is_requested() {
                std::thread::sleep(Duration::from_millis(1));
            }
            ended.send(()).expect("the test waits");
            Ok(())
        });
        {
            let mut work = pin!(work);
            assert!(poll!(&mut work).is_pending());
            has_begun.recv().expect("it begins");
            let mut gone = pin!(turns.take(&one, None));
            assert!(poll!(&mut gone).is_pending());
        }
        has_ended.recv().expect("it is asked to stop");
        let turn = turns.take(&one, None).await;
        drop(turn);
        assert!(turns.state().running.is_empty());
    }
}
