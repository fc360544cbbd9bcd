//! Progress of the navigator as it is reported, with the sentences of the log.

use crate::alignment::{Azimuth, Refusal};
use crate::attitude::restart::RecallRefusal;
use crate::attitude::{Realigned, State};
use crate::words::Rounded;

/// The gyro that measures the rotation about the body's down axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum VerticalGyro {
    /// The coarse gyro that is read beside the other two.
    Coarse,
    /// The coarse gyro, whose bias was determined by comparison with the precise one.
    Calibrated,
    /// The precise gyro, whose sensitive axis a mount has turned to the vertical.
    Precise,
}

/// Progress of the navigator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Progress {
    /// An azimuth was handed over, with the keeper's decision on it.
    HandedOver(Azimuth, Realigned),
    /// An azimuth is refused, because the vehicle has set off since its alignment.
    Refused(Refusal),
    /// An azimuth is not taken, because increments of later times were taken before it was announced.
    TooLate,
    /// An azimuth or a velocity from outside is not used: it is not finite, its σ is not above zero, or body x is
    /// upright.
    AidingUnusable,
    /// The attitude keeper has changed its state.
    Keeping(State),
    /// No inertial samples arrive any more.
    NoMotion,
    /// The azimuth has become unknown; it must be found or handed over again.
    AzimuthLost,
    /// The estimated bias of a gyro exceeds five times its stated 1σ; the stated values are not
    /// used any more.
    BiasBeyondStated,
    /// The gyro that measures the rotation about the down axis from now on.
    DownGyro(VerticalGyro),
    /// The vehicle has come to rest, and a new alignment begins.
    Realigning,
    /// The heading from before the restart is used again, since the vehicle has not moved.
    HeadingRecalled(Azimuth),
    /// The heading from before the restart is rejected, with the reason.
    RecallRefused(RecallRefusal),
}

crate::words! { Progress:
    Self::HandedOver(Azimuth { angle, sigma }, Realigned::Taken) =>
        "azimuth {}° ± {}° (1σ) handed over: it is kept",
        Rounded::<4>(angle.degrees()), Rounded::<4>(sigma.degrees());
    Self::HandedOver(Azimuth { angle, sigma }, Realigned::Fused { sigmas }) =>
        "realigned: azimuth {}° ± {}° (1σ) agrees with what was kept, by {} σ",
        Rounded::<4>(angle.degrees()), Rounded::<4>(sigma.degrees()), Rounded::<1>(sigmas);
    Self::HandedOver(Azimuth { angle, sigma }, Realigned::Disagrees { sigmas }) =>
        "azimuth {}° ± {}° (1σ) disagrees with what was kept, by {} σ: neither is believed",
        Rounded::<4>(angle.degrees()), Rounded::<4>(sigma.degrees()), Rounded::<1>(sigmas);
    Self::Refused(reason) => "no azimuth: {}", reason;
    Self::TooLate => "the azimuth comes too late to be kept: what was turned meanwhile is not known";
    Self::AidingUnusable =>
        "keeping: an azimuth or a velocity from outside is not used: not finite, no σ above zero, or the body is upright";
    Self::Keeping(state) => "keeping: {}", state;
    Self::NoMotion => "keeping: no motion is measured any more";
    Self::AzimuthLost => "keeping: the azimuth is lost until it is found or handed over again";
    Self::BiasBeyondStated =>
        "keeping: a gyro's bias is beyond five of the 1σ stated for it: nothing stated of the biases is believed";
    Self::DownGyro(VerticalGyro::Coarse) =>
        "keeping: the coarse gyro shows how the base turns about down";
    Self::DownGyro(VerticalGyro::Calibrated) =>
        "keeping: the coarse gyro, as it was compared, shows how the base turns about down";
    Self::DownGyro(VerticalGyro::Precise) =>
        "keeping: the precise gyro shows how the base turns about down";
    Self::Realigning => "the vehicle stands: aligning anew";
    Self::HeadingRecalled(Azimuth { angle, sigma }) =>
        "the vehicle stands as it stood before the restart: azimuth {}° ± {}° (1σ) recalled",
        Rounded::<4>(angle.degrees()), Rounded::<4>(sigma.degrees());
    Self::RecallRefused(reason) => "the heading of before the restart is not believed: {}", reason;
}
