//! Program of the board on a body in fast rotation.

use firmware::acquire::{SpinAcquisition, acquire};
use firmware::not_begun::NotBegun;
use firmware::spin::configuration::SpinConfiguration;
use orientation::roll::Flight;
use orientation::signal::SpinSample;
use static_cell::StaticCell;

use crate::ports::Spinning;
use crate::wiring::{Link, SpinWires};
use crate::{Channels, Executors, configuration, connected, go_on, once, ports, settings};

/// Estimates the roll for as long as the sensors give data, then reports how it ended.
#[embassy_executor::task]
pub async fn follow(executors: Executors, wires: SpinWires, link: Link) {
    static CHANNELS: StaticCell<Channels<SpinSample>> = StaticCell::new();
    let channels = connected(&CHANNELS, executors, &wires.outlets, link);
    let flash = wires.outlets.flash;
    go_on(begin(executors, wires, channels), flash, channels).await;
}

/// Spawns what runs above the thread; the rest is for the thread. Not inlined, so that what is made on the way is in no
/// frame of the program.
///
/// # Errors
/// Why nothing begins.
#[inline(never)]
fn begin(
    executors: Executors,
    wires: SpinWires,
    channels: &'static Channels<SpinSample>,
) -> Result<&'static mut Flight, NotBegun> {
    static FLIGHT: StaticCell<Flight> = StaticCell::new();
    let SpinWires { converters, outlets } = wires;
    let settings = settings::load(&outlets, settings::spin)?;
    let clocks = channels.shared.clocks;
    let configuration = configuration::spinning().ok_or(NotBegun::NoScale)?;
    let flight = FLIGHT.init_with(|| configuration::flight(&settings, clocks));
    let sensors = ports::spinning(converters);
    executors.acquisition.spawn(once(acquisition(sensors, configuration, channels)));
    // Nothing turns: the angles are valid.
    channels.shared.homed.signal(());
    Ok(flight)
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
