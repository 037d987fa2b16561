//! Methods and traits that types with read-only fields have in common.

/// Methods that return the field of their name: by value after `copy`, by reference after `ref`.
macro_rules! getters {
    () => {};
    ($(#[$doc:meta])* copy $name:ident: $type:ty; $($others:tt)*) => {
        $(#[$doc])*
        #[inline]
        pub fn $name(&self) -> $type {
            self.$name
        }
        $crate::fields::getters! { $($others)* }
    };
    ($(#[$doc:meta])* ref $name:ident: $type:ty; $($others:tt)*) => {
        $(#[$doc])*
        #[inline]
        pub fn $name(&self) -> &$type {
            &self.$name
        }
        $crate::fields::getters! { $($others)* }
    };
}

/// `Debug` of a type from some of its getters.
macro_rules! debug {
    ($name:ident<$($argument:tt),*> where [$($generics:tt)*]: $($field:ident),*) => {
        impl<$($generics)*> core::fmt::Debug for $name<$($argument),*> {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                let mut shown = f.debug_struct(stringify!($name));
                $(shown.field(stringify!($field), &self.$field());)*
                shown.finish_non_exhaustive()
            }
        }
    };
}

/// `Debug` of a type from all of these fields. A derived one would ask for methods that are `Debug`.
macro_rules! debug_fields {
    ($name:ident<$($argument:tt),*> where [$($generics:tt)*]: $($field:tt),*) => {
        impl<$($generics)*> core::fmt::Debug for $name<$($argument),*> {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                let mut shown = f.debug_struct(stringify!($name));
                $(shown.field(stringify!($field), &self.$field);)*
                shown.finish()
            }
        }
    };
}

/// `Copy` and `Clone` of a type whose fields are. Derived ones would ask the same of its parameters.
macro_rules! copy {
    ($name:ident<$($argument:tt),*> where [$($generics:tt)*]) => {
        impl<$($generics)*> Copy for $name<$($argument),*> {}

        impl<$($generics)*> Clone for $name<$($argument),*> {
            #[inline]
            fn clone(&self) -> Self {
                *self
            }
        }
    };
}

/// As [`copy`], and `Debug` as by [`debug`].
macro_rules! copied {
    ($name:ident<$($argument:tt),*> where [$($generics:tt)*]: $($field:ident),*) => {
        $crate::fields::copy!($name<$($argument),*> where [$($generics)*]);
        $crate::fields::debug!($name<$($argument),*> where [$($generics)*]: $($field),*);
    };
}

pub(crate) use {copied, copy, debug, debug_fields, getters};
