//! Time driver of the emulated image: virtual time, which stands still while a task runs.

use core::cell::{Cell, RefCell};
use core::task::Waker;

use critical_section::Mutex;
use embassy_time_driver::Driver;
use hal_mock::clock::VirtualClock;

use crate::meter::Meter;

/// Clock of the image.
struct Clock {
    /// The virtual time.
    time: Mutex<RefCell<VirtualClock>>,
    /// Where its cost is booked, once it is.
    meter: Mutex<Cell<Option<&'static Meter>>>,
}

impl Clock {
    /// Runs work on the time in a critical section.
    fn with<T>(&self, work: impl FnOnce(&mut VirtualClock) -> T) -> T {
        critical_section::with(|section| work(&mut self.time.borrow_ref_mut(section)))
    }

    /// Runs work on the time on behalf of a task, and books its cost: on the board its own time driver does it, with a
    /// timer.
    fn stand_in<T>(&self, work: impl FnOnce(&mut VirtualClock) -> T) -> T {
        match critical_section::with(|section| self.meter.borrow(section).get()) {
            Some(meter) => meter.stand_in(|| self.with(work)),
            None => self.with(work),
        }
    }
}

impl Driver for Clock {
    fn now(&self) -> u64 {
        self.stand_in(|clock| clock.now)
    }

    fn schedule_wake(&self, at: u64, waker: &Waker) {
        self.stand_in(|clock| clock.schedule_wake(at, waker));
    }
}

embassy_time_driver::time_driver_impl!(static CLOCK: Clock = Clock {
    time: Mutex::new(RefCell::new(VirtualClock::new())),
    meter: Mutex::new(Cell::new(None)),
});

/// Books the cost of the clock with a meter from now on.
pub fn book(meter: &'static Meter) {
    critical_section::with(|section| CLOCK.meter.borrow(section).set(Some(meter)));
}

/// Microseconds since the start.
pub fn now() -> u64 {
    CLOCK.with(|clock| clock.now)
}

/// Advances to the next moment for which a task waits; `false` where none does.
pub fn advance() -> bool {
    CLOCK.with(VirtualClock::advance)
}
