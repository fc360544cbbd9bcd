//! Program of the board on a body in fast rotation.

use embassy_executor::Spawner;
use firmware::acquire::{SpinAcquisition, acquire};
use firmware::keep::NotKept;
use firmware::log::DefmtLog;
use firmware::mechanism::Strapdown;
use firmware::ports::NoRecorder;
use firmware::run::navigate;
use firmware::spin::configuration::SpinConfiguration;
use orientation::roll::Flight;
use orientation::signal::SpinSample;
use static_cell::StaticCell;

use crate::ports::Spinning;
use crate::wiring::{Outlets, SpinWires};
use crate::{Channels, configuration, ports, report_conclusion, settings};

/// Estimates the roll for as long as the sensors give data, then reports how it ended.
#[embassy_executor::task]
pub async fn follow(spawner: Spawner, wires: SpinWires) {
    static CHANNELS: StaticCell<Channels<SpinSample>> = StaticCell::new();
    static FLIGHT: StaticCell<Flight> = StaticCell::new();
    let SpinWires { converters, outlets: Outlets { mut link, mut flash } } = wires;
    let Some(settings) = settings::load(&mut flash, settings::spin) else { return };
    let Some(sensors) = configuration::spinning() else {
        return defmt::error!("board: a sensor's scale factor is none");
    };
    let channels: &'static Channels<_> = CHANNELS.init_with(|| Channels::new(&DefmtLog));
    let flight = FLIGHT.init_with(|| configuration::flight(&settings));
    spawner.spawn(defmt::unwrap!(acquisition(ports::spinning(converters), sensors, channels)));
    let mut body = Strapdown::new(&channels.shared);
    let outside = (&mut link, &mut NoRecorder);
    let health = navigate(&mut body, flight, NotKept, &(), outside, channels).await;
    report_conclusion(&health, &mut link, &channels.shared).await;
}

/// Task that acquires samples for ever.
#[embassy_executor::task]
async fn acquisition(
    mut sensors: Spinning,
    configuration: SpinConfiguration,
    channels: &'static Channels<SpinSample>,
) {
    acquire(&mut SpinAcquisition::new(&mut sensors, &configuration, channels)).await;
}
