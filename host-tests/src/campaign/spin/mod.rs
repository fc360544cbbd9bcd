//! The roll of a spinning body (Nekrasova 2017): the paper's figures, and what noise, a weak gyro and a lift
//! that fades do to each method.

pub mod cases;
pub mod paper;
pub(super) mod report;
pub mod world;
