//! Debug probes, and the identities of the chips behind them, by the library `probe-rs`.

use probe_rs::probe::DebugProbeInfo;
use probe_rs::probe::list::Lister;
use probe_rs::{MemoryInterface as _, Permissions};

use super::environment::{Chip, Probe};

/// The chip of the board, by its name in the library.
const CHIP: &str = "STM32L475VGTx";
/// Where a chip has the identity of its kind, and that of its own (RM0351, sections 48.6.1 and 49.1).
const DEVICE: u64 = 0xE004_2000;
const UNIQUE: u64 = 0x1FFF_7590;

/// All probes; those of which the chip can be read are first.
pub(super) fn all() -> Vec<Probe> {
    let found = Lister::new().list_all();
    let named = |info: &DebugProbeInfo| Probe { name: info.identifier.clone(), chip: chip(info) };
    let mut probes: Vec<_> = found.iter().map(named).collect();
    probes.sort_by_key(|probe| probe.chip.is_err());
    probes
}

/// The identity of the chip behind a probe. It is not stopped.
fn chip(info: &DebugProbeInfo) -> Result<Chip, String> {
    let probe = info.open().map_err(|error| error.to_string())?;
    let read = || -> Result<Chip, probe_rs::Error> {
        let mut session = probe.attach(CHIP, Permissions::default())?;
        let mut core = session.core(0)?;
        let mut unique = [0; 3];
        core.read_32(UNIQUE, &mut unique)?;
        Ok(Chip { device: core.read_word_32(DEVICE)?, unique })
    };
    read().map_err(|error| error.to_string())
}
