//! What observations promise.

mod complete;
mod documentation;
mod observation;
