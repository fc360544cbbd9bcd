//! ADS1262: 32-bit converter of the analogue fibre-optic gyro (Texas Instruments SBAS661).
