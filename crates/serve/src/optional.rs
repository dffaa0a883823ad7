//! Optional members of requests: null is the same as leaving the member out.

use serde::{Deserialize, Deserializer};

/// Reads an optional member whose absence means its default.
pub(crate) fn or_default<'de, D, T>(from: D) -> Result<T, D::Error>
where
    D: Deserializer<'de>,
    T: Default + Deserialize<'de>,
{
    Ok(Option::<T>::deserialize(from)?.unwrap_or_default())
}
