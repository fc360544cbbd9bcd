//! TMC5160: stepper driver with ramp generator of the stage (Trinamic data sheet, rev. 1.14).
