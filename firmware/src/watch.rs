//! The supervision of the sample stream: a session without samples is ended.

use embassy_time::{Duration, Timer};
use orientation::alignment::refusal::Refusal;

use crate::shared::Shared;

/// Time without samples after which the session is ended: longer than all restarts of a sensor
/// together take.
const SILENCE: Duration = Duration::from_secs(30);

/// Ends the session with [`Refusal::TimeExhausted`] when no samples arrive for 30 s, whatever the
/// reason.
pub async fn watch(shared: &Shared<'_>) {
    loop {
        let before = shared.health.get().samples;
        Timer::after(SILENCE).await;
        if shared.health.get().samples == before {
            shared.fail(Refusal::TimeExhausted);
        }
    }
}
