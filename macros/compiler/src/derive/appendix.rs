//! The derivation as an appendix of a paper: its words, its formulas with their titles, and its sources, in LaTeX.

#[cfg(test)]
mod tests;

use std::iter::Peekable;
use std::str::Chars;

use clebsch_symbolic::IntoList;

use super::latex::{accented, letter, lowered, raised};
use super::{FormulaTable, Reference};

/// An unnumbered section for the text of a `DERIVATION` and its formulas. It needs `amsmath` and `amssymb`.
pub fn appendix(derivation: &str, table: &FormulaTable<'_>) -> String {
    let (title, text) = derivation.trim_start().split_once('\n').unwrap_or((derivation, ""));
    let words = text.split("\nFormulas\n").next().unwrap_or_default().trim();
    let words = words.lines().map(in_words).into_list().join("\n");
    let rows = table.listing().map(|formula| {
        let tag =
            if formula.title.is_empty() { String::new() } else { format!(" \\tag*{{{}}}", in_words(formula.title)) };
        formula.equation_in_latex() + &tag
    });
    let rows = rows.into_list().join(" \\\\\n");
    let mut sources: Vec<Reference> = Vec::new();
    for source in table.listing().filter_map(|formula| formula.source) {
        if !sources.contains(&source) {
            sources.push(source);
        }
    }
    let sources: String = sources.iter().map(|source| format!("\\item {}.\n", in_words(&source.to_string()))).collect();
    let sources = if sources.is_empty() {
        sources
    } else {
        format!("\n\\paragraph{{Sources}}\n\\begin{{itemize}}\n{sources}\\end{{itemize}}\n")
    };
    // amsmath expects up to ten columns
    let is_wide = rows.split("\\\\").any(|row| row.matches('&').count() > 9);
    let wide = if is_wide { "\\setcounter{MaxMatrixCols}{100}" } else { "" };
    format!(
        "\\section*{{{}}}\n\n{words}\n\n{{\\allowdisplaybreaks{wide}\n\\begin{{align*}}\n{rows}\n\\end{{align*}}}}\n{sources}",
        in_words(title)
    )
}

/// A sentence in LaTeX. Words with mathematical signs are formulas, and text in backticks is code.
fn in_words(sentence: &str) -> String {
    let part = |(index, part): (usize, &str)| {
        if index % 2 == 1 {
            return format!("\\texttt{{{}}}", escaped(part));
        }
        part.split(' ')
            .map(|word| if is_formula(word) { format!("${}$", formula(word)) } else { escaped(word) })
            .into_list()
            .join(" ")
    };
    sentence.split('`').enumerate().map(part).collect()
}

/// Whether a word has a sign that only formulas have.
fn is_formula(word: &str) -> bool {
    let is_sign = |c: char| !c.is_ascii() && !"–’‘".contains(c) || "^*[_<".contains(c);
    word.contains(is_sign) || ["=", "+", ">"].contains(&word)
}

/// Plain text.
fn escaped(text: &str) -> String {
    let character = |c: char| match c {
        '&' | '%' | '$' | '#' | '_' | '{' | '}' => format!("\\{c}"),
        '~' => "\\textasciitilde{}".into(),
        '^' => "\\textasciicircum{}".into(),
        '\\' => "\\textbackslash{}".into(),
        '–' => "--".into(),
        '’' | '‘' => "'".into(),
        _ => letter(c).map_or(c.to_string(), |command| format!("$\\{command}$")),
    };
    text.chars().map(character).collect()
}

/// The signs at the front of a text that have a meaning.
fn run<V>(signs: &mut Peekable<Chars<'_>>, meaning: impl Fn(char) -> Option<V>) -> Vec<V> {
    std::iter::from_fn(|| {
        let found = meaning(*signs.peek()?)?;
        signs.next();
        Some(found)
    })
    .into_list()
}

/// A word as a formula: names upright, letters by their commands, superscripts and subscripts in braces.
fn formula(word: &str) -> String {
    let mut text = String::new();
    let mut signs = word.chars().peekable();
    while let Some(&sign) = signs.peek() {
        let name: String =
            if sign.is_ascii_alphabetic() { run(&mut signs, of_name).into_iter().collect() } else { String::new() };
        if !name.is_empty() {
            let accent = signs.next_if(|sign| ['\u{303}', '\u{307}'].contains(sign));
            text += &accented(spelled(&name), accent);
            match signs.peek() {
                Some('*') if name == "Ad" => {
                    signs.next();
                    text += "^{*}";
                }
                // `SO<3>`
                Some('<') => {
                    let size: String = signs.by_ref().skip(1).take_while(|sign| *sign != '>').collect();
                    text += &format!("({})", formula(&size));
                }
                _ => {}
            }
            continue;
        }
        let high = run(&mut signs, raised);
        if !high.is_empty() {
            text += &format!("^{{{}}}", high.join(""));
            continue;
        }
        let low: String = run(&mut signs, lowered).into_iter().collect();
        if !low.is_empty() {
            text += &format!("_{{{low}}}");
            continue;
        }
        signs.next();
        let plain = match sign {
            '_' => format!("_{{{}}}", run(&mut signs, of_name).into_iter().collect::<String>()),
            '^' if signs.next_if_eq(&'*').is_some() => "^{*}".into(),
            '^' if signs.next_if_eq(&'⊥').is_some() => "^{\\perp}".into(),
            '^' => "^{\\wedge}".into(),
            '*' => "\\,".into(),
            '−' => "-".into(),
            '𝔤' => "\\mathfrak g".into(),
            '%' | '&' | '#' | '$' | '{' | '}' => format!("\\{sign}"),
            _ => letter(sign).map_or(sign.to_string(), |command| format!("\\{command} ")),
        };
        text += &accented(plain, signs.next_if(|sign| ['\u{303}', '\u{307}'].contains(sign)));
    }
    text
}

fn of_name(sign: char) -> Option<char> {
    (sign.is_ascii_alphanumeric() || sign == '_').then_some(sign)
}

/// A name: one letter as it is, and E_i with a subscript; longer ones upright.
fn spelled(name: &str) -> String {
    match name.split_once('_') {
        Some((base, low)) if base.len() == 1 => format!("{base}_{{{}}}", low.replace('_', "\\_")),
        _ if name.len() == 1 => name.into(),
        _ => format!("\\mathrm{{{}}}", name.replace('_', "\\_")),
    }
}
