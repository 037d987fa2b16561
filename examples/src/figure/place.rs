//! Where figures go when nobody says.

use std::path::{Path, PathBuf};

/// The file that cargo puts into its target folder.
const MARK: &str = "CACHEDIR.TAG";

/// `figures/NAME.svg` under the target folder of cargo that this program was built in, else under the current folder.
pub fn default_path(name: &str) -> PathBuf {
    let program = std::env::current_exe().unwrap_or_default();
    let target = program.ancestors().find(|folder| folder.join(MARK).is_file()).unwrap_or(Path::new("."));
    target.join("figures").join(name).with_extension("svg")
}
