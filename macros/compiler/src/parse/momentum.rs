//! Declarations of momenta alone: what they cannot have.

use super::keys::Keys;
use crate::diagnostic::{Diagnostic, Diagnostics};

/// Keys of which each needs a configuration.
const OF_CONFIGURATIONS: [&str; 9] =
    ["potential", "force_on", "symmetry", "isotropy", "endpoint", "effort", "controls", "dynamics", "bounds"];

/// Where the momentum is stepped alone, nothing may depend on a configuration.
pub(super) fn check(keys: &Keys, diagnostics: &mut Diagnostics) {
    if !keys.dials.emit.momentum {
        return;
    }
    for name in OF_CONFIGURATIONS {
        if let Some(span) = keys.place_of(name) {
            let error =
                Diagnostic::new(span, format!("`emit = [momentum]` steps the momentum alone, without `{name}`"));
            diagnostics.push(
                error
                    .help(format!("leave out `{name}`, or the word `momentum`"))
                    .note("it needs the configuration, and none is stepped"),
            );
        }
    }
    for (asked, word) in [(keys.dials.emit.tangent, "tangent"), (keys.dials.emit.boundary, "boundary")] {
        if let Some(span) = keys.place_of("emit").filter(|_| asked) {
            let error = Diagnostic::new(span, format!("`momentum` and `{word}` do not go together"));
            diagnostics.push(
                error
                    .help("leave out one of the two")
                    .note(format!("`{word}` is about motions of the configuration, and none is stepped")),
            );
        }
    }
}
