//! Copies that reuse room: days are imagined over and over, and memory is taken for the first of them only.

/// Implements `Clone` for a struct of these fields, such that `clone_from` copies field by field into the room there is. A
/// derived one would give that room back and take new.
macro_rules! clone_into_room {
    ($name:ident { $($field:ident),+ $(,)? }) => {
        impl Clone for $name {
            fn clone(&self) -> Self {
                Self { $($field: self.$field.clone()),+ }
            }

            fn clone_from(&mut self, other: &Self) {
                $(self.$field.clone_from(&other.$field);)+
            }
        }
    };
}

pub(crate) use clone_into_room;
