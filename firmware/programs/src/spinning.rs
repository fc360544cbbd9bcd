//! Program of the board on a body in fast rotation.

use firmware::not_begun::NotBegun;
use firmware::settings::SpinSchedule;
use orientation::roll::Flight;
use orientation::signal::SpinSample;
use static_cell::StaticCell;

use stm32::link::Link;
use stm32::sample_path::{Channels, acquire_on_spinning_body, find_on_spinning_body};
use stm32::wiring::SpinWires;
use stm32::{once, ports};

use crate::{Executors, Initial, Instrument, Statics, methods};

/// Estimates the roll for as long as the sensors give data, then reports how it ended.
#[embassy_executor::task]
pub async fn follow(executors: Executors, wires: SpinWires, link: Link) {
    static STATICS: Statics<SpinSample, SpinSchedule> = Statics::new();
    let instrument = Instrument::new(&STATICS, &wires.outlets);
    let initial = instrument.until_begin(executors, link).await;
    instrument.tell(initial.and_then(|it| begin(executors, wires, instrument.channels, it)));
}

/// Spawns the tasks of the sample path, of all priorities. Not inlined, so that what is made on the way is in no
/// frame of the program.
///
/// # Errors
/// Why nothing begins.
#[inline(never)]
fn begin(
    executors: Executors,
    wires: SpinWires,
    channels: &'static Channels<SpinSample>,
    (settings, _): Initial<SpinSchedule>,
) -> Result<(), NotBegun> {
    static FLIGHT: StaticCell<Flight> = StaticCell::new();
    let settings = &*settings;
    let SpinWires { converters, .. } = wires;
    let clocks = channels.shared.clocks;
    let configuration = methods::spinning(settings).ok_or(NotBegun::NoScale)?;
    let flight = FLIGHT.init_with(|| methods::flight(settings, clocks));
    let sensors = ports::spinning(converters);
    executors.acquisition.spawn(once(acquire_on_spinning_body(sensors, configuration, channels)));
    // Nothing turns: the angles are valid.
    channels.shared.homed.signal(());
    executors.thread.spawn(once(find_on_spinning_body(flight, channels)));
    Ok(())
}
