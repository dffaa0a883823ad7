//! When aircraft may leave, and how fast their batteries charge (page Model, section Energy).

/// When an aircraft that has landed may decide again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Charging {
    /// When its battery is full (Eq. 14).
    #[default]
    ToFull,
    /// After its turnaround, whatever its charge. A flight takes off once the charge suffices.
    AsNeeded,
}

impl Charging {
    /// Both, with the name that files give them.
    pub(crate) const NAMES: [(&str, Self); 2] =
        [(Self::ToFull.name(), Self::ToFull), (Self::AsNeeded.name(), Self::AsNeeded)];

    /// Its name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ToFull => "to_full",
            Self::AsNeeded => "as_needed",
        }
    }
}

/// The power at which a battery charges, by its state of charge, linear between points.
#[derive(Debug, Clone, PartialEq)]
pub struct ChargeCurve {
    points: Vec<CurvePoint>,
}

/// A point of a [`ChargeCurve`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    /// Share of the battery that is charged, 0 to 1.
    pub charge: f64,
    /// Charging power at this charge, kW.
    pub kw: f64,
}

impl ChargeCurve {
    /// A curve through these points, which [`Day::check`](crate::Day::check) judges.
    pub fn through(points: Vec<CurvePoint>) -> Self {
        Self { points }
    }

    /// The points, in the order of charge from 0 to 1.
    pub fn points(&self) -> &[CurvePoint] {
        &self.points
    }
}
