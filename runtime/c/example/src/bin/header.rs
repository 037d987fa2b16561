//! Prints the header of the system with the given name.

use clebsch_c_example::{fine_top, heavy_top, probe};

fn main() -> Result<(), String> {
    match std::env::args().nth(1).as_deref() {
        Some("heavy_top") => print!("{}", heavy_top::HEADER),
        Some("fine_top") => print!("{}", fine_top::HEADER),
        Some("probe") => print!("{}", probe::HEADER),
        other => return Err(format!("no system {other:?}: write `heavy_top`, `fine_top` or `probe`")),
    }
    Ok(())
}
