//! State, faults and words.

use orientation::device::Device;
use orientation::roll::Condition;
use orientation::units::Seconds;

use super::fixed::Fixed;
use super::writer::Writer;
use super::{Sentence, plain};
use crate::report::{Report, State};
use crate::words::Words;

/// Bits of `$PHINF`, as Octans and what emulates it set them: heading, roll and pitch are not valid; an alignment runs;
/// gyros 1 to 3 and accelerometers 1 to 3 have failed.
mod bits {
    pub const HEADING: u32 = 1;
    pub const ROLL_AND_PITCH: u32 = 0b110;
    pub const ALIGNMENT: u32 = 1 << 5;
    pub const GYROS: [u32; 3] = [1 << 8, 1 << 9, 1 << 10];
    pub const ACCELEROMETERS: [u32; 3] = [1 << 12, 1 << 13, 1 << 14];
}

/// The devices of each gyro's bit.
const GYROS: [&[Device]; 3] = [
    &[Device::Gyro, Device::ForwardGyro],
    &[Device::RightGyro],
    &[Device::DownGyro, Device::UpGyro],
];
/// The devices of each accelerometer's bit.
const ACCELEROMETERS: [&[Device]; 3] = [
    &[Device::Accelerometer, Device::Base],
    &[Device::RightAccelerometer],
    &[Device::UpAccelerometer],
];

/// The word of status of a report.
fn word(report: &Report) -> u32 {
    let failed = |devices: [&[Device]; 3], bits: [u32; 3]| {
        let failed = devices.iter().zip(bits).filter(|(of, _)| report.failed.contains_any(of));
        failed.fold(0, |word, (_, bit)| word | bit)
    };
    let set = |bits: u32, is_set: bool| if is_set { bits } else { 0 };
    set(bits::HEADING, report.valid_azimuth().is_none())
        | set(bits::ROLL_AND_PITCH, report.usable_level().is_none())
        | set(bits::ALIGNMENT, report.state == State::Aligning)
        | failed(GYROS, bits::GYROS)
        | failed(ACCELEROMETERS, bits::ACCELEROMETERS)
}

/// `$PHINF,00000021*hh`: status in 32 bits, hexadecimal; a bit that is set is bad. 0 heading, 1 roll, 2 pitch not valid;
/// 5 an alignment runs; 8 to 10 a gyro (precise or forward, right, down or up), 12 to 14 an accelerometer (precise or of
/// the base, right, up) has failed.
#[must_use]
pub fn phinf(report: &Report) -> Option<Sentence> {
    Writer::new("PHINF").hexadecimal(word(report)).finish()
}

/// The greatest number of faults, and of seconds since the alignment, that `$PMRDS` states.
const MOST: u32 = 9_999_999;

/// `$PMRDS,degraded,0.039,0.012,0.012,2,61,5,24,coasting*hh`: the state in a word; 1σ of azimuth, pitch and roll, degrees,
/// rounded up; readings that failed since the start; seconds since the end of the alignment; completed and planned dwells
/// or turns of the alignment that runs; why an azimuth is to be used with care. What is unknown is empty. The
/// manufacturer's code is not a registered one.
#[must_use]
pub fn pmrds(report: &Report) -> Option<Sentence> {
    let azimuth = report.usable_azimuth().map(|azimuth| Fixed::<3>::sigma(azimuth.sigma));
    let level = report.usable_level().map(|level| Fixed::<3>::sigma(level.sigma));
    let since = report.since_alignment.map(|Seconds(since)| (since as u32).min(MOST));
    let [done, of] =
        [0, 1].map(|index: usize| report.progress.map(|progress| progress[index].into()));
    let why = match report.state {
        State::Degraded(why) => Some(why),
        _ => None,
    };
    let mut writer = Writer::new("PMRDS");
    writer.display(Some(report.state)).fixed(azimuth).fixed(level).fixed(level);
    writer.whole(Some(report.faults.min(MOST))).whole(since).whole(done).whole(of);
    writer.display(why).finish()
}

/// `$PMRDL,213.702,0.033,locked*hh`: roll of a spinning body, degrees, its 1σ, rounded up, and what it rests on, in words;
/// [`None`] on any other carrier. While the roll is unknown its fields are empty.
#[must_use]
pub fn pmrdl(report: &Report) -> Option<Sentence> {
    let roll = report.spin?;
    let angle = roll.usable_angle().map(|[angle, _]| Fixed::<3>::turn(angle));
    let sigma = roll.usable_angle().map(|[_, sigma]| Fixed::<3>::sigma(sigma));
    Writer::new("PMRDL").fixed(angle).fixed(sigma).words(word_of(roll.condition)).finish()
}

/// What a roll rests on, in words.
const fn word_of(condition: Condition) -> &'static str {
    match condition {
        Condition::Searching => "searching",
        Condition::Locked => "locked",
        Condition::Holding => "holding",
        Condition::NotSpinning => "not spinning",
        Condition::ForceLost => "force lost",
        Condition::RotationLost => "rotation lost",
        Condition::AccelerometerStuck(_) => "accelerometer stuck",
        Condition::GyroStuck => "gyro stuck",
        Condition::Mirrored => "forces mirrored",
        Condition::Elliptic => "forces elliptic",
        Condition::Contradicted => "forces contradict",
    }
}

/// Most characters of words in a sentence: what is left of one beside its frame, its address and its numbers.
pub const WORDS: usize = super::LONGEST - super::FRAME - "HETXT,01,01,00,".len();

/// `$HETXT,02,01,00,words*hh`: words for people, of which this sentence has the part of this number from zero. A comma
/// becomes a semicolon, and what else a sentence may not have a space; [`None`] beyond the last part.
#[must_use]
pub fn txt(words: Words<'_>, number: u8) -> Option<Sentence> {
    let many = words.count(WORDS);
    if number >= many {
        return None;
    }
    let part: heapless::String<WORDS> = words.part::<WORDS>(number).chars().map(plain).collect();
    let [many, number] = [many, number + 1].map(u32::from);
    Writer::new("HETXT").padded(many, 2).padded(number, 2).padded(0, 2).words(&part).finish()
}
