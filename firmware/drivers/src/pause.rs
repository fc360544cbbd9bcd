//! Waiting for a typed time: a bare number has no unit.

use core::time::Duration;

use embedded_hal_async::delay::DelayNs;

/// Waits for at least `time`, rounded up to whole microseconds.
pub async fn pause(delay: &mut impl DelayNs, time: Duration) {
    let microseconds = time.as_nanos().div_ceil(1000);
    delay.delay_us(u32::try_from(microseconds).unwrap_or(u32::MAX)).await;
}
