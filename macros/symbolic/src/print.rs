//! Printing: Unicode for doc comments and terminals, LaTeX for papers.

mod parts;

use std::cell::Cell;
use std::fmt;

use crate::node::{Analytic, Exponent, ExprNode, Function, Id, Operation, Term};
use crate::{Elements, Expr, Graph, IntoList, Rational, Shape, Table, both, work};

/// A notation of formulas.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum Notation {
    /// For doc comments and terminals.
    Unicode,
    /// For papers.
    Latex,
}

impl Notation {
    /// The text in this notation.
    pub fn either<T>(self, unicode: T, latex: T) -> T {
        if self == Notation::Latex { latex } else { unicode }
    }
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
        f.write_str(&self.written(Notation::Unicode))
    }
}

impl Expr<'_> {
    /// The formula in a notation.
    pub fn written(self, notation: Notation) -> String {
        Printer::new(self.graph, notation, usize::MAX).print(self.id, Binding::Sum)
    }

    /// The formula in a notation; `None` where it has more characters than these.
    pub fn written_within(self, notation: Notation, most: usize) -> Option<String> {
        let printer = Printer::new(self.graph, notation, most);
        let text = printer.print(self.id, Binding::Sum);
        (printer.left.get() > 0 && text.chars().count() <= most).then_some(text)
    }
}

struct Printer<'g> {
    graph: &'g Graph,
    notation: Notation,
    /// How many nodes may be printed yet. Each of them takes a character at least.
    left: Cell<usize>,
    /// The names of the parts that are written elsewhere.
    names: Table<Id, String>,
}

impl<'g> Printer<'g> {
    fn new(graph: &'g Graph, notation: Notation, most: usize) -> Printer<'g> {
        Printer { graph, notation, left: Cell::new(most), names: Table::default() }
    }

    /// The text of a node, in parentheses if it binds less tightly than its place asks.
    fn print(&self, id: Id, place: Binding) -> String {
        if let Some(name) = self.names.get(&id) {
            return name.clone();
        }
        self.left.set(self.left.get().saturating_sub(1));
        if self.left.get() == 0 {
            return String::new();
        }
        let (text, binding) = self.node(id);
        // an expression in several places is printed in each
        work::spend(1 + text.len() / 64);
        if binding < place { self.parenthesized(&text) } else { text }
    }

    fn enclosed(&self, text: &str, unicode: [&str; 2], latex: [&str; 2]) -> String {
        let [open, close] = self.notation.either(unicode, latex);
        format!("{open}{text}{close}")
    }

    fn parenthesized(&self, text: &str) -> String {
        self.enclosed(text, ["(", ")"], ["\\left(", "\\right)"])
    }

    fn node(&self, id: Id) -> (String, Binding) {
        let shape = self.graph.shape(id);
        let text = match &*self.graph.node(id) {
            ExprNode::Symbol(symbol) => self.symbol(&symbol.name),
            ExprNode::Pi => self.notation.either("π", "\\pi").into(),
            ExprNode::Sum(terms) => return self.sum(terms, shape),
            ExprNode::Literal(entries) => self.rows(shape, entries.each(|entry| self.rational(entry))),
            ExprNode::Stack(entries) => self.rows(shape, self.all(entries)),
            ExprNode::Word(word) => return (self.word(word), Binding::Product),
            ExprNode::Trace(word) => {
                self.notation.either("tr", "\\operatorname{tr}").to_string() + &self.parenthesized(&self.word(word))
            }
            ExprNode::Opaque(name, output, arguments) => {
                let name = self.symbol(name);
                let number = if arguments.len() > 1 { output.to_string() } else { String::new() };
                let nabla = self.notation.either("∇", "\\nabla ");
                let name = if *output == 0 { name } else { format!("{nabla}{number}{name}") };
                format!("{name}({})", self.all(arguments).join(", "))
            }
            ExprNode::Hadamard(a, b) => {
                let [a, b] = both([a, b], |factor| self.print(*factor, Binding::Atom));
                return (a + self.notation.either(" ∘ ", " \\circ ") + &b, Binding::Sum);
            }
            ExprNode::Of(operation, a) => self.operation(*operation, *a, shape),
        };
        (text, Binding::Atom)
    }

    fn operation(&self, operation: Operation, a: Id, shape: Shape) -> String {
        let inner = || self.print(a, Binding::Sum);
        let (unicode, latex) = match operation {
            Operation::Transpose => return self.raised(a, "ᵀ", "\\mathsf T"),
            Operation::Inverse => return self.raised(a, "⁻¹", "-1"),
            Operation::Wedge(_) => return self.raised(a, "^", "\\wedge"),
            Operation::Components(_) => return self.enclosed(&inner(), ["⟨", ", E⟩"], ["\\langle ", ", E \\rangle"]),
            Operation::Block(row, column) => return self.block(a, row, column, shape),
            Operation::Embed(row, column) => {
                let name = self.notation.either("embed", "\\operatorname{embed}");
                return format!("{name}({}, {row}, {column})", inner());
            }
            Operation::Function(Function::Stumpff(k)) => {
                let unicode = format!("c{}", in_digits(k.into(), "₋₀₁₂₃₄₅₆₇₈₉"));
                return self.notation.either(unicode, format!("c_{{{k}}}")) + &self.parenthesized(&inner());
            }
            Operation::Function(function) => {
                return self.notation.either("", "\\").to_string() + &function.name() + &self.parenthesized(&inner());
            }
            Operation::Determinant => ("det", "\\det"),
            Operation::Analytic(Analytic::Exponential) => ("exp", "\\exp"),
            Operation::Analytic(Analytic::Phi) => ("φ", "\\varphi"),
            Operation::Analytic(Analytic::Logarithm | Analytic::MotionLogarithm) => ("log", "\\log"),
            Operation::DiagonalMatrix => ("diag", "\\operatorname{diag}"),
            Operation::Diagonal => ("diagonal", "\\operatorname{diagonal}"),
        };
        self.notation.either(unicode, latex).to_string() + &self.parenthesized(&inner())
    }

    fn all(&self, ids: &[Id]) -> Vec<String> {
        ids.each(|id| self.print(*id, Binding::Sum))
    }

    fn symbol(&self, name: &str) -> String {
        if self.notation == Notation::Latex { latex_name(name) } else { name.to_string() }
    }

    /// An operand with something above it: in Unicode behind it. In LaTeX a base that has an exponent already stands in braces, as
    /// it knows no second one.
    fn raised(&self, operand: Id, unicode: &str, latex: &str) -> String {
        let base = self.print(operand, Binding::Atom);
        let is_raised = base.contains('^') && !base.ends_with("\\right)");
        match self.notation {
            Notation::Unicode => base + unicode,
            Notation::Latex if is_raised => format!("{{{base}}}^{{{latex}}}"),
            Notation::Latex => format!("{base}^{{{latex}}}"),
        }
    }

    fn rows(&self, shape: Shape, entries: Vec<String>) -> String {
        let rows: Vec<String> =
            entries.chunks(shape.columns).map(|row| row.join(self.notation.either(", ", " & "))).into_list();
        let text = rows.join(self.notation.either("; ", " \\\\ "));
        self.enclosed(&text, ["[", "]"], ["\\begin{pmatrix}", "\\end{pmatrix}"])
    }

    fn block(&self, inner: Id, row: usize, column: usize, shape: Shape) -> String {
        let range = |start: usize, length: usize| {
            if length == 1 { start.to_string() } else { format!("{start}..{}", start + length) }
        };
        let mut index = range(row, shape.rows);
        if !self.graph.shape(inner).is_column() {
            index = format!("{index}, {}", range(column, shape.columns));
        }
        let base = self.print(inner, Binding::Atom);
        // LaTeX knows no second subscript
        let is_lowered = self.notation == Notation::Latex && base.contains('_') && !base.ends_with("\\right)");
        let base = if is_lowered { format!("{{{base}}}") } else { base };
        base + &self.enclosed(&index, ["[", "]"], ["_{", "}"])
    }

    /// Positive terms first, plain numbers and identities last.
    fn sum(&self, terms: &[Term], shape: Shape) -> (String, Binding) {
        if terms.is_empty() {
            return ("0".into(), Binding::Atom);
        }
        let constant = |term: &&Term| term.word.is_empty() && term.scalars.is_empty();
        let mut ordered: Vec<&Term> = terms.iter().into_list();
        ordered.sort_by_key(|term| (term.coefficient.is_negative(), constant(term)));
        let signed = ordered.into_iter().map(|term| (term.coefficient.is_negative(), self.term(term, shape)));
        // names may hold signs too
        let text = joined(signed, '−').replace('−', self.notation.either("−", "-"));
        let binding =
            if terms.len() > 1 || terms[0].coefficient.is_negative() { Binding::Sum } else { Binding::Product };
        (text, binding)
    }

    /// The absolute value of a term: numerator over denominator.
    fn term(&self, term: &Term, shape: Shape) -> String {
        let (mut above, mut below) = (Vec::new(), Vec::new());
        let coefficient = term.coefficient.abs();
        for &(base, exponent) in &term.scalars {
            if exponent.is_negative() {
                below.push(self.scalar_power(base, -exponent));
            } else {
                above.push(self.scalar_power(base, exponent));
            }
        }
        if !term.word.is_empty() {
            above.push(self.word(&term.word));
        } else if !shape.is_scalar() {
            above.push("I".into());
        }
        if !coefficient.numer().is_one() || above.is_empty() {
            above.insert(0, coefficient.numer().to_string());
        }
        if !coefficient.denom().is_one() {
            below.insert(0, coefficient.denom().to_string());
        }
        let (above, factors, below) = (self.join(&above), below.len(), self.join(&below));
        match factors {
            0 => above,
            _ if self.notation == Notation::Latex => format!("\\frac{{{above}}}{{{below}}}"),
            1 => format!("{above}/{below}"),
            _ => format!("{above}/({below})"),
        }
    }

    fn join(&self, factors: &[String]) -> String {
        factors.join(self.notation.either("·", "\\,"))
    }

    fn scalar_power(&self, base: Id, exponent: Exponent) -> String {
        if exponent.parts() == (1, 2) {
            return self.enclosed(&self.print(base, Binding::Sum), ["√(", ")"], ["\\sqrt{", "}"]);
        }
        if exponent.is_one() {
            return self.print(base, Binding::Product);
        }
        let in_unicode = match exponent.parts() {
            (whole, 1) => in_digits(whole, "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"),
            _ => format!("^({exponent})"),
        };
        self.raised(base, &in_unicode, &exponent.to_string())
    }

    fn word(&self, word: &[Id]) -> String {
        let letters: Vec<String> = word.each(|&letter| self.print(letter, Binding::Product));
        self.join(&letters)
    }

    fn rational(&self, value: &Rational) -> String {
        value.to_string().replace('-', self.notation.either("−", "-"))
    }
}

/// Terms, the negative ones by their sizes, as a sum: `a + b − c`.
pub fn joined(terms: impl Iterator<Item = (bool, String)>, minus: char) -> String {
    terms.fold(String::new(), |sum, (is_negative, term)| match (sum.is_empty(), is_negative) {
        (true, false) => term,
        (true, true) => format!("{minus}{term}"),
        (false, false) => format!("{sum} + {term}"),
        (false, true) => format!("{sum} {minus} {term}"),
    })
}

/// A name in LaTeX: Greek letters by their names, subscript digits as subscripts, words upright.
fn latex_name(name: &str) -> String {
    let names =
        ["xi", "eta", "zeta", "mu", "nu", "lambda", "delta", "varepsilon", "gamma", "alpha", "beta", "Delta", "Sigma"];
    if let Some(before) = name.strip_suffix('⁺') {
        return format!("{}^+", latex_name(before));
    }
    let (digits, base): (String, String) = name.chars().partition(|c| ('₀'..='₉').contains(c));
    let digits: String = digits.chars().filter_map(|c| char::from_u32(c as u32 - '₀' as u32 + '0' as u32)).collect();
    let mut greek = "ξηζμνλδεγαβΔΣ".chars().zip(names);
    let letter = greek.find(|(c, _)| base == c.to_string()).map(|(_, name)| format!("\\{name}"));
    let text = letter.unwrap_or_else(|| match base.chars().count() {
        1 => base,
        _ => format!("\\mathrm{{{}}}", base.replace('_', "\\_").replace('%', "\\%")),
    });
    if digits.is_empty() { text } else { format!("{text}_{{{digits}}}") }
}

/// An integer in other characters: that for a minus sign, and those for the digits from zero on.
fn in_digits(value: i64, characters: &str) -> String {
    let place = |c: char| c.to_digit(10).map_or(0, |digit| 1 + digit as usize);
    value.to_string().chars().filter_map(|c| characters.chars().nth(place(c))).collect()
}
