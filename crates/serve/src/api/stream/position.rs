//! The position of a reader in the log of a day, and the events to send next.

use crate::mark::EventMark;
use crate::store::Page;
use crate::taken_event::TakenEvent;

/// The position of a reader that reads the log from the store until it has caught up, and then
/// receives events as they are published. It subscribes before it reads, so every event that is not
/// in the store yet will be published to it.
#[derive(Debug)]
pub(super) struct Position {
    /// The last event that was sent, or the one in the request.
    after: EventMark,
    /// Whether the store may have events that will not be published to the reader.
    is_behind: bool,
}

impl Position {
    /// After an event, regardless of later ones.
    pub(super) fn after(mark: EventMark) -> Self {
        Self { after: mark, is_behind: true }
    }

    /// The last event that was sent.
    pub(super) fn mark(&self) -> EventMark {
        self.after
    }

    /// Whether the store has to be read.
    pub(super) fn is_behind(&self) -> bool {
        self.is_behind
    }

    /// Records that events were published that the reader did not receive.
    pub(super) fn has_missed_events(&mut self) {
        self.is_behind = true;
    }

    /// Adds a page of the store that follows the position; all its events are sent.
    pub(super) fn read(&mut self, page: &Page) {
        self.is_behind = !page.is_last;
        self.after = page.events.last().map_or(self.after, TakenEvent::mark);
    }

    /// Adds an event that was published. Returns whether to send it: it may have been read from the
    /// store already, or follow events that must be read first.
    pub(super) fn take(&mut self, event: &TakenEvent) -> bool {
        let is_next = event.seq == self.after.seq + 1;
        if is_next {
            self.after = event.mark();
        } else if event.seq > self.after.seq {
            self.is_behind = true;
        }
        is_next
    }
}

#[cfg(test)]
mod tests {
    use tokio::sync::broadcast::error::TryRecvError;
    use tokio::sync::broadcast::{Receiver, Sender};

    use super::Position;
    use crate::mark::EventMark;
    use crate::orders::{Choices, in_every_order};
    use crate::store::Page;
    use crate::taken_event::TakenEvent;

    fn event(seq: u64) -> TakenEvent {
        let text = String::new;
        TakenEvent { seq, chain: 0, at_ms: 0, actor: text(), body: text(), notices: text() }
    }

    /// A reader, and the numbers of the events that it has been sent.
    struct Reader {
        fresh: Receiver<TakenEvent>,
        position: Position,
        sent: Vec<u64>,
    }

    impl Reader {
        fn new(publisher: &Sender<TakenEvent>) -> Self {
            let position = Position::after(EventMark { seq: 0, chain: None });
            Self { fresh: publisher.subscribe(), position, sent: Vec::new() }
        }

        /// Reads one event from the store or takes one that was published. Returns false if there
        /// is none.
        fn step(&mut self, store: &[TakenEvent]) -> bool {
            if self.position.is_behind() {
                let mut left = store.iter().filter(|one| one.seq > self.position.mark().seq);
                let events: Vec<_> = left.by_ref().take(1).cloned().collect();
                let page = Page { is_last: events.is_empty(), events };
                self.sent.extend(page.events.iter().map(|event| event.seq));
                self.position.read(&page);
                return true;
            }
            match self.fresh.try_recv() {
                Ok(event) => {
                    if self.position.take(&event) {
                        self.sent.push(event.seq);
                    }
                }
                Err(TryRecvError::Lagged(_)) => self.position.has_missed_events(),
                Err(_) => return false,
            }
            true
        }
    }

    /// Three events are stored, each before it is published. Two may be published in either order,
    /// because a service publishes its own events and those that others have stored. Only `kept` of
    /// them are kept for a reader.
    fn play(kept: usize, choices: &mut Choices) {
        let (publisher, _) = tokio::sync::broadcast::channel(kept);
        let (mut store, mut unpublished) = (Vec::new(), Vec::new());
        let mut reader: Option<Reader> = None;
        let mut steps = 0;
        while store.len() < 3 || !unpublished.is_empty() {
            let may_store = usize::from(store.len() < 3 && unpublished.len() < 2);
            let may_read = usize::from(steps < 6);
            let way = choices.of(may_store + unpublished.len() + may_read);
            if way < unpublished.len() {
                let _ = publisher.send(unpublished.remove(way));
            } else if way < unpublished.len() + may_store {
                let new = event(store.len() as u64 + 1);
                store.push(new.clone());
                unpublished.push(new);
            } else {
                steps += 1;
                reader.get_or_insert_with(|| Reader::new(&publisher)).step(&store);
            }
        }
        let mut reader = reader.unwrap_or_else(|| Reader::new(&publisher));
        while reader.step(&store) {}
        assert_eq!(reader.sent, [1, 2, 3], "each event once and in order: {choices:?}");
    }

    #[test]
    fn in_every_order_of_storing_publishing_and_reading_each_event_is_sent_once() {
        for kept in [1, 2, 4] {
            assert!(in_every_order(|choices| play(kept, choices)) > 1_000);
        }
    }
}
