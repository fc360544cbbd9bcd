//! The results of a run as bit patterns, which the host compares with those of its own run.
//!
//! A run prints one line `dwell` for each dwell, `turn` for each turn or `stop` for each stop, one
//! line `outcome`, and one line `kept` for each second of keeping. A line is a list of `name=value`
//! pairs. Values are the bits of 64-bit floats in hexadecimal, without any rounding; an absent
//! value has all bits set, a pattern that no computation yields. The lines are printed at every log
//! level.

use defmt::println;
use orientation::alignment::Azimuth;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::rotating::turn::Turn;
use orientation::alignment::stops::stop::Stop;
use orientation::attitude::Report;
use orientation::signal::dwell::Dwell;

/// The bit pattern of an absent value.
const ABSENT: u64 = u64::MAX;

/// Logs the verdict: azimuth and 1σ in rad as bit patterns, or the reason of a refusal.
#[inline(never)]
pub fn outcome(seed: u64, verdict: &Result<Azimuth, Refusal>) {
    match verdict {
        Ok(azimuth) => println!(
            "outcome seed={=u64} azimuth={=u64:x} sigma={=u64:x}",
            seed,
            azimuth.angle.to_bits(),
            azimuth.sigma.to_bits()
        ),
        Err(reason) => println!("outcome seed={=u64} reason={}", seed, *reason),
    }
}

/// Logs a turn of the continuous rotation. The 32-bit values are widened to 64 bits, which is
/// exact, so the host parses one format.
#[inline(never)]
pub fn turn(number: u32, turn: &Turn) {
    let bits = |value: f32| f64::from(value).to_bits();
    let pair = |values: [f32; 2]| values.map(bits);
    let [rate, turning, leak, force] = [turn.rate, turn.turning, turn.leak, turn.force].map(pair);
    println!(
        "turn number={=u32} rate_cos={=u64:x} rate_sin={=u64:x} turning_cos={=u64:x} \
         turning_sin={=u64:x} leak_cos={=u64:x} leak_sin={=u64:x} force_cos={=u64:x} \
         force_sin={=u64:x} mean_force={=u64:x} offset={=u64:x} middle={=u64:x} \
         seconds={=u64:x} speed={=u64:x}",
        number,
        rate[0],
        rate[1],
        turning[0],
        turning[1],
        leak[0],
        leak[1],
        force[0],
        force[1],
        bits(turn.mean_force),
        bits(turn.offset),
        bits(turn.middle),
        bits(turn.seconds),
        bits(turn.speed)
    );
}

/// Logs a stop of the inertial-frame alignment: begin and end, s, the mean rotation vector within
/// the stop, rad, and the mean specific force, as bit patterns.
#[inline(never)]
pub fn stop(number: u32, stop: &Stop) {
    let [turned, force] =
        [stop.turned.mean(), stop.force.mean()].map(|mean| mean.map(f64::to_bits));
    println!(
        "stop number={=u32} from={=u64:x} to={=u64:x} turned_x={=u64:x} turned_y={=u64:x} \
         turned_z={=u64:x} force_x={=u64:x} force_y={=u64:x} force_z={=u64:x}",
        number,
        stop.from.to_bits(),
        stop.to.to_bits(),
        turned[0],
        turned[1],
        turned[2],
        force[0],
        force[1],
        force[2]
    );
}

/// Logs one second of keeping: time, azimuth and 1σ, pitch, roll and the attitude quaternion.
#[inline(never)]
pub fn kept(report: &Report) {
    let azimuth = report
        .azimuth
        .map_or([ABSENT; 2], |azimuth| [azimuth.angle, azimuth.sigma].map(f64::to_bits));
    let attitude = report.attitude.map(f64::to_bits);
    println!(
        "kept time={=u64:x} azimuth={=u64:x} sigma={=u64:x} pitch={=u64:x} roll={=u64:x} \
         w={=u64:x} x={=u64:x} y={=u64:x} z={=u64:x}",
        report.time.0,
        azimuth[0],
        azimuth[1],
        report.pitch.to_bits(),
        report.roll.to_bits(),
        attitude[0],
        attitude[1],
        attitude[2],
        attitude[3]
    );
}

/// Logs a dwell: stage, middle and length of the dwell, samples, mean rate and taper, mean specific
/// force and temperature.
#[inline(never)]
pub fn dwell(number: u32, dwell: &Dwell) {
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
