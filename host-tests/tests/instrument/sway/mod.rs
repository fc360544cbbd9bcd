//! The base's sway: its estimate against closed forms, and the instrument on a base that sways.

mod command;
mod estimator;
mod instrument;
mod whitening;
