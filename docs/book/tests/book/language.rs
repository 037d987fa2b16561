//! Plain sentences: long ones and private words are counted, and there are no more of them than `docs/book/language.txt` says.
//!
//! `CLEBSCH_LANGUAGE=list cargo test -p clebsch-book --test book language -- --nocapture` lists them; `CLEBSCH_LANGUAGE=write` records the counts.

use crate::pages::{files, lines_of_prose, read, root, without_code};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// A sentence with more words is long.
const WORDS: usize = 25;

/// Words that have a second meaning here, and clauses in place of nouns.
const PRIVATE: [&str; 8] = ["kept", "held", "the rest", "whole", "beside", "of which", "written out", "what"];

/// The areas that are counted: a name, its Markdown files, the folders of its sources.
fn areas() -> [(&'static str, Vec<PathBuf>); 7] {
    let root = root();
    let mut guides = files(&root.join("docs"), "md");
    guides.extend(["CONTRIBUTING.md", "macros/reference.md"].map(|name| root.join(name)));
    let macros =
        ["macros/src", "macros/symbolic/src", "macros/compiler/src"].map(|folder| files(&root.join(folder), "rs"));
    let tests = [
        "tests",
        "runtime/tests",
        "macros/symbolic/tests",
        "macros/compiler/tests",
        "docs/book/tests",
        "docs/book/live",
    ]
    .map(|folder| files(&root.join(folder), "rs"));
    [
        ("README", vec![root.join("README.md")]),
        ("CHANGELOG", vec![root.join("CHANGELOG.md")]),
        ("docs", guides),
        ("runtime", ["runtime/src", "runtime/plot/src"].map(|folder| files(&root.join(folder), "rs")).concat()),
        ("macros", macros.concat()),
        ("examples", files(&root.join("examples"), "rs")),
        ("tests", tests.concat()),
    ]
}

/// The prose of a Markdown file, or of the comments of a source.
fn prose(path: &Path) -> String {
    let text = read(path);
    if path.extension().is_some_and(|extension| extension == "md") {
        return text;
    }
    let comment = |line: &str| {
        let line = line.trim_start();
        let prefixes = ["/// ", "//! ", "// "];
        prefixes.into_iter().find_map(|prefix| line.strip_prefix(prefix)).unwrap_or_default().to_owned()
    };
    text.lines().map(comment).collect::<Vec<_>>().join("\n")
}

/// Paragraphs, items of lists and cells of tables, without code, headings and lists of sources.
fn blocks(markdown: &str) -> Vec<String> {
    let mut blocks = vec![String::new()];
    let mut is_source = false;
    for line in lines_of_prose(markdown) {
        if line.starts_with('#') {
            is_source = line == "## Sources";
        }
        if is_source {
            continue;
        }
        let line = without_code(&line.replace("\\|", " "));
        let text = line.trim();
        let number = text.split_once(". ").map(|(number, _)| number.parse::<u8>());
        if text.is_empty() || text.starts_with(['#', '!', '{']) {
            blocks.push(String::new());
        } else if text.starts_with('|') {
            blocks.extend(text.split('|').map(str::to_owned));
            blocks.push(String::new());
        } else {
            if text.starts_with("* ") || text.starts_with("- ") || matches!(number, Some(Ok(_))) {
                blocks.push(String::new());
            }
            let block = blocks.last_mut().expect("by construction: there is a first block");
            block.push(' ');
            block.push_str(text);
        }
    }
    blocks
}

fn sentences(markdown: &str) -> Vec<String> {
    let mut sentences = Vec::new();
    for block in blocks(markdown) {
        let ends = block.match_indices([' ']).filter(|&(at, _)| block[..at].ends_with(['.', '?', '!']));
        let mut start = 0;
        for (end, _) in ends {
            sentences.push(block[start..end].trim().to_owned());
            start = end;
        }
        sentences.push(block[start..].trim().to_owned());
    }
    sentences.retain(|sentence| !sentence.is_empty());
    sentences
}

/// The words of a sentence, in small letters.
fn words(sentence: &str) -> Vec<String> {
    let bare = |word: &str| word.trim_matches(|letter: char| !letter.is_alphanumeric()).to_lowercase();
    sentence.split_whitespace().map(bare).filter(|word| !word.is_empty()).collect()
}

/// How often private words occur. A question may begin with `what`.
fn private(sentence: &str, words: &[String]) -> usize {
    let is_question = sentence.ends_with('?');
    let text = format!(" {} ", words.join(" ")).replace(" whole number", " integer");
    PRIVATE
        .iter()
        .filter(|&&word| word != "what" || !is_question)
        .map(|word| text.matches(&format!(" {word} ")).count())
        .sum()
}

#[test]
fn sentences_are_as_plain_as_the_level_reached() {
    let dial = std::env::var("CLEBSCH_LANGUAGE").unwrap_or_default();
    let level = root().join("docs/book/language.txt");
    let mut counts = String::from("area  sentences of more than 25 words  private words\n");
    let mut worse = Vec::new();
    let recorded = fs::read_to_string(&level).unwrap_or_default();
    for (area, files) in areas() {
        let mut found = [0, 0];
        for file in files {
            for sentence in sentences(&prose(&file)) {
                let words = words(&sentence);
                let is_long = words.len() > WORDS;
                let private = private(&sentence, &words);
                found[0] += usize::from(is_long);
                found[1] += private;
                if dial == "list" && (is_long || private > 0) {
                    println!("{}: {} words, {private} private: {sentence}", file.display(), words.len());
                }
            }
        }
        writeln!(counts, "{area} {} {}", found[0], found[1]).expect("a string takes text");
        let row = recorded.lines().find_map(|line| line.strip_prefix(area)).unwrap_or_default();
        let reached: Vec<usize> = row.split_whitespace().filter_map(|count| count.parse().ok()).collect();
        if reached.len() != 2 || found.iter().zip(&reached).any(|(found, reached)| found > reached) {
            worse.push(area);
        }
    }
    println!("{counts}");
    if dial == "write" {
        fs::write(&level, counts).expect("the file of counts");
        return;
    }
    assert!(
        worse.is_empty(),
        "{worse:?} have more long sentences or private words than docs/book/language.txt says; CLEBSCH_LANGUAGE=list lists them\n{recorded}\n{counts}"
    );
}
