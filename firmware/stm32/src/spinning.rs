//! Program of the board on a body in fast rotation.

use firmware::acquire::{SpinAcquisition, acquire};
use firmware::not_begun::NotBegun;
use firmware::ports::NoRecorder;
use firmware::spin::configuration::SpinConfiguration;
use orientation::roll::Flight;
use orientation::signal::SpinSample;
use static_cell::StaticCell;

use crate::ports::Spinning;
use crate::wiring::{Link, Outlets, SpinWires};
use crate::{Channels, Executors, configuration, find_and_report, once, ports, refuse, settings};

/// Estimates the roll for as long as the sensors give data, then reports how it ended.
#[embassy_executor::task]
pub async fn follow(executors: Executors, wires: SpinWires, mut link: Link) {
    let log = wires.outlets.log;
    match begin(executors, wires) {
        Ok((flight, channels)) => {
            let recorder = &mut NoRecorder;
            find_and_report(flight, &mut link, recorder, (), channels).await;
        }
        Err(reason) => refuse(reason, &mut link, log).await,
    }
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
) -> Result<(&'static mut Flight, &'static Channels<SpinSample>), NotBegun> {
    static CHANNELS: StaticCell<Channels<SpinSample>> = StaticCell::new();
    static FLIGHT: StaticCell<Flight> = StaticCell::new();
    let SpinWires { converters, outlets } = wires;
    let settings = settings::load(&outlets, settings::spin)?;
    let Outlets { log, clock, .. } = outlets;
    let clocks = configuration::timebase(clock);
    let configuration = configuration::spinning().ok_or(NotBegun::NoScale)?;
    let channels = CHANNELS.init_with(|| Channels::new(log));
    channels.shared.clocks = clocks;
    let channels: &'static Channels<_> = channels;
    let flight = FLIGHT.init_with(|| configuration::flight(&settings, clocks));
    let sensors = ports::spinning(converters);
    executors.acquisition.spawn(once(acquisition(sensors, configuration, channels)));
    // Nothing turns: the angles are valid.
    channels.shared.homed.signal(());
    Ok((flight, channels))
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
