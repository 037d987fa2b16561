//! The formulas in LaTeX: the constant `DERIVATION_LATEX`.

#[cfg(test)]
mod tests;

/// Words of left sides; other words are names.
const WORDS: [&str; 6] = ["at", "with", "for", "each", "of", "in"];

/// Letters and signs, each with the name of its command.
const COMMANDS: &str = "Φ Phi Σ Sigma Δ Delta ξ xi η eta ζ zeta μ mu ν nu λ lambda π pi ρ rho φ varphi δ delta ε varepsilon γ gamma α alpha \
                        β beta ℓ ell ∂ partial · cdot ⟨ langle ⟩ rangle ≥ ge";

/// Signs that are written in another way.
const SIGNS: [(char, &str); 8] =
    [('−', "-"), ('%', "\\%"), ('′', "'"), ('⁺', "^+"), ('⁻', "^-"), ('₀', "_0"), ('₁', "_1"), ('₂', "_2")];

/// A left side, `J(q, p)`, in LaTeX: words upright, letters by their names, subscripts in braces.
pub(super) fn left_side(symbol: &str) -> String {
    let symbol = symbol.replace("^-*", "^{-*}").replace("Ad*", "Ad^*");
    let mut text = String::new();
    let mut rest = symbol.as_str();
    while let Some(first) = rest.chars().next() {
        let (part, after) = rest.split_at(length_of_word(first, rest));
        text += &word(first, part);
        rest = after;
    }
    text
}

/// The length of the unit at the start of a text: a word, a subscript, or one character.
fn length_of_word(first: char, text: &str) -> usize {
    let behind_word = text.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(text.len());
    match first {
        '_' if text[1..].starts_with('(') => text.find(')').map_or(1, |end| end + 1),
        '_' => behind_word,
        letter if letter.is_ascii_alphabetic() => behind_word,
        other => other.len_utf8(),
    }
}

fn word(first: char, part: &str) -> String {
    if let Some((_, latex)) = SIGNS.iter().find(|(sign, _)| *sign == first) {
        return latex.to_string();
    }
    let mut words = COMMANDS.split_whitespace();
    if !first.is_ascii() && words.any(|word| word.starts_with(first)) {
        return format!("\\{} ", words.next().unwrap_or_default());
    }
    match part.split_once('_') {
        // ξ_Q and V_1 keep their subscripts
        Some((base, subscript)) if base.len() < 2 => format!("{base}_{{{}}}", upright(subscript)),
        _ if WORDS.contains(&part) => format!("\\text{{ {part} }}"),
        _ => upright(part),
    }
}

/// A name of more than one letter in upright type.
fn upright(name: &str) -> String {
    let is_word = name.len() > 1 && name.starts_with(|c: char| c.is_ascii_alphabetic());
    if is_word { format!("\\mathrm{{{}}}", name.replace('_', "\\_")) } else { name.to_string() }
}
