//! Runs futures in virtual time: when all of them wait, the clock jumps to what they wait for.
//!
//! Every thread has a clock of its own, so runs side by side do not see each other.

use std::cell::RefCell;
use std::pin::{Pin, pin};
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
        CLOCK.with_borrow(|clock| clock.now)
    }

    fn schedule_wake(&self, at: u64, waker: &Waker) {
        CLOCK.with_borrow_mut(|clock| clock.schedule_wake(at, waker));
    }
}

embassy_time_driver::time_driver_impl!(static CLOCK_OF_THREAD: ThreadClock = ThreadClock);

/// Whether a task was woken.
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

/// A future with a flag of its own: it is polled only when it was woken.
struct Task<F> {
    future: F,
    flag: Arc<Flag>,
    waker: Waker,
}

impl<F: Future> Task<Pin<&mut F>> {
    fn new(future: Pin<&mut F>) -> Task<Pin<&mut F>> {
        let flag = Arc::new(Flag(AtomicBool::new(true)));
        Task { future, waker: Waker::from(Arc::clone(&flag)), flag }
    }

    /// Polls the future if it was woken since it last was; whether it was.
    fn poll(&mut self) -> Option<Poll<F::Output>> {
        let was_woken = self.flag.0.swap(false, Ordering::Relaxed);
        was_woken.then(|| self.future.as_mut().poll(&mut Context::from_waker(&self.waker)))
    }
}

/// Runs a future to its end on a clock that begins at zero.
///
/// # Errors
/// [`Deadlock`] where it waits and no time would wake it.
pub fn run<F: Future>(future: F) -> Result<F::Output, Deadlock> {
    run_beside(core::future::pending::<()>(), future)
}

/// Runs a future to its end on a clock that begins at zero, and another beside it, which need not
/// end.
///
/// # Errors
/// [`Deadlock`] where both wait and no time would wake either.
pub fn run_beside<B: Future, F: Future>(beside: B, future: F) -> Result<F::Output, Deadlock> {
    CLOCK.set(VirtualClock::new());
    let (beside, future) = (pin!(beside), pin!(future));
    let mut beside = Some(Task::new(beside));
    let mut main = Task::new(future);
    loop {
        let polled = beside.as_mut().and_then(Task::poll);
        let worked = polled.is_some();
        if polled.is_some_and(|poll| poll.is_ready()) {
            beside = None;
        }
        match main.poll() {
            Some(Poll::Ready(output)) => return Ok(output),
            Some(Poll::Pending) => {}
            None if worked => {}
            None if CLOCK.with_borrow_mut(VirtualClock::advance) => {}
            None => return Err(Deadlock),
        }
    }
}
