//! Waiting for a typed time: a bare number has no unit.

use core::time::Duration;

use embedded_hal_async::delay::DelayNs;

/// Waits for at least `time`, rounded up to whole microseconds.
pub fn pause(delay: &mut impl DelayNs, time: Duration) -> impl Future<Output = ()> {
    delay.delay_us(microseconds(time))
}

/// Converts a time to whole microseconds, rounded up; saturates at the limit of 32 bits.
fn microseconds(time: Duration) -> u32 {
    let whole =
        u32::try_from(time.as_secs()).ok().and_then(|seconds| seconds.checked_mul(1_000_000));
    let part = time.subsec_nanos().div_ceil(1000);
    whole.and_then(|whole| whole.checked_add(part)).unwrap_or(u32::MAX)
}
