//! Counter of identical readings, by which a sensor that has stopped is found.

/// Number of identical successive readings that is not chance: the last bits of all sensors are
/// noise.
pub(crate) const STUCK: u32 = 64;

/// Counter of identical successive values.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RepeatCounter<T> {
    /// Latest value.
    last: Option<T>,
    /// Number of repetitions.
    count: u32,
}

impl<T: Copy + PartialEq> RepeatCounter<T> {
    /// Counter before the first value.
    pub(crate) const fn new() -> Self {
        Self { last: None, count: 0 }
    }

    /// Takes a value; returns how often it was repeated before in succession.
    pub(crate) fn push(&mut self, value: T) -> u32 {
        self.count = if self.last.replace(value) == Some(value) { self.count + 1 } else { 0 };
        self.count
    }
}
