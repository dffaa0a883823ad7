//! What a design of a network is to achieve.

use crate::error::Error;

/// What the best design is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// The design that earns most after the costs of its aircraft, stands and chargers.
    MostProfit,
    /// The cheapest design in which at least this share of those who want to fly are carried.
    Served(f64),
    /// The design in which most of those who want to fly are carried.
    LeastSpill,
}

impl Goal {
    /// Reads `profit`, `served=SHARE`, `zero-spill`, which is `served=1`, or `least-spill`.
    ///
    /// # Errors
    /// Returns [`Error::Asked`] for anything else, and for a share that is not above 0 and at
    /// most 1.
    pub fn parse(text: &str) -> Result<Self, Error> {
        match text {
            "profit" => Ok(Self::MostProfit),
            "zero-spill" => Ok(Self::Served(1.0)),
            "least-spill" => Ok(Self::LeastSpill),
            _ => {
                let share = text.strip_prefix("served=").and_then(|share| share.parse().ok());
                let is_share = |share: &f64| *share > 0.0 && *share <= 1.0;
                share.filter(is_share).map(Self::Served).ok_or_else(|| Error::Asked {
                    rule: match share.map(|share| share / 100.0).filter(is_share) {
                        Some(share) => format!("{text:?} is no goal, a share is at most 1: did you mean served={share}?"),
                        None => format!("{text:?} is no goal"),
                    },
                    hint: "a goal is profit, served=0.95 or another share up to 1, zero-spill, or least-spill",
                })
            }
        }
    }

    /// The goal as it is typed.
    pub fn name(self) -> String {
        match self {
            Self::MostProfit => "profit".to_owned(),
            Self::Served(1.0) => "zero-spill".to_owned(),
            Self::Served(share) => format!("served={share}"),
            Self::LeastSpill => "least-spill".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Goal;

    #[test]
    fn goals_are_read_as_they_are_named() {
        for text in ["profit", "served=0.95", "zero-spill", "least-spill"] {
            assert_eq!(Goal::parse(text).expect(text).name(), text);
        }
        assert_eq!(Goal::parse("served=1").expect("a goal"), Goal::Served(1.0));
        for text in ["", "profits", "served", "served=", "served=0", "served=1.01", "served=NaN"] {
            assert!(Goal::parse(text).is_err(), "{text}");
        }
        let percent = Goal::parse("served=80").expect_err("no share").to_string();
        assert!(percent.contains("served=0.8?"), "{percent}");
    }
}
