//! Time driver of the emulated image: virtual time, which stands still while a task runs.

use core::cell::RefCell;
use core::task::Waker;

use critical_section::Mutex;
use embassy_time_driver::Driver;
use hal_mock::clock::VirtualClock;

/// Clock of the image.
struct Clock(Mutex<RefCell<VirtualClock>>);

impl Clock {
    /// Runs work on the clock in a critical section.
    fn with<T>(&self, work: impl FnOnce(&mut VirtualClock) -> T) -> T {
        critical_section::with(|section| work(&mut self.0.borrow_ref_mut(section)))
    }
}

impl Driver for Clock {
    fn now(&self) -> u64 {
        self.with(|clock| clock.now)
    }

    fn schedule_wake(&self, at: u64, waker: &Waker) {
        self.with(|clock| clock.schedule_wake(at, waker));
    }
}

embassy_time_driver::time_driver_impl!(
    static CLOCK: Clock = Clock(Mutex::new(RefCell::new(VirtualClock::new())))
);

/// Microseconds since the start.
pub fn now() -> u64 {
    CLOCK.now()
}

/// Advances to the next moment for which a task waits; `false` where none does.
pub fn advance() -> bool {
    CLOCK.with(VirtualClock::advance)
}
