//! What was found, bit by bit, for the host to compare with its own run.
//!
//! One line `dwell` for each dwell and one `outcome`: `name=value` pairs, bits in hexadecimal, all
//! ones for what is absent (no computation gives that pattern). They are printed at every log level.

use defmt::println;
use orientation::align::conclusion::Conclusion;
use orientation::signal::dwell::Dwell;

/// The bits of what is absent.
const ABSENT: u64 = u64::MAX;

/// Logs the dwells and the verdict.
#[inline(never)]
pub fn log(seed: u64, conclusion: &Conclusion, dwells: &[Dwell]) {
    for (number, found) in (1..).zip(dwells) {
        dwell(number, found);
    }
    match &conclusion.verdict {
        Ok(azimuth) => println!(
            "outcome seed={=u64} azimuth={=u64:x} sigma={=u64:x}",
            seed,
            azimuth.angle.to_bits(),
            azimuth.sigma.to_bits()
        ),
        Err(reason) => println!("outcome seed={=u64} reason={}", seed, *reason),
    }
}

fn dwell(number: u32, dwell: &Dwell) {
    let force = dwell.force.map_or([ABSENT; 3], |force| force.map(f64::to_bits));
    println!(
        "dwell number={=u32} stage={=u32:x} middle={=u64:x} seconds={=u64:x} samples={=u32:x} \
         rate={=u64:x} taper={=u64:x} force_x={=u64:x} force_y={=u64:x} \
         force_z={=u64:x} temperature={=u64:x}",
        number,
        dwell.stage.0,
        dwell.middle.to_bits(),
        dwell.seconds.to_bits(),
        dwell.samples,
        dwell.rate.to_bits(),
        dwell.taper.to_bits(),
        force[0],
        force[1],
        force[2],
        dwell.temperature.get().map_or(ABSENT, f64::to_bits)
    );
}
