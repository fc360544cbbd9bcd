//! Keys of a JSON object, put together one after the other.

use serde::Serialize;
use serde_json::{Map, Value, json};

/// Keys with their values, in their order.
#[must_use]
#[derive(Clone, Debug, Default, Serialize)]
pub struct Keys(Map<String, Value>);

impl Keys {
    /// The keys with one more.
    pub fn with(mut self, key: &str, value: impl Serialize) -> Self {
        self.0.insert(key.to_owned(), json!(value));
        self
    }

    /// The keys with one more where it has a value, and without it where it has none.
    pub fn with_found(self, key: &str, value: Option<impl Serialize>) -> Self {
        match value {
            Some(value) => self.with(key, value),
            None => self,
        }
    }

    /// The keys with those of something that is serialised as an object, where it is there.
    pub fn with_all(mut self, object: Option<&impl Serialize>) -> Self {
        if let Value::Object(keys) = json!(object) {
            self.0.extend(keys);
        }
        self
    }

    /// The number of a key, where it has one.
    pub(crate) fn number(&self, key: &str) -> Option<f64> {
        self.0.get(key)?.as_f64()
    }

    /// Whether there is none.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}
