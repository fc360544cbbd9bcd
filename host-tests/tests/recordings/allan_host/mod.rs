//! Allan variance on the host: estimators against NIST's values, recordings at rest, and the
//! command.

mod command;
mod confidence;
mod estimators;
mod recordings;
