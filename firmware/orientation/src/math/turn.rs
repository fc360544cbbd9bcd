//! Sine and cosine in integers: a software `f64` sine takes five thousand instructions on a
//! Cortex-M4.

/// Taylor coefficients 1/(2k)! from k = 8 down to 1, times 2⁶²: up to half a right angle the next
/// term is below 2⁻⁶².
const COSINE: [i64; 8] = reciprocals(false);
/// Taylor coefficients 1/(2k + 1)! from k = 8 down to 1, times 2⁶².
const SINE: [i64; 8] = reciprocals(true);
/// Ratio π/4 times 2⁶³, rounded: an eighth of a turn in radians.
const EIGHTH: u64 = 0x6487_ED51_10B4_611A;

/// Coefficients 2⁶²/(2k + odd)! for k = 8 down to 1, rounded.
const fn reciprocals(odd: bool) -> [i64; 8] {
    let mut values = [0; 8];
    let mut place = 8;
    let (mut k, mut factorial) = (1, 1);
    while place > 0 {
        factorial *= if odd { 2 * k * (2 * k + 1) } else { (2 * k - 1) * 2 * k };
        place -= 1;
        values[place] = ((1 << 62) + factorial / 2) / factorial;
        k += 1;
    }
    values
}

/// Upper half of a 128-bit product, rounded down.
pub(crate) fn high(a: i64, b: i64) -> i64 {
    ((i128::from(a) * i128::from(b)) >> 64) as i64
}

/// Sine and cosine, times 2⁶², of an angle in units of 2⁻⁶⁴ turn; error at most 32 LSB (7e-18).
#[must_use]
pub fn sine_and_cosine(angle: u64) -> (i64, i64) {
    // Nearest quarter turn, and the remainder of at most ±1/8 turn.
    let quarter = angle.wrapping_add(1 << 61) >> 62;
    let left = angle.wrapping_sub(quarter << 62).cast_signed();
    // A remainder of ±2⁶¹ becomes ±π/4 · 2⁶¹: radians times 2⁶¹.
    let radians = high(left, EIGHTH.cast_signed()) << 1;
    let square = high(radians, radians) << 4; // x² · 2⁶²
    let (sine, cosine) = (series(square, &SINE), series(square, &COSINE));
    let sine = high(radians, sine) << 3;
    match quarter & 3 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// Alternating series 1 − x²(c₁ − x²(c₂ − …)), times 2⁶².
fn series(square: i64, coefficients: &[i64; 8]) -> i64 {
    let mut value = 0;
    for coefficient in coefficients {
        value = coefficient - (high(square, value) << 2);
    }
    (1 << 62) - (high(square, value) << 2)
}
