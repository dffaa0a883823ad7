//! The mark of an event: its number and the checksum over the log up to it, as `17-9af3c210`. A day
//! that was restored from a copy and continued may have another event of the same number; its mark
//! differs.

use std::fmt;

/// Identifies an event of a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct EventMark {
    /// The number of the event; 0 before the first.
    pub(crate) seq: u64,
    /// The checksum over the log up to it; `None` if only the number is known.
    pub(crate) chain: Option<u32>,
}

impl EventMark {
    /// Reads a mark, or a number alone.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        let (seq, chain) = match text.split_once('-') {
            None => (text, None),
            Some((seq, chain)) if chain.len() == 8 && !chain.starts_with('+') => {
                (seq, Some(u32::from_str_radix(chain, 16).ok()?))
            }
            Some(_) => return None,
        };
        let seq = Some(seq)
            .filter(|digits| !digits.starts_with('+'))?
            .parse()
            .ok()
            .filter(|seq| i64::try_from(*seq).is_ok())?;
        Some(Self { seq, chain })
    }
}

impl fmt::Display for EventMark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { seq, chain } = self;
        match chain {
            None => write!(f, "{seq}"),
            Some(chain) => write!(f, "{seq}-{chain:08x}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::EventMark;

    #[test]
    fn a_mark_is_read_as_it_is_written() {
        for (seq, chain) in [(0, None), (17, None), (17, Some(0x9af3_c210)), (3, Some(7))] {
            let mark = EventMark { seq, chain };
            assert_eq!(EventMark::parse(&mark.to_string()), Some(mark));
        }
        for wrong in [
            "",
            "-",
            "17-",
            "17-9af3c21",
            "17-9af3c2100",
            "-9af3c210",
            "17-x",
            "9223372036854775808",
            "+3",
            "3-+9af3c21",
        ] {
            assert_eq!(EventMark::parse(wrong), None, "{wrong:?}");
        }
    }
}
