//! The instructions of a run of code, as their half-words.

/// The instructions of a block (ARMv7-M Architecture Reference Manual, A5.1): distance of each from the beginning,
/// bytes, its first half-word, and the second of a wide one.
pub(super) fn instructions(bytes: &[u8]) -> impl Iterator<Item = (u16, u16, Option<u16>)> {
    let half = |place: usize| {
        let half = bytes.get(place..place + 2)?;
        Some(u16::from_le_bytes([half[0], half[1]]))
    };
    let mut place = 0;
    std::iter::from_fn(move || {
        let first = half(place)?;
        let second = if first >> 11 >= 0b11101 { half(place + 2) } else { None };
        let offset = place as u16;
        place += if second.is_some() { 4 } else { 2 };
        Some((offset, first, second))
    })
}
