//! The formulas in LaTeX: the constant `DERIVATION_LATEX`.

#[cfg(test)]
mod tests;

/// Words of left sides; other words are names.
const WORDS: [&str; 6] = ["at", "with", "for", "each", "of", "in"];

/// Letters and signs, each with the name of its command.
const COMMANDS: &str = "Γ Gamma Δ Delta Θ Theta Λ Lambda Ξ Xi Π Pi Σ Sigma Φ Phi Ψ Psi Ω Omega α alpha β beta γ gamma δ delta ε varepsilon ζ zeta \
                        η eta θ theta ι iota κ kappa λ lambda μ mu ν nu ξ xi π pi ρ rho σ sigma τ tau φ varphi χ chi ψ psi ω omega ℓ ell \
                        ∂ partial ∇ nabla ∫ int √ surd · cdot × times ÷ div ± pm ∘ circ ⊥ perp ⋆ star ⟨ langle ⟩ rangle ≥ ge ≤ le ≠ ne ∈ in \
                        ← leftarrow → to ↦ mapsto … dots ∞ infty ½ tfrac12";

pub(super) fn letter(sign: char) -> Option<&'static str> {
    let mut words = COMMANDS.split_whitespace();
    words.by_ref().find(|word| word.chars().eq([sign]))?;
    words.next()
}

/// Superscripts, each with its meaning.
const RAISED: [(char, &str); 19] = [
    ('⁰', "0"),
    ('¹', "1"),
    ('²', "2"),
    ('³', "3"),
    ('⁴', "4"),
    ('⁵', "5"),
    ('⁶', "6"),
    ('⁷', "7"),
    ('⁸', "8"),
    ('⁹', "9"),
    ('⁺', "+"),
    ('⁻', "-"),
    ('ᵀ', "\\mathsf T"),
    ('ⁿ', "n"),
    ('ⁱ', "i"),
    ('ʲ', "j"),
    ('ʰ', "h"),
    ('′', "\\prime"),
    ('ᵏ', "k"),
];

pub(super) fn raised(sign: char) -> Option<&'static str> {
    RAISED.iter().find(|(own, _)| *own == sign).map(|(_, meaning)| *meaning)
}

pub(super) fn lowered(sign: char) -> Option<char> {
    "₀₁₂₃₄₅₆₇₈₉₋ₖᵢⱼ".chars().zip("0123456789-kij".chars()).find(|(own, _)| *own == sign).map(|(_, meaning)| meaning)
}

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
    if let Some(command) = letter(first) {
        return format!("\\{command} ");
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

/// A base with the accent that follows it.
pub(super) fn accented(base: String, accent: Option<char>) -> String {
    match accent {
        Some('\u{303}') => format!("\\tilde{{{base}}}"),
        Some(_) => format!("\\dot{{{base}}}"),
        None => base,
    }
}

/// A formula in LaTeX without characters that only some of its programs read.
pub(super) fn in_ascii(formula: &str) -> String {
    if formula.is_ascii() {
        return formula.into();
    }
    let mut text = String::new();
    let mut signs = formula.chars().peekable();
    while let Some(sign) = signs.next() {
        let (mut high, mut low) = (String::new(), String::new());
        raised(sign).into_iter().for_each(|meaning| high += meaning);
        low.extend(lowered(sign));
        while let Some(meaning) = signs.peek().copied().and_then(raised).filter(|_| !high.is_empty()) {
            high += meaning;
            signs.next();
        }
        while let Some(meaning) = signs.peek().copied().and_then(lowered).filter(|_| !low.is_empty()) {
            low.push(meaning);
            signs.next();
        }
        if !high.is_empty() || !low.is_empty() {
            text += &if low.is_empty() { format!("^{{{high}}}") } else { format!("_{{{low}}}") };
            continue;
        }
        let plain = match sign {
            '−' => "-".into(),
            _ => letter(sign).map_or(sign.to_string(), |command| format!("\\{command} ")),
        };
        text += &accented(plain, signs.next_if(|sign| ['\u{303}', '\u{307}'].contains(sign)));
    }
    text
}
