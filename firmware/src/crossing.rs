//! What the parts of the instrument share, where they may run at different priorities.
//!
//! On a host and in the emulator one executor polls all parts, and nothing needs a lock. Where a board gives
//! acquisition, mechanism and keeper an executor of higher priority, it chooses the feature `preemptive`: a
//! part that is interrupted then never leaves half a value to another.

use core::cell::Cell;

use embassy_sync::blocking_mutex::Mutex;

#[cfg(not(feature = "preemptive"))]
mod choice {
    /// All parts run in one executor, so no lock is needed.
    pub type Lock = embassy_sync::blocking_mutex::raw::NoopRawMutex;
    /// An observer that all parts call from one executor.
    pub type AnyObserver<'a> = dyn crate::ports::Observer + 'a;
}

#[cfg(feature = "preemptive")]
mod choice {
    /// Parts of a higher priority interrupt others: what is read and written by both is so within a critical section,
    /// for some ten instructions.
    pub type Lock = embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
    /// An observer that parts of different priority call.
    pub type AnyObserver<'a> = dyn crate::ports::Observer + Sync + 'a;
}

pub use choice::{AnyObserver, Lock};

/// A value that all parts read and write as a whole.
#[derive(Debug)]
pub struct Common<T: Copy>(Mutex<Lock, Cell<T>>);

impl<T: Copy> Common<T> {
    /// A value to begin with.
    pub const fn new(value: T) -> Self {
        Self(Mutex::new(Cell::new(value)))
    }

    /// The present value.
    pub fn get(&self) -> T {
        self.0.lock(Cell::get)
    }

    /// Sets the value.
    pub fn set(&self, value: T) {
        self.0.lock(|cell| cell.set(value));
    }

    /// Changes the value, without another part's change between reading and writing.
    pub fn change(&self, change: impl FnOnce(&mut T)) {
        self.0.lock(|cell| {
            let mut value = cell.get();
            change(&mut value);
            cell.set(value);
        });
    }
}

impl<T: Copy + Default> Default for Common<T> {
    fn default() -> Self {
        Self::new(T::default())
    }
}
