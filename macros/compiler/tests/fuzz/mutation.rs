//! Declarations with random changes: their tokens left out, doubled, swapped, replaced by words of the language, wrapped, spliced.
//!
//! The tests and the fuzz target `declarations` include this file.

use proc_macro2::{Delimiter, Spacing, TokenStream, TokenTree};

/// Choices from a seed, the same on every machine (SplitMix64: Steele, Lea and Flood 2014).
pub struct Choices(u64);

impl Choices {
    /// The sequence that belongs to `seed`.
    pub fn new(seed: u64) -> Choices {
        Choices(seed)
    }

    /// A number of 0..n, or 0 where there is none.
    pub fn pick(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^= bits >> 31;
        (bits % n.max(1) as u64) as usize
    }

    fn of<'a>(&mut self, words: &[&'a str]) -> &'a str {
        words[self.pick(words.len())]
    }
}

/// Words of the language, and some that are none.
#[rustfmt::skip]
const WORDS: &[&str] = &[
    "action", "cost", "lagrangian", "potential", "symmetry", "force", "force_on", "controls", "dynamics", "effort", "bounds", "endpoint",
    "isotropy = free", "order = 1", "order = 4", "order = 6", "order = 8", "order = 16", "discretization = cayley",
    "discretization = exponential", "discretization = projection", "discretization = moser_veselov", "discretization = exact",
    "chart = exponential", "chart = cayley", "solver = newton", "solver = fixed_point", "tolerance = 1e-8", "summation = compensated",
    "emit = [tangent]", "emit = [boundary]", "emit = [momentum]", "emit = [generated]", "scalar = f32", "crate = ::other", "group", "basis",
    "opaque(Self::value, Self::gradient)", "SO<3>", "SO<2>", "SO<4>", "SE<3>", "SE<2>", "SU<2>", "U<2>", "GL<2>", "SL<2>", "Sp<2>",
    "SO<1, 2>", "Translation<3>", "Heisenberg<1>", "Aff<2>", "Sim<2>", "[SO<3>; 2]", "(SO<3>, Translation<3>)", "Vector3", "Vector2",
    "Matrix3", "SMatrix<3, 2>", "SVector<4>", "Unit<Vector3>", "UnitQuaternion", "f64", "f32", "T", "&'static str", "self", "self.mass",
    "t", "h", "F", "q", "R", "x", "u", "omega", "xi", "I", "vector![1, 2, 3]", "matrix![1, 2; 3, 4]", "Matrix3::identity()",
    "Vector3::z()", "Matrix3::from_diagonal(&q)", ".transpose()", ".trace()", ".norm()", ".norm_squared()", ".inverse()", ".dot(&q)",
    ".cross(&q)", ".x", ".z", "[(0, 0)]", "[0]", ".0", ".rotation()", ".translation()", ".sqrt()", ".sin()", ".exp()", ".ln()", ".powi(2)",
    ".powf(0.5)", ".recip()", ".determinant()", ".abs()", ".matrix()", ".conjugate()", ".imag()", ".fixed_rows::<2>(0)", ".xy()",
    ".component_mul(&q)", "+", "-", "*", "/", "..", "constraint", "==", "&&", "<=", "(1..N).map(|i| q[i] == q[i - 1])", "|q| [q.x == 0]",
    "|t, q, xi| [q.x * xi.x == t]", "[SE<2>; N]", "Vector3::zeros()",
];

/// The wrappings of a part; the part stands where `@` is.
#[rustfmt::skip]
const WRAPPINGS: &[&str] = &[
    "( @ )", "- ( @ )", "( @ ) . norm ( )", "( @ ) . sin ( )", "( @ ) . powi ( 7 )", "( @ ) . sqrt ( )", "( @ , @ )", "[ @ ; 2 ]",
    "( @ ) * ( @ )", "( @ ) + ( @ )", "1 / ( @ )", "{ let y = @ ; y * y }", "( 0 .. 9 ) . map ( | i | @ ) . sum ( )", "& @", "( @ ) . exp ( )",
    "[ @ == 0 ]", "( 1 .. N ) . map ( | i | @ == @ )", "[ | q | [ @ ] , | q , xi | [ @ ] ]", "[ @ , @ , @ ]", "( @ ) . inverse ( )", "if q { @ } else { 1 }", "| y | @", "matrix ! [ @ , 1 ; 2 , @ ]",
];

/// Numbers at which something may end.
#[rustfmt::skip]
const NUMBERS: &[&str] = &[
    "0", "1", "2", "3", "4", "5", "7", "8", "16", "64", "65", "100", "128", "1000", "0.5", "1e308", "1e-400", "1e999999999", "1.5e-7",
    "2147483647", "18446744073709551615", "18446744073709551616", "0x10", "1_000f32",
];

/// A text with one to four changes; parts of `other` may come into it. A text that is no Rust is changed into `other`.
pub fn mutated(text: &str, other: &str, choices: &mut Choices) -> String {
    let (Some(mut words), donor) = (words(text), words(other)) else { return other.to_string() };
    let most = [1, 1, 2, 4][choices.pick(4)];
    for _ in 0..most {
        change(&mut words, donor.as_deref().unwrap_or_default(), choices);
    }
    words.join(" ")
}

/// One change.
fn change(words: &mut Vec<String>, donor: &[String], choices: &mut Choices) {
    let part = part(words, choices);
    let taken: Vec<String> = words[part.clone()].to_vec();
    let put = |words: &mut Vec<String>, range: std::ops::Range<usize>, new: Vec<String>| {
        words.splice(range, new);
    };
    match choices.pick(12) {
        0 => put(words, part, Vec::new()),
        1 => put(words, part.end..part.end, taken),
        2 => {
            let second = self::part(words, choices);
            let copied = words[second].to_vec();
            put(words, part, copied);
        }
        3 => swap(words, part, choices),
        4 | 5 => put(words, part, vec![choices.of(WORDS).to_string()]),
        6 => put(words, part.end..part.end, vec![choices.of(WORDS).to_string()]),
        7 | 8 => number(words, choices),
        9 => {
            let wrapping = choices.of(WRAPPINGS).replace('@', &taken.join(" "));
            put(words, part, vec![wrapping]);
        }
        10 if !donor.is_empty() => {
            let new = donor[self::part(donor, choices)].to_vec();
            put(words, part, new);
        }
        _ => key(words, donor, choices),
    }
}

/// Two parts change places.
fn swap(words: &mut Vec<String>, first: std::ops::Range<usize>, choices: &mut Choices) {
    let second = part(words, choices);
    let (first, second) = if first.start <= second.start { (first, second) } else { (second, first) };
    if first.end <= second.start {
        let (left, right) = (words[first.clone()].to_vec(), words[second.clone()].to_vec());
        words.splice(second, left);
        words.splice(first, right);
    }
}

/// Another number in place of one.
fn number(words: &mut [String], choices: &mut Choices) {
    let is_number = |word: &String| word.starts_with(|c: char| c.is_ascii_digit());
    let numbers: Vec<usize> = (0..words.len()).filter(|&at| is_number(&words[at])).collect();
    if !numbers.is_empty() {
        words[numbers[choices.pick(numbers.len())]] = choices.of(NUMBERS).to_string();
    }
}

/// A key of the donor, the text between two commas. It is put in front of a comma, or in place of the text between two.
fn key(words: &mut Vec<String>, donor: &[String], choices: &mut Choices) {
    let (from, into) = (stretches(donor), stretches(words));
    if let (false, false) = (from.is_empty(), into.is_empty()) {
        let new = donor[from[choices.pick(from.len())].clone()].to_vec();
        let place = into[choices.pick(into.len())].clone();
        let place = if choices.pick(2) == 0 { place } else { place.start..place.start };
        words.splice(place, new);
    }
}

/// The stretches that end with a comma and start behind one at the same level. It is the level of the keys where
/// brackets are two deep.
fn stretches(words: &[String]) -> Vec<std::ops::Range<usize>> {
    let (mut depth, mut start, mut found) = (0_usize, None, Vec::new());
    for (at, word) in words.iter().enumerate() {
        match word.as_str() {
            "(" | "[" | "{" => {
                depth += 1;
                start = if depth == 2 { Some(at + 1) } else { start };
            }
            ")" | "]" | "}" => depth = depth.saturating_sub(1),
            "," if depth == 2 => {
                found.extend(start.map(|start| start..at + 1));
                start = Some(at + 1);
            }
            _ => {}
        }
    }
    found
}

/// A word, or a bracket with its content.
fn part(words: &[String], choices: &mut Choices) -> std::ops::Range<usize> {
    if words.is_empty() {
        return 0..0;
    }
    let at = choices.pick(words.len());
    let step: isize = match words[at].as_str() {
        "(" | "[" | "{" => 1,
        ")" | "]" | "}" => -1,
        _ => return at..at + 1,
    };
    let (mut depth, mut end) = (0_isize, at as isize);
    while let Some(word) = usize::try_from(end).ok().and_then(|end| words.get(end)) {
        depth += match word.as_str() {
            "(" | "[" | "{" => 1,
            ")" | "]" | "}" => -1,
            _ => 0,
        };
        if depth == 0 {
            break;
        }
        end += step;
    }
    let end = end.clamp(0, words.len() as isize - 1) as usize;
    at.min(end)..at.max(end) + 1
}

/// The tokens of a text, brackets among them; `None` where they are none.
pub fn words(text: &str) -> Option<Vec<String>> {
    let mut words = Vec::new();
    flatten(text.parse().ok()?, &mut words);
    Some(words)
}

fn flatten(tokens: TokenStream, words: &mut Vec<String>) {
    let mut is_glued = false;
    for token in tokens {
        match token {
            TokenTree::Group(group) => {
                let (open, close) = match group.delimiter() {
                    Delimiter::Parenthesis => ("(", ")"),
                    Delimiter::Brace => ("{", "}"),
                    Delimiter::Bracket => ("[", "]"),
                    Delimiter::None => ("", ""),
                };
                words.push(open.into());
                flatten(group.stream(), words);
                words.push(close.into());
                is_glued = false;
            }
            other => {
                let glues = matches!(&other, TokenTree::Punct(mark) if mark.spacing() == Spacing::Joint);
                match words.last_mut().filter(|_| is_glued) {
                    Some(last) => *last += &other.to_string(),
                    None => words.push(other.to_string()),
                }
                is_glued = glues;
            }
        }
    }
}
