//! The place of a declaration.
