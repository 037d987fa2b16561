//! Printing: Unicode for doc comments and terminals, LaTeX for papers.

use std::fmt;

use num_traits::One;

use crate::node::{Analytic, Exponent, ExprNode, Function, Id, Term};
use crate::{Expr, Graph, Rational, Shape, work};

/// How a formula is written.
#[derive(Copy, Clone, PartialEq, Eq)]
enum Style {
    Unicode,
    Latex,
}

/// How tightly the outermost operation binds.
#[derive(Copy, Clone, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Atom,
}

impl fmt::Display for Expr<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&Printer { graph: self.graph, style: Style::Unicode }.print(self.id, Binding::Sum))
    }
}

impl Expr<'_> {
    /// The formula in LaTeX.
    pub fn latex(self) -> String {
        Printer { graph: self.graph, style: Style::Latex }.print(self.id, Binding::Sum)
    }
}

struct Printer<'g> {
    graph: &'g Graph,
    style: Style,
}

impl Printer<'_> {
    /// The text of a node, in parentheses if it binds less tightly than its place asks.
    fn print(&self, id: Id, place: Binding) -> String {
        let (text, binding) = self.node(id);
        // what stands in several places is written out in each
        work::spend(1 + text.len() / 64);
        if binding < place { self.parenthesized(&text) } else { text }
    }

    fn parenthesized(&self, text: &str) -> String {
        match self.style {
            Style::Unicode => format!("({text})"),
            Style::Latex => format!("\\left({text}\\right)"),
        }
    }

    fn node(&self, id: Id) -> (String, Binding) {
        let atom = |text: String| (text, Binding::Atom);
        let call = |name: &str, inner: Id| {
            (format!("{name}{}", self.parenthesized(&self.print(inner, Binding::Sum))), Binding::Atom)
        };
        let latex = self.style == Style::Latex;
        match &*self.graph.node(id) {
            ExprNode::Symbol(symbol) => atom(self.symbol(&self.graph.symbol_data(*symbol).name)),
            ExprNode::Pi => atom(if latex { "\\pi".into() } else { "π".into() }),
            ExprNode::Sum(terms) => self.sum(terms, self.graph.shape(id)),
            ExprNode::Literal(entries) => {
                atom(self.rows(id, entries.iter().map(|entry| self.rational(entry)).collect()))
            }
            ExprNode::Stack(entries) => {
                atom(self.rows(id, entries.iter().map(|&entry| self.print(entry, Binding::Sum)).collect()))
            }
            ExprNode::Word(word) => (self.word(word), Binding::Product),
            ExprNode::Trace(word) => atom(format!(
                "{}{}",
                if latex { "\\operatorname{tr}" } else { "tr" },
                self.parenthesized(&self.word(word))
            )),
            ExprNode::Transpose(a) => atom(self.raised(*a, "ᵀ", "\\mathsf T")),
            ExprNode::Inverse(a) => atom(self.raised(*a, "⁻¹", "-1")),
            ExprNode::Determinant(a) => call(if latex { "\\det" } else { "det" }, *a),
            ExprNode::Function(Function::Stumpff(k), a) => call(&self.subscripted("c", *k), *a),
            ExprNode::Analytic(function, a) => call(
                match (function, latex) {
                    (Analytic::Exponential, true) => "\\exp",
                    (Analytic::Exponential, false) => "exp",
                    (Analytic::Phi, true) => "\\varphi",
                    (Analytic::Phi, false) => "φ",
                    (Analytic::Logarithm, true) => "\\log",
                    (Analytic::Logarithm, false) => "log",
                },
                *a,
            ),
            ExprNode::Opaque(name, output, arguments) => {
                let arguments: Vec<String> = arguments.iter().map(|&a| self.print(a, Binding::Sum)).collect();
                let name = self.symbol(&self.graph.opaque_name(*name));
                let nabla = if latex { "\\nabla " } else { "∇" };
                let number = if arguments.len() > 1 { output.to_string() } else { String::new() };
                let name = if *output == 0 { name } else { format!("{nabla}{number}{name}") };
                atom(format!("{name}({})", arguments.join(", ")))
            }
            ExprNode::Function(function, a) => {
                call(&format!("{}{}", if latex { "\\" } else { "" }, function.name()), *a)
            }
            ExprNode::Block(a, row, column) => atom(self.block(*a, *row, *column, self.graph.shape(id))),
            ExprNode::Embed(a, row, column) => {
                let name = if latex { "\\operatorname{embed}" } else { "embed" };
                atom(format!("{name}({}, {row}, {column})", self.print(*a, Binding::Sum)))
            }
            ExprNode::Hadamard(a, b) => {
                let symbol = if latex { " \\circ " } else { " ∘ " };
                (format!("{}{symbol}{}", self.print(*a, Binding::Atom), self.print(*b, Binding::Atom)), Binding::Sum)
            }
            ExprNode::DiagonalMatrix(a) => call(if latex { "\\operatorname{diag}" } else { "diag" }, *a),
            ExprNode::Diagonal(a) => call(if latex { "\\operatorname{diagonal}" } else { "diagonal" }, *a),
            ExprNode::Wedge(_, a) => atom(self.raised(*a, "^", "\\wedge")),
            ExprNode::Components(_, a) => {
                let inner = self.print(*a, Binding::Sum);
                atom(if latex { format!("\\langle {inner}, E \\rangle") } else { format!("⟨{inner}, E⟩") })
            }
        }
    }

    fn symbol(&self, name: &str) -> String {
        match self.style {
            Style::Unicode => name.to_string(),
            Style::Latex => latex_name(name),
        }
    }

    /// An operand with something above it: in Unicode behind it.
    fn raised(&self, operand: Id, unicode: &str, latex: &str) -> String {
        let base = self.print(operand, Binding::Atom);
        if self.style == Style::Latex { raised_in_latex(&base, latex) } else { base + unicode }
    }

    fn subscripted(&self, letter: &str, index: u8) -> String {
        match self.style {
            Style::Unicode => {
                let digit = |digit: u8| char::from_u32('₀' as u32 + u32::from(digit - b'0'));
                index
                    .to_string()
                    .bytes()
                    .filter_map(digit)
                    .fold(letter.to_string(), |text, digit| text + &digit.to_string())
            }
            Style::Latex => format!("{letter}_{{{index}}}"),
        }
    }

    fn rows(&self, id: Id, entries: Vec<String>) -> String {
        let columns = self.graph.shape(id).columns;
        let (within, between) = if self.style == Style::Latex { (" & ", " \\\\ ") } else { (", ", "; ") };
        let rows: Vec<String> = entries.chunks(columns).map(|row| row.join(within)).collect();
        match self.style {
            Style::Unicode => format!("[{}]", rows.join(between)),
            Style::Latex => format!("\\begin{{pmatrix}}{}\\end{{pmatrix}}", rows.join(between)),
        }
    }

    fn block(&self, inner: Id, row: usize, column: usize, shape: Shape) -> String {
        let range = |start: usize, length: usize| {
            if length == 1 { start.to_string() } else { format!("{start}..{}", start + length) }
        };
        let vector = self.graph.shape(inner).is_column();
        let index = match vector {
            true => range(row, shape.rows),
            false => format!("{}, {}", range(row, shape.rows), range(column, shape.columns)),
        };
        let matrix = self.print(inner, Binding::Atom);
        match self.style {
            Style::Unicode => format!("{matrix}[{index}]"),
            Style::Latex => format!("{matrix}_{{{index}}}"),
        }
    }

    /// Positive terms first, plain numbers and identities last.
    fn sum(&self, terms: &[Term], shape: Shape) -> (String, Binding) {
        if terms.is_empty() {
            return ("0".into(), Binding::Atom);
        }
        let constant = |term: &&Term| term.word.is_empty() && term.scalars.is_empty();
        let mut ordered: Vec<&Term> = terms.iter().collect();
        ordered.sort_by_key(|term| (term.coefficient.is_negative(), constant(term)));
        let mut text = String::new();
        for (position, term) in ordered.iter().enumerate() {
            let negative = term.coefficient.is_negative();
            text += match (position, negative) {
                (0, false) => "",
                (0, true) => "−",
                (_, false) => " + ",
                (_, true) => " − ",
            };
            text += &self.term(term, shape);
        }
        let binding =
            if terms.len() > 1 || terms[0].coefficient.is_negative() { Binding::Sum } else { Binding::Product };
        (self.minus(text), binding)
    }

    fn minus(&self, text: String) -> String {
        if self.style == Style::Latex { text.replace('−', "-") } else { text }
    }

    /// The absolute value of a term: numerator over denominator.
    fn term(&self, term: &Term, shape: Shape) -> String {
        let (mut above, mut below) = (Vec::new(), Vec::new());
        let coefficient = term.coefficient.abs();
        for &(base, exponent) in &term.scalars {
            match exponent.is_negative() {
                true => below.push(self.scalar_power(base, -exponent)),
                false => above.push(self.scalar_power(base, exponent)),
            }
        }
        match term.word.is_empty() {
            true if !shape.is_scalar() => above.push("I".into()),
            true => {}
            false => above.push(self.word(&term.word)),
        }
        if !coefficient.numer().is_one() || above.is_empty() {
            above.insert(0, coefficient.numer().to_string());
        }
        if !coefficient.denom().is_one() {
            below.insert(0, coefficient.denom().to_string());
        }
        match (self.style, below.len()) {
            (_, 0) => self.join(&above),
            (Style::Latex, _) => format!("\\frac{{{}}}{{{}}}", self.join(&above), self.join(&below)),
            (Style::Unicode, 1) => format!("{}/{}", self.join(&above), below[0]),
            (Style::Unicode, _) => format!("{}/({})", self.join(&above), self.join(&below)),
        }
    }

    fn join(&self, factors: &[String]) -> String {
        factors.join(if self.style == Style::Latex { "\\," } else { "·" })
    }

    fn scalar_power(&self, base: Id, exponent: Exponent) -> String {
        if exponent.parts() == (1, 2) {
            let inner = self.print(base, Binding::Sum);
            return if self.style == Style::Latex { format!("\\sqrt{{{inner}}}") } else { format!("√({inner})") };
        }
        if exponent.is_one() {
            return self.print(base, Binding::Product);
        }
        let base = self.print(base, Binding::Atom);
        match self.style {
            Style::Latex => raised_in_latex(&base, &exponent.to_string()),
            Style::Unicode => match exponent.as_integer() {
                Some(whole) => format!("{base}{}", superscript(whole)),
                None => format!("{base}^({exponent})"),
            },
        }
    }

    fn word(&self, word: &[Id]) -> String {
        let letters: Vec<String> = word.iter().map(|&letter| self.print(letter, Binding::Product)).collect();
        self.join(&letters)
    }

    fn rational(&self, value: &Rational) -> String {
        self.minus(value.to_string().replace('-', "−"))
    }
}

/// A base with an exponent; one that has an exponent already stands in braces, as LaTeX knows no second one.
fn raised_in_latex(base: &str, exponent: &str) -> String {
    let is_raised = base.contains('^') && !base.ends_with("\\right)");
    if is_raised { format!("{{{base}}}^{{{exponent}}}") } else { format!("{base}^{{{exponent}}}") }
}

/// A name in LaTeX: Greek letters by their names, subscript digits as subscripts, words upright.
fn latex_name(name: &str) -> String {
    let greek = [
        ('ξ', "\\xi"),
        ('η', "\\eta"),
        ('ζ', "\\zeta"),
        ('μ', "\\mu"),
        ('ν', "\\nu"),
        ('λ', "\\lambda"),
        ('δ', "\\delta"),
        ('ε', "\\varepsilon"),
        ('γ', "\\gamma"),
        ('α', "\\alpha"),
        ('β', "\\beta"),
        ('Δ', "\\Delta"),
        ('Σ', "\\Sigma"),
    ];
    if let Some(before) = name.strip_suffix('⁺') {
        return format!("{}^+", latex_name(before));
    }
    let is_subscript = |c: char| ('₀'..='₉').contains(&c);
    let base: String = name.chars().filter(|&c| !is_subscript(c)).collect();
    let digits: String = name
        .chars()
        .filter(|&c| is_subscript(c))
        .filter_map(|c| char::from_u32(c as u32 - '₀' as u32 + '0' as u32))
        .collect();
    let letter = greek.iter().find(|(c, _)| base == c.to_string()).map(|(_, text)| text.to_string());
    let text = letter.unwrap_or_else(|| match base.chars().count() {
        1 => base,
        _ => format!("\\mathrm{{{}}}", base.replace('_', "\\_").replace('%', "\\%")),
    });
    if digits.is_empty() { text } else { format!("{text}_{{{digits}}}") }
}

/// An integer in superscript digits.
fn superscript(value: i64) -> String {
    let digit = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        other => char::from_u32('⁰' as u32 + other.to_digit(10).unwrap_or(0)).unwrap_or(other),
    };
    value.to_string().chars().map(digit).collect()
}
