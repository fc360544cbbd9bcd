//! Simulated MT6835: 21-bit magnetic angle encoder of the stage (MagnTek data sheet).
