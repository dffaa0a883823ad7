//! Index newtypes: positions in a scenario's lists. String ids live only at the edges (files,
//! messages).

macro_rules! index {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub u16);

        impl $name {
            /// The index as a `usize`, for slices.
            #[inline]
            pub fn at(self) -> usize {
                usize::from(self.0)
            }

            /// The index of the entry at `position`.
            ///
            /// # Panics
            /// If `position` exceeds [`u16::MAX`]. The readers refuse lists that long.
            #[inline]
            pub fn new(position: usize) -> Self {
                Self(u16::try_from(position).expect("the readers bound every list below 2^16"))
            }

            /// The indices of a list of `len` entries, in order.
            pub fn all(len: usize) -> impl ExactSizeIterator<Item = Self> + Clone {
                (0..len).map(Self::new)
            }
        }
    };
}

index!(
    /// Index of a vertiport in [`Day::vertiports`](crate::Day::vertiports).
    VertiportIx
);
index!(
    /// Index of an aircraft in [`Day::aircraft`](crate::Day::aircraft).
    AircraftIx
);
index!(
    /// Index of an aircraft type in [`Day::aircraft_types`](crate::Day::aircraft_types).
    TypeIx
);
