//! Copies that reuse memory: days are imagined over and over, and only the first of them allocates.

/// Implements `Clone` for a struct with these fields, so that `clone_from` copies field by field
/// into the memory of the old value. A derived `Clone` would free that memory first.
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
