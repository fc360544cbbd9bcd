//! The commands that talk to an instrument, against one that is made here: it answers as the contract of the link has it,
//! among a flood of everything else that may come over a wire.

mod broken;
mod fake;
mod listening;
mod loading;
mod sending;
mod settings;
mod words;
