//! Names of constants from their formulas: `half_h_weight_center_2`, `two_per_h_of_mass_matrix_11_plus_22`.
//!
//! Factors follow one another, and those below a fraction bar follow `per`. The factors of a sum stand before `of`. A
//! sum of entries of one field names the field once.

use clebsch_symbolic::{Elements, IntoList, Rational, Role, integer, work};

use super::scalar::{Factors, add as add_to};
use super::{Callee, Hoisted, Input, Scalar, ScalarNode, Scalars};

const LONGEST_NAME: usize = 48;

/// A distinct identifier for each constant, `k7` where the name would be too long.
pub fn constants(scalars: &Scalars, hoisted: &Hoisted) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for (index, (scalar, is_negative)) in hoisted.kept().enumerate() {
        let name = scalars.name(scalar, is_negative).filter(|name| is_short(name));
        let name = name.unwrap_or_else(|| format!("k{index}"));
        names.push(distinct(name, &names));
    }
    names
}

fn is_short(name: &str) -> bool {
    // terms that cancel have no name: a − a is nothing
    !name.is_empty() && name.len() <= LONGEST_NAME && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// A name that no other constant has, and no other name in scope.
fn distinct(name: String, names: &[String]) -> String {
    let is_taken = |name: &String| {
        let is_beside = ["orientation", "free_rotation"].iter().any(|other| name.starts_with(other));
        is_beside || ["step_size", "inertia_inverse"].contains(&name.as_str()) || names.contains(name)
    };
    let suffixed = ('b'..='z').map(|letter| format!("{name}_{letter}"));
    let numbered = (names.len()..).map(|number| format!("k{number}"));
    // by construction: of so many names one is free
    [name.clone()].into_iter().chain(suffixed).chain(numbered).find(|name| !is_taken(name)).unwrap_or(name)
}

/// A factor of a sum with its sign and its other factors.
type Term = (Rational, Factors);

impl Scalars {
    /// The name of a value or of its negative; `None` where there is no short one.
    fn name(&self, scalar: Scalar, is_negative: bool) -> Option<String> {
        work::spend(200);
        if let Some((_, name)) = self.names.iter().find(|(other, _)| *other == scalar) {
            return Some(if is_negative { format!("minus_{name}") } else { name.clone() });
        }
        let sign = integer(if is_negative { -1 } else { 1 });
        let name = match self.node(scalar) {
            ScalarNode::Sum(constant, terms) => {
                let term = |(term, weight): &(Scalar, Rational)| (weight * &sign, self.factors(*term));
                self.name_of_sum(constant * &sign, terms.each(term))
            }
            _ => self.name_of_product(&sign, &self.factors(scalar)),
        };
        name.filter(|name| is_short(name))
    }

    /// The terms with the sums in them multiplied out, where that leaves fewer: (a + b + c)/h − b/h − c/h is a/h.
    fn multiplied_out(&self, constant: &Rational, terms: &[Term]) -> Option<(Rational, Vec<Term>)> {
        let mut constant = constant.clone();
        let mut parts: Vec<Term> = Vec::new();
        let mut add = |weight: Rational, factors: Factors| match parts.iter_mut().find(|(_, other)| *other == factors) {
            _ if factors.is_empty() => constant += weight,
            Some((sum, _)) => *sum += weight,
            None => parts.push((weight, factors)),
        };
        for (weight, factors) in terms {
            let sum = factors.iter().enumerate().find_map(|(position, (base, power))| match self.node(*base) {
                ScalarNode::Sum(inner, terms) if *power == 1 => Some((position, inner, terms)),
                _ => None,
            });
            let Some((position, inner, terms)) = sum else {
                add(weight.clone(), factors.clone());
                continue;
            };
            let mut others = factors.clone();
            others.remove(position);
            if !inner.is_zero() {
                add(weight * inner, others.clone());
            }
            for (term, inner) in terms {
                let mut factors = others.clone();
                for (base, power) in self.factors(*term) {
                    add_to(&mut factors, base, power);
                }
                add(weight * inner, factors);
            }
        }
        parts.retain(|(weight, _)| !weight.is_zero());
        (parts.len() < terms.len()).then_some((constant, parts))
    }

    /// The common factor of all terms, `of` their sum without it.
    fn name_of_sum(&self, constant: Rational, terms: Vec<Term>) -> Option<String> {
        let (constant, terms) = self.multiplied_out(&constant, &terms).unwrap_or((constant, terms));
        let (Some((weight, factors)), true) = (terms.first(), constant.is_zero()) else {
            return self.joined(constant, &terms);
        };
        if terms.len() == 1 {
            return self.name_of_product(weight, factors);
        }
        let size = weight.abs();
        let size = if terms.iter().all(|(weight, _)| weight.abs() == size) { size } else { integer(1) };
        let in_all = |base: Scalar| {
            let power =
                |factors: &Factors| factors.iter().find(|(other, _)| *other == base).map_or(0, |(_, power)| *power);
            terms.iter().map(|(_, factors)| power(factors)).min().unwrap_or(0)
        };
        let common = factors.iter().map(|&(base, _)| (base, in_all(base))).filter(|(_, power)| *power > 0);
        let common: Factors = common.into_list();
        let rest = |(weight, factors): &Term| {
            let left = factors.iter().map(|&(base, power)| (base, power - in_all(base)));
            (weight / &size, left.filter(|(_, power)| *power > 0).into_list())
        };
        let rest = self.joined(constant, &terms.each(rest))?;
        if size.is_one() && common.is_empty() {
            Some(rest)
        } else {
            Some(format!("{}_of_{rest}", self.name_of_product(&size, &common)?))
        }
    }

    /// `a_plus_b_minus_c`, those that are added first.
    fn joined(&self, constant: Rational, terms: &[Term]) -> Option<String> {
        let mut terms = terms.to_vec();
        if !constant.is_zero() {
            terms.insert(0, (constant, Vec::new()));
        }
        terms.sort_by_key(|(weight, _)| weight.is_negative());
        let (mut name, mut field) = (String::new(), None);
        for (weight, factors) in &terms {
            name += match (name.is_empty(), weight.is_negative()) {
                (true, false) => "",
                (true, true) => "minus_",
                (false, false) => "_plus_",
                (false, true) => "_minus_",
            };
            let entry = match factors.as_slice() {
                [(only, 1)] if weight.abs().is_one() => self.name_of_entry(*only),
                _ => None,
            };
            name += &match &entry {
                Some((base, index)) if field.as_ref() == Some(base) => index.clone(),
                _ => self.name_of_product(&weight.abs(), factors)?,
            };
            field = entry.map(|(base, _)| base);
            if name.len() > LONGEST_NAME {
                return None;
            }
        }
        Some(name)
    }

    /// The field and the index of an entry of a field that has several.
    fn name_of_entry(&self, scalar: Scalar) -> Option<(String, String)> {
        match self.node(scalar) {
            ScalarNode::Input(input) if input.role != Role::StepSize && !self.is_single(input) => {
                Some((field(input), index(input)))
            }
            _ => None,
        }
    }

    fn name_of_product(&self, weight: &Rational, factors: &Factors) -> Option<String> {
        let mut words = Vec::new();
        if weight.is_negative() {
            words.push("minus".to_string());
        }
        if !weight.abs().is_one() || factors.is_empty() {
            words.push(numeral(&weight.abs())?);
        }
        let (mut sums, mut below) = (Vec::new(), Vec::new());
        for &(base, power) in factors {
            match self.node(base) {
                ScalarNode::Reciprocal(x) => {
                    let inner = self.factors(*x);
                    below.extend(inner.into_iter().map(|(base, inner)| (base, inner * power)));
                }
                ScalarNode::Sum(..) if power == 1 => sums.push(self.name_of_base(base)?),
                _ => words.push(self.name_of_power(base, power)?),
            }
        }
        if !below.is_empty() {
            let names: Option<Vec<String>> =
                below.into_iter().map(|(base, power)| self.name_of_power(base, power)).collect();
            words.push(format!("per_{}", names?.join("_")));
        }
        if !sums.is_empty() {
            let sums = sums.join("_times_");
            words.push(if words.is_empty() { sums } else { format!("of_{sums}") });
        }
        Some(words.join("_"))
    }

    fn name_of_power(&self, base: Scalar, power: u32) -> Option<String> {
        let name = self.name_of_base(base)?;
        Some(match power {
            1 => name,
            2 => format!("{name}_squared"),
            3 => format!("{name}_cubed"),
            _ => format!("{name}_to_{power}"),
        })
    }

    /// The name of an expression that is no product.
    fn name_of_base(&self, scalar: Scalar) -> Option<String> {
        match self.node(scalar) {
            ScalarNode::Input(input) if input.role == Role::StepSize => Some("h".into()),
            ScalarNode::Input(input) if self.is_single(input) => Some(field(input)),
            ScalarNode::Input(input) => Some(format!("{}_{}", field(input), index(input))),
            ScalarNode::Pi => Some("pi".into()),
            ScalarNode::Root(x, (1, 2)) => Some(format!("root_of_{}", self.name(*x, false)?)),
            ScalarNode::Root(x, (numerator, denominator)) => {
                Some(format!("{}_to_{numerator}_over_{denominator}", self.name(*x, false)?))
            }
            ScalarNode::Function(function, x) => Some(format!("{}_of_{}", function.name(), self.name(*x, false)?)),
            ScalarNode::Output(call, output) => {
                let (callee, _) = self.call_of(*call);
                let is_ours = !matches!(callee, Callee::Value(_) | Callee::Gradient(_));
                is_ours.then(|| format!("{callee}_{}{}", output.row, output.column))
            }
            ScalarNode::Sum(..) | ScalarNode::Product(_) | ScalarNode::Reciprocal(_) => self.name(scalar, false),
        }
    }

    /// Whether an input has no other entries that are read.
    fn is_single(&self, input: &Input) -> bool {
        input.shape.is_column() && input.row == 0 && !self.has_other_entries(input)
    }
}

fn field(input: &Input) -> String {
    let name = input.name.replace(['[', '.'], "_").replace(']', "").to_lowercase();
    if name.starts_with(|first: char| first.is_ascii_digit()) { format!("field_{name}") } else { name }
}

fn index(input: &Input) -> String {
    if input.shape.is_column() { input.row.to_string() } else { format!("{}{}", input.row, input.column) }
}

/// `half`, `two`, `three_quarters`.
fn numeral(value: &Rational) -> Option<String> {
    const WHOLE: [&str; 17] = [
        "zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve",
        "thirteen", "fourteen", "fifteen", "sixteen",
    ];
    let part = [
        (2, "half"),
        (3, "third"),
        (4, "quarter"),
        (5, "fifth"),
        (6, "sixth"),
        (8, "eighth"),
        (12, "twelfth"),
        (16, "sixteenth"),
        (32, "thirty_second"),
        (64, "sixty_fourth"),
    ];
    let (numerator, denominator) = value.parts()?;
    let whole = || WHOLE.get(usize::try_from(numerator).ok()?).map(|word| (*word).to_string());
    let part = || part.iter().find(|(number, _)| *number == denominator).map(|(_, word)| *word);
    match (numerator, denominator) {
        (_, 1) => whole(),
        (1, _) => part().map(str::to_string),
        (_, 2) => Some(format!("{}_halves", whole()?)),
        _ => Some(format!("{}_{}s", whole()?, part()?)),
    }
}
