//! Runs futures in virtual time: when all of them wait, the clock jumps to what they wait for.
//!
//! Every thread has a clock of its own, so runs side by side do not see each other.

use std::cell::RefCell;
use std::pin::pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll, Wake, Waker};

use embassy_time_driver::Driver;
use hal_mock::clock::VirtualClock;

thread_local! {
    static CLOCK: RefCell<VirtualClock> = const { RefCell::new(VirtualClock::new()) };
}

struct ThreadClock;

impl Driver for ThreadClock {
    fn now(&self) -> u64 {
        CLOCK.with_borrow(VirtualClock::now)
    }

    fn schedule_wake(&self, at: u64, waker: &Waker) {
        CLOCK.with_borrow_mut(|clock| clock.schedule_wake(at, waker));
    }
}

embassy_time_driver::time_driver_impl!(static CLOCK_OF_THREAD: ThreadClock = ThreadClock);

/// Whether somebody was woken.
struct Flag(AtomicBool);

impl Wake for Flag {
    fn wake(self: Arc<Self>) {
        self.wake_by_ref();
    }

    fn wake_by_ref(self: &Arc<Self>) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Every future waits for something that no clock brings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Deadlock;

/// Runs a future to its end on a clock that begins at zero.
///
/// # Errors
/// [`Deadlock`] where it waits and no time would wake it.
pub fn run<F: Future>(future: F) -> Result<F::Output, Deadlock> {
    CLOCK.set(VirtualClock::new());
    let flag = Arc::new(Flag(AtomicBool::new(false)));
    let waker = Waker::from(Arc::clone(&flag));
    let mut context = Context::from_waker(&waker);
    let mut future = pin!(future);
    loop {
        flag.0.store(false, Ordering::Relaxed);
        if let Poll::Ready(output) = future.as_mut().poll(&mut context) {
            return Ok(output);
        }
        while !flag.0.load(Ordering::Relaxed) {
            if !CLOCK.with_borrow_mut(VirtualClock::advance) {
                return Err(Deadlock);
            }
        }
    }
}
