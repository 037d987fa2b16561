//! The same declaration gives the same tokens in another process: at other addresses, in another environment, with other
//! hashes, and after other declarations.
//!
//! One fixture in four is expanded so, and all of them where `CLEBSCH_FUZZ` is set.

use std::hash::{BuildHasher, RandomState};
use std::process::Command;

use clebsch_compiler::expand;

use crate::{seeds, verdict};

/// Set where this program has been started by itself.
const CHILD: &str = "CLEBSCH_CHILD";
/// The text before the list in the child's output.
const MARK: &str = "expansions:";

/// A number for the expansion of every fixture that is the same in every process, and in every order of expansion.
fn expansions(backwards: bool) -> Vec<String> {
    let expand = |(name, text): (String, String)| {
        let item = verdict::declaration(text.parse().expect("tokens"));
        format!("{name} {:016x}", fingerprint(&expand(item).to_string()))
    };
    let mut fixtures: Vec<_> =
        ["fixtures/accept", "fixtures/reject"].iter().flat_map(|folder| seeds::sample(folder, 4)).collect();
    if backwards {
        fixtures.reverse();
    }
    let mut found: Vec<String> = fixtures.into_iter().map(expand).collect();
    if backwards {
        found.reverse();
    }
    found
}

/// FNV-1a.
fn fingerprint(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[test]
fn another_process_expands_to_the_same_tokens() {
    // memory that another process has not, and a number that it has not either
    let moved = vec![1_u8; 1 << 20];
    let own = RandomState::new().hash_one(&moved);
    if std::env::var(CHILD).is_ok() {
        println!("{MARK}{own:016x}|{}", expansions(true).join("|"));
        return;
    }
    let program = std::env::current_exe().expect("this program");
    let child = Command::new(program)
        .args(["--exact", "processes::another_process_expands_to_the_same_tokens", "--nocapture"])
        .envs([(CHILD, "1"), ("LANG", "tr_TR.UTF-8"), ("TZ", "Asia/Kathmandu"), ("PADDING", &"x".repeat(40_000))])
        .current_dir(std::env::temp_dir())
        .output()
        .expect("this program runs again");
    let text = String::from_utf8_lossy(&child.stdout);
    let list = text.lines().find_map(|line| line.split_once(MARK)).unwrap_or_else(|| panic!("no list in:\n{text}")).1;
    let (other, found) = list.split_once('|').expect("two parts");
    assert_ne!(other, format!("{own:016x}"), "the hashes of both processes are alike");
    let found: Vec<&str> = found.split('|').collect();
    let expected = expansions(false);
    assert!(expected.len() > 60, "only {} fixtures", expected.len());
    for (expected, found) in expected.iter().zip(&found) {
        assert_eq!(expected, found, "a fixture expands to other tokens in another process");
    }
    assert_eq!(expected.len(), found.len());
}
