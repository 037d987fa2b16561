//! No prelude: neither `Option` nor `Clone` nor the names of crates are in scope.

::core::include!("systems.rs");
