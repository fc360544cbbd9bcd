//! The instrument on a body in fast rotation. There is no alignment: the roll angle is tracked for
//! as long as the body flies.
//!
//! ```text
//!  three gyros ───────┬─▶ acquire ─sample─▶ flight: roll from the extrema, by phase lock ─▶ roll ± σ ─▶ link
//!  two accelerometers ┘                         └─▶ attitude: course and pitch by the gyros
//! ```

pub mod budget;
pub mod configuration;
mod flight;

pub use flight::Flight;

use embassy_futures::select::{Either, select};
use orientation::signal::SpinSample;

use crate::event::Event;
use crate::link::Status;
use crate::ports::Recorder;
use crate::shared::Channels;

/// Tracks a flight until its duration is over or acquisition gives a sensor up, and reports it.
pub(crate) async fn follow<R: Recorder<SpinSample>>(
    flight: &mut Flight,
    recorder: &mut R,
    channels: &Channels<'_, SpinSample>,
) {
    let shared = &channels.shared;
    shared.report(Event::BegunSpin);
    while !flight.is_over() {
        match select(channels.samples.receive(), shared.failure.wait()).await {
            Either::First(sample) => {
                recorder.record(&sample).await;
                flight.push(&sample);
                if let Some(news) = flight.news() {
                    shared.report(news);
                }
                if flight.is_status_due() {
                    shared.status.set(flight.status());
                }
            }
            Either::Second(reason) => {
                shared.report(Event::RollEnded(reason));
                shared.status.set(Status::RollEnded);
                return;
            }
        }
    }
    shared.report(flight.ending());
    shared.status.set(flight.status());
}
