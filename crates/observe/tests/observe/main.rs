//! What observations promise.

mod documentation;
mod observation;
