//! Simulated ADXL355: three-axis accelerometer on the platform (Analog Devices data sheet, rev. C).
