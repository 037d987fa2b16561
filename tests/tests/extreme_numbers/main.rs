//! NaN, infinite, huge and tiny numbers in every place of every accepted fixture. The result is an error that names the
//! input, or it is finite and on its space. Then many numbers at once, in ratios of up to 10¹⁵: parameters, states,
//! inputs and step sizes. Nothing panics, nothing runs for ever, and no NaN is handed on as a result. A step that is
//! too long is told the longest one that is not.

#![allow(missing_docs)]

mod checks;
mod longest;
mod slots;
mod systems;
mod trial;
