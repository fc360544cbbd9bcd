//! Registers of the core, in the order of their numbers.

use unicorn_engine::RegisterARM;

/// Registers that an instruction which faults leaves as they are; the first thirteen are the general ones.
pub(super) const KEPT: [RegisterARM; 17] = [
    RegisterARM::R0,
    RegisterARM::R1,
    RegisterARM::R2,
    RegisterARM::R3,
    RegisterARM::R4,
    RegisterARM::R5,
    RegisterARM::R6,
    RegisterARM::R7,
    RegisterARM::R8,
    RegisterARM::R9,
    RegisterARM::R10,
    RegisterARM::R11,
    RegisterARM::R12,
    RegisterARM::SP,
    RegisterARM::LR,
    RegisterARM::XPSR,
    RegisterARM::PC,
];
