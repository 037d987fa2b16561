//! The frame of a scene: its failures, its output, and its exit codes.

use crate::claims::Claims;
use std::fmt::{self, Display, Formatter};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Why a scene could not be run to its end.
#[derive(Debug)]
pub enum Failure {
    /// The parameters or the start are refused.
    Start(clebsch::Error),
    /// A step could not be made.
    Step {
        /// The number of the state that was asked for.
        step: u64,
        /// Why it was not reached.
        error: clebsch::Error,
    },
    /// A file could not be written.
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// A page that plays the motion could not be made.
    Page(clebsch_plot::PlotError),
    /// Two flags do not fit together.
    Flags(String),
}

impl Failure {
    /// For `map_err` on errors of a step of many sites.
    pub fn step(step: u64) -> impl Fn(clebsch::SiteError) -> Self {
        move |failure| Self::Step { step, error: failure.error }
    }

    /// For `map_err` on errors of writing to `path`.
    pub fn file(path: &Path) -> impl Fn(io::Error) -> Self + '_ {
        |error| Self::File { path: path.to_owned(), error }
    }
}

impl Display for Failure {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Start(error) => write!(f, "{error}"),
            Self::Step { step, error } => write!(f, "step {step} was not reached: {error}"),
            Self::File { path, error } => write!(f, "cannot write {}: {error}", path.display()),
            Self::Page(error) => write!(f, "{error}"),
            Self::Flags(text) => f.write_str(text),
        }
    }
}

impl std::error::Error for Failure {}

impl From<clebsch::Error> for Failure {
    fn from(error: clebsch::Error) -> Self {
        Self::Start(error)
    }
}

impl From<clebsch_plot::PlotError> for Failure {
    fn from(error: clebsch_plot::PlotError) -> Self {
        Self::Page(error)
    }
}

impl From<clebsch::SiteError> for Failure {
    fn from(failure: clebsch::SiteError) -> Self {
        Self::Start(failure.error)
    }
}

/// Prints to standard output. A reader that has gone away, as in `| head`, is no reason to stop.
pub fn say(text: impl Display) {
    let _ = writeln!(io::stdout().lock(), "{text}");
}

/// Prints the claims and ends the scene: success only where none of them failed.
pub fn conclude(outcome: Result<Claims, Failure>) -> ExitCode {
    let mut errors = io::stderr().lock();
    match outcome {
        Ok(claims) => {
            say(&claims);
            for claim in claims.failed() {
                let _ = writeln!(errors, "error: claim failed: {claim}");
            }
            if claims.failed().next().is_none() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
        }
        Err(failure) => {
            let _ = writeln!(errors, "error: {failure}");
            ExitCode::FAILURE
        }
    }
}
