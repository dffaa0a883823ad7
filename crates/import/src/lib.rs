//! Networks from the data of planners.
