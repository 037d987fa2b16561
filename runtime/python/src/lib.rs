//! The compiler of clebsch as an extension module of Python: a declaration is checked and derived in milliseconds, without cargo.
//!
//! The Python package `clebsch` asks it before it builds anything. A mistake in a declaration is an exception at once, and its text and
//! place are those of the macro. It also reads what the library needs to know: the struct, its fields and its methods.

mod declaration;
mod mistake;

use declaration::Declaration;
use mistake::Mistake;
use pyo3::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What a declaration says, or its mistakes. Each has its text, then the lines and columns of its first and last letter, from 1 and from 0.
#[pyfunction]
fn check(py: Python<'_>, text: &str) -> (Option<Declaration>, Vec<Mistake>) {
    // in a panic of the compiler the library of the declaration asks for a report
    let read = || catch_unwind(AssertUnwindSafe(|| Declaration::read(text)));
    match py.detach(read) {
        Ok(Ok(declaration)) => (Some(declaration), Vec::new()),
        Ok(Err(mistakes)) => (None, mistakes),
        Err(_) => (None, vec![Mistake::bug()]),
    }
}

/// The formulas of a declaration as an appendix in LaTeX, or its mistakes.
#[pyfunction]
fn latex(py: Python<'_>, text: &str) -> (Option<String>, Vec<Mistake>) {
    let read = || catch_unwind(AssertUnwindSafe(|| declaration::appendix(text)));
    match py.detach(read) {
        Ok(Ok(appendix)) => (Some(appendix), Vec::new()),
        Ok(Err(mistakes)) => (None, mistakes),
        Err(_) => (None, vec![Mistake::bug()]),
    }
}

/// The compiler of clebsch.
#[pymodule]
fn _compiler(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("VERSION", env!("CARGO_PKG_VERSION"))?;
    module.add_function(wrap_pyfunction!(check, module)?)?;
    module.add_function(wrap_pyfunction!(latex, module)?)
}
