//! Waiting for a typed time: a bare number has no unit.

use core::time::Duration;

use embedded_hal_async::delay::DelayNs;

/// Waits for at least `time`, rounded up to whole microseconds.
pub fn pause(delay: &mut impl DelayNs, time: Duration) -> impl Future<Output = ()> {
    delay.delay_us(microseconds(time))
}

/// Converts a time to whole microseconds, rounded up; saturates at the limit of 32 bits.
fn microseconds(time: Duration) -> u32 {
    let part = u64::from(time.subsec_nanos().div_ceil(1000));
    let whole = time.as_secs().saturating_mul(1_000_000).saturating_add(part);
    u32::try_from(whole).unwrap_or(u32::MAX)
}
