//! One chip on a bus of its own in virtual time.

use std::cell::RefCell;

use hal_mock::chip::{Single, SpiChip};
use hal_mock::violation::Misuse;
use host::virtual_time;

/// Runs what must end.
#[track_caller]
pub fn run<F: Future>(future: F) -> F::Output {
    virtual_time::run(future).expect("nothing here waits for ever")
}

/// The rules of the chip that were broken.
pub fn violations<C: SpiChip<E>, E>(rig: &RefCell<Single<C, E>>) -> Vec<Misuse> {
    let rig = rig.borrow();
    rig.chip.violations().first.iter().map(|violation| violation.misuse).collect()
}
