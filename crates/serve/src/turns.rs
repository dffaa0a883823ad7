//! Turns for computations that take long. Only a few run at once. The next turn goes to the token
//! with the fewest running computations, and among equal ones to the earliest request. So a token
//! with many requests delays itself and not others.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tokio::runtime::Handle;
use tokio::sync::oneshot;
use vertifleet_core::Stop;

use crate::error::Error;

/// Turns of one kind.
#[derive(Debug, Clone)]
pub(crate) struct Turns(Arc<Mutex<State>>);

#[derive(Debug)]
struct State {
    /// Free turns.
    free: usize,
    /// The number of turns that each token has.
    running: HashMap<String, usize>,
    /// In the order of arrival.
    waiting: Vec<Waiting>,
}

#[derive(Debug)]
struct Waiting {
    actor: String,
    turn: oneshot::Sender<Turn>,
}

/// A turn, which ends when this is dropped.
#[derive(Debug)]
struct Turn {
    turns: Turns,
    actor: String,
}

impl Turns {
    /// Turns of which at most `turns` run at once.
    pub(crate) fn new(turns: usize) -> Self {
        let state = State { free: turns, running: HashMap::new(), waiting: Vec::new() };
        Self(Arc::new(Mutex::new(state)))
    }

    /// Whether a request waits for a turn.
    pub(crate) fn are_awaited(&self) -> bool {
        self.state().waiting.iter().any(|waiting| !waiting.turn.is_closed())
    }

    /// Runs work on a blocking thread when it is the token's turn. The work is asked to stop when
    /// the caller drops this future, because the client has disconnected or the request has timed
    /// out.
    pub(crate) async fn work<T: Send + 'static>(
        &self,
        actor: &str,
        work: impl FnOnce(&Stop) -> Result<T, Error> + Send + 'static,
    ) -> Result<T, Error> {
        let turn = self.take(actor).await;
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
        actor: &str,
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
        let outcome = self.work(actor, move |_| runtime.block_on(until_gone)).await;
        drop(waits);
        outcome
    }

    /// Waits for a turn.
    async fn take(&self, actor: &str) -> Turn {
        let wait = {
            let mut state = self.state();
            if state.free > 0 {
                state.free -= 1;
                return self.turn(&mut state, actor);
            }
            let (turn, wait) = oneshot::channel();
            state.waiting.push(Waiting { actor: actor.to_owned(), turn });
            wait
        };
        wait.await.expect("a turn is passed on when it ends")
    }

    fn turn(&self, state: &mut State, actor: &str) -> Turn {
        *state.running.entry(actor.to_owned()).or_default() += 1;
        Turn { turns: self.clone(), actor: actor.to_owned() }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    /// Removes the next request, among those whose caller still waits.
    fn next(&mut self) -> Option<Waiting> {
        self.waiting.retain(|waiting| !waiting.turn.is_closed());
        let running = |waiting: &Waiting| self.running.get(&waiting.actor).copied();
        let next = self.waiting.iter().enumerate().min_by_key(|(_, waiting)| running(waiting));
        next.map(|(at, _)| at).map(|at| self.waiting.remove(at))
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        let mut state = self.turns.state();
        if let Some(running) = state.running.get_mut(&self.actor) {
            *running -= 1;
            if *running == 0 {
                state.running.remove(&self.actor);
            }
        }
        let Some(next) = state.next() else {
            state.free += 1;
            return;
        };
        let turn = self.turns.turn(&mut state, &next.actor);
        drop(state);
        // A turn that is not taken is dropped here, and passed on.
        drop(next.turn.send(turn));
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
    use crate::orders::{Choices, in_every_order};

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
                    let take = async move { turns.take(actor).await };
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
    fn play(free: usize, choices: &mut Choices) {
        let turns = Turns::new(free);
        let actors = ["one", "one", "two"];
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
            let running: usize = state.running.values().sum();
            assert_eq!(state.free + running, free, "no turn is lost or given twice: {choices:?}");
            let is_awaited = state.waiting.iter().any(|waiting| !waiting.turn.is_closed());
            assert!(
                state.free == 0 || !is_awaited,
                "no request waits while a turn is free: {choices:?}"
            );
        }
        assert!(turns.state().running.is_empty() && !turns.are_awaited());
    }

    #[test]
    fn in_every_order_of_requests_no_turn_is_lost_or_given_twice() {
        for free in [1, 2] {
            assert!(in_every_order(|choices| play(free, choices)) > 100);
        }
    }

    #[tokio::test]
    async fn the_token_with_fewer_turns_comes_first() {
        let turns = Turns::new(2);
        let (first, second) = (turns.take("greedy").await, turns.take("greedy").await);
        let mut more = pin!(turns.take("greedy"));
        let mut other = pin!(turns.take("modest"));
        assert!(poll!(&mut more).is_pending() && poll!(&mut other).is_pending());
        drop(first);
        assert!(poll!(&mut more).is_pending(), "it came first, but has a turn already");
        let modest = other.await;
        drop(second);
        let third = more.await;
        drop((modest, third));
        let state = turns.state();
        assert!(state.free == 2 && state.running.is_empty() && state.waiting.is_empty());
    }

    #[tokio::test]
    async fn a_request_that_goes_away_gives_the_turn_up_and_the_work_stops() {
        let turns = Turns::new(1);
        let (begun, has_begun) = mpsc::channel();
        let (ended, has_ended) = mpsc::channel();
        let work = turns.work("one", move |stop| {
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
            let mut gone = pin!(turns.take("two"));
            assert!(poll!(&mut gone).is_pending());
        }
        has_ended.recv().expect("it is asked to stop");
        let turn = turns.take("three").await;
        drop(turn);
        assert_eq!(turns.state().free, 1);
    }
}
