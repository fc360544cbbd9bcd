//! Instruction budgets of `firmware/budget.toml`, as constants.

#![allow(dead_code, reason = "the other limits are the host's to check")]

include!(concat!(env!("OUT_DIR"), "/budget.rs"));
