//! Names that are not known but resemble one that is: a slip of the pen, another unit, or none.

use strsim::levenshtein;

/// Most characters by which two names may differ.
const MOST: usize = 2;
/// A name may differ by one character in so many, its first not counted: short ones resemble too much.
const PART: usize = 4;
/// What stands at the end of a name for its unit.
const UNITS: [&str; 19] = [
    "per", "deg", "rad", "arcsec", "h", "h2", "hz", "khz", "sqrt", "s", "ms", "s2", "m", "km", "g",
    "mg", "c", "sigma", "min",
];

/// What a word of a name is also written as.
const ALSO: [(&str, &str); 3] = [("noise", "n"), ("sampling", "sample"), ("sample_rate", "rate")];
/// How the end of a name, without its unit, is called elsewhere, and the known one's.
const ELSEWHERE: [(&str, &str); 9] = [
    ("arw", "gyro_n"),
    ("angle_random_walk", "gyro_n"),
    ("bias_instability", "gyro_b"),
    ("rrw", "gyro_k"),
    ("rate_random_walk", "gyro_k"),
    ("rate_ramp", "gyro_r"),
    ("fs", "rate"),
    ("dt", "rate"),
    ("sample_period", "rate"),
];
/// Fewest characters of a word that stand for the whole.
const SHORT: usize = 3;

/// The known name that this one resembles, the nearest one; none of a known name itself.
pub(super) fn resembled(
    name: &str,
    known: impl Iterator<Item = &'static str> + Clone,
) -> Option<&'static str> {
    if known.clone().any(|other| other == name) {
        return None;
    }
    let far = known.clone().map(str::len).max().unwrap_or(0) + MOST;
    if name.len() > 2 * far {
        return None;
    }
    let lower = name.to_ascii_lowercase();
    let distance = |other: &&'static str| levenshtein(&lower, &other.to_ascii_lowercase());
    let nearest = known.clone().min_by_key(distance)?;
    if distance(&nearest) <= MOST.min((nearest.len() - 1) / PART) {
        return Some(nearest);
    }
    let mut known = known;
    known.find(|other| is_alike(stem(&lower), stem(&other.to_ascii_lowercase())))
}

/// Whether two names without their units say the same: word by word the same, or one cut short.
fn is_alike(one: &str, known: &str) -> bool {
    let plain = ALSO.iter().fold(one.to_owned(), |name, (other, word)| name.replace(other, word));
    let is_cut = |one: &str, other: &str| one.len() >= SHORT && other.starts_with(one);
    let is_other = |(other, name): &(&str, &str)| *name == known && is_end(&plain, other);
    let (words, others) = (plain.split('_'), known.split('_'));
    let is_same = words.clone().count() == others.clone().count()
        && words.zip(others).all(|(a, b)| a == b || is_cut(a, b) || is_cut(b, a));
    is_same || ELSEWHERE.iter().any(is_other)
}

/// Whether a name ends with these words.
fn is_end(name: &str, words: &str) -> bool {
    name.strip_suffix(words).is_some_and(|before| before.is_empty() || before.ends_with('_'))
}

/// A name without its unit.
fn stem(name: &str) -> &str {
    let mut stem = name;
    while let Some((before, last)) = stem.rsplit_once('_') {
        if !UNITS.contains(&last) {
            break;
        }
        stem = before;
    }
    stem
}
