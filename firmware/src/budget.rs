//! What the firmware may cost, from `budget.toml`: instructions of a Cortex-M4F, per cent, and bytes.

include!(concat!(env!("OUT_DIR"), "/budget.rs"));
