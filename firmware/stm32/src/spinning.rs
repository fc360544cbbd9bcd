//! Program of the board on a body in fast rotation.

use firmware::acquire::{SpinAcquisition, acquire};
use firmware::log::DefmtLog;
use firmware::mechanism::Strapdown;
use firmware::ports::NoRecorder;
use firmware::spin::configuration::SpinConfiguration;
use orientation::roll::Flight;
use orientation::signal::SpinSample;
use static_cell::StaticCell;

use crate::ports::Spinning;
use crate::wiring::{Outlets, SpinWires};
use crate::{Channels, Executors, configuration, find_and_report, ports, settings};

/// Estimates the roll for as long as the sensors give data, then reports how it ended.
#[embassy_executor::task]
pub async fn follow(executors: Executors, wires: SpinWires) {
    static CHANNELS: StaticCell<Channels<SpinSample>> = StaticCell::new();
    static FLIGHT: StaticCell<Flight> = StaticCell::new();
    let SpinWires { converters, outlets: Outlets { link, mut flash } } = wires;
    let Some(settings) = settings::load(&mut flash, settings::spin).await else { return };
    let Some(configuration) = configuration::spinning() else {
        return defmt::error!("board: a sensor's scale factor is none");
    };
    let channels: &'static Channels<_> = CHANNELS.init_with(|| Channels::new(&DefmtLog));
    let flight = FLIGHT.init_with(|| configuration::flight(&settings));
    let sensors = ports::spinning(converters);
    executors.acquisition.spawn(defmt::unwrap!(acquisition(sensors, configuration, channels)));
    Strapdown::new(&channels.shared);
    find_and_report(flight, link, &mut NoRecorder, (), channels).await;
}

/// Acquisition on a spinning body.
#[embassy_executor::task]
async fn acquisition(
    mut sensors: Spinning,
    configuration: SpinConfiguration,
    channels: &'static Channels<SpinSample>,
) {
    acquire(&mut SpinAcquisition::new(&mut sensors, &configuration, channels)).await;
}
