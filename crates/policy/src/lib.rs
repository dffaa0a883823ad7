//! Who decides: the [`Policy`] trait, the rules that need no learning, and how a day is played with one.

mod day_memory;
mod draw;
mod greedy;
mod lookahead;
mod play;
mod policy;
mod priced;
mod prices;
mod random;
mod replay;
mod rollouts;
mod shortlist;
mod stoppable;

pub use day_memory::DayMemory;
pub use draw::draw;
pub use greedy::Greedy;
pub use lookahead::Lookahead;
pub use play::{PlayError, play};
pub use policy::{Policy, PolicyError};
pub use priced::BidPricePolicy;
pub use prices::DayPrices;
pub use random::Random;
pub use replay::Replay;
pub use rollouts::{RolloutEvaluator, RolloutSettings, fleet_worth_usd, noise};
pub use shortlist::Shortlist;
pub use stoppable::Stoppable;
