//! Prints `docs/features.md`: `cargo run -p clebsch-compiler --example features > docs/features.md`.

use clebsch_compiler::{model, parse};

fn main() {
    print!(
        "# Keys, and what does not go together

The tables of this page are those of the compiler, and a test holds them against it.
`cargo run -p clebsch-compiler --example features > docs/features.md` prints the page anew.

## Keys

{}
## What does not go together

Most keys can be combined. These combinations are refused; the error stands at what is in the first column.
Where several features stand in a cell, each of the first column is refused with each of the second.

{}",
        parse::keys_as_markdown(),
        model::features_as_markdown(),
    );
}
