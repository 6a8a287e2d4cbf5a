//! How a field behind an [`Arc`] stands in a file, for `#[serde(with = ...)]`.
//!
//! In: a shared value. Out: the same bytes as of the value itself. Two fields that share a value in
//! memory are written twice and share nothing after they are read.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::sync::Arc;

pub fn serialize<T: Serialize, S: Serializer>(
    value: &Arc<T>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    value.as_ref().serialize(serializer)
}

pub fn deserialize<'de, T: Deserialize<'de>, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Arc<T>, D::Error> {
    T::deserialize(deserializer).map(Arc::new)
}
