//! State, faults and words.

use core::fmt::Display;

use orientation::device::Device;
use orientation::units::Seconds;

use super::fixed::{Field, Fixed};
use super::{Sentence, sentence};
use crate::report::{Report, State};

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
    sentence(format_args!("PHINF,{:08X}", word(report)))
}

/// The greatest number of faults, and of seconds since the alignment, that `$PMRDS` states.
const MOST: u32 = 9_999_999;

/// `$PMRDS,degraded,0.039,0.012,0.012,2,61,5,24*hh`: the state in a word; 1σ of azimuth, pitch and roll, degrees, rounded
/// up; readings that failed since the start; seconds since the end of the alignment; completed and planned dwells, turns
/// or stops of the alignment that runs. What is unknown is empty. The manufacturer's code is not a registered one.
#[must_use]
pub fn pmrds(report: &Report) -> Option<Sentence> {
    let azimuth = Field(report.usable_azimuth().map(|azimuth| Fixed::<3>::sigma(azimuth.sigma)));
    let level = Field(report.usable_level().map(|level| Fixed::<3>::sigma(level.sigma)));
    let faults = report.faults.min(MOST);
    let since = Field(report.since_alignment.map(|Seconds(since)| (since as u32).min(MOST)));
    let [done, of] = [0, 1].map(|index| Field(report.progress.map(|progress| progress[index])));
    let state = report.state;
    sentence(format_args!("PMRDS,{state},{azimuth},{level},{level},{faults},{since},{done},{of}"))
}

/// Most characters of words in a sentence: what is left of one beside its frame, its address and its numbers.
const WORDS: usize = super::LONGEST - super::FRAME - "HETXT,01,01,00,".len();

/// `$HETXT,01,01,00,words*hh`: words for people. Characters that a sentence may not have become spaces, and words that are
/// too long are cut.
#[must_use]
pub fn txt(words: impl Display) -> Option<Sentence> {
    let mut text = Cut { text: heapless::String::new() };
    // It never fails, as it cuts.
    let _ = core::fmt::write(&mut text, format_args!("{words}"));
    sentence(format_args!("HETXT,01,01,00,{}", text.text))
}

/// Words that are cut at their greatest length.
struct Cut {
    text: heapless::String<WORDS>,
}

impl core::fmt::Write for Cut {
    fn write_str(&mut self, words: &str) -> core::fmt::Result {
        let allowed = |letter: char| {
            let is_plain = matches!(letter, ' '..='}') && !"$!*,\\^".contains(letter);
            if is_plain { letter } else { ' ' }
        };
        let _ = words.chars().map(allowed).try_for_each(|letter| self.text.push(letter));
        Ok(())
    }
}
