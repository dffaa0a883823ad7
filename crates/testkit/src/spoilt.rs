//! Corrupts valid texts: cuts, changes or repeats a part, the same in every run.

use std::hash::{BuildHasher as _, BuildHasherDefault, DefaultHasher};

/// The separators of JSON and of queries.
const MARKS: &[u8] = b"{}[]\",:&=%0-9e";
/// Numbers that readers often handle wrongly.
const NUMBERS: [&str; 12] = [
    "0",
    "-1",
    "-0",
    "0.5",
    "1e999",
    "255",
    "65536",
    "359999",
    "360000",
    "4294967296",
    "18446744073709551615",
    "99999999999999999999",
];

/// A number that looks random and is the same in every run.
pub fn draw(seed: u32, at: u32) -> usize {
    let hash = BuildHasherDefault::<DefaultHasher>::default().hash_one((seed, at));
    usize::try_from(hash >> 33).expect("31 bits")
}

/// A text that is cut, changed or repeated in one to three places, drawn from a number. It is never
/// empty.
pub fn spoilt(good: &[u8], seed: u32) -> Vec<u8> {
    let mut text = good.to_vec();
    for change in 0..=u32::try_from(draw(seed, 0) % 3).expect("few") {
        let drawn = |number: u32| draw(seed, 10 * (change + 1) + number);
        if text.is_empty() {
            text.push(b'?');
        }
        let at = drawn(0) % text.len();
        match drawn(1) % 7 {
            0 => text[at] = u8::try_from(drawn(2) % 256).expect("a byte"),
            1 => {
                text.remove(at);
            }
            2 => text.insert(at, MARKS[drawn(2) % MARKS.len()]),
            3 => text.truncate(at.max(1)),
            4 => {
                let until = text.len().min(at + 1 + drawn(2) % 40);
                let part = text[at..until].to_vec();
                text.splice(at..at, part);
            }
            _ => number(&mut text, at, NUMBERS[drawn(2) % NUMBERS.len()]),
        }
    }
    if text.is_empty() {
        text.push(b'?');
    }
    text
}

/// Puts another number in the place of the first one after a position, if there is one.
fn number(text: &mut Vec<u8>, after: usize, other: &str) {
    let Some(begin) = (after..text.len()).find(|&at| text[at].is_ascii_digit()) else { return };
    let end = (begin..text.len()).find(|&at| !text[at].is_ascii_digit()).unwrap_or(text.len());
    text.splice(begin..end, other.bytes());
}
