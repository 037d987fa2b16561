//! Printing: Unicode for doc comments and terminals, LaTeX for papers.

mod parts;
mod product;

use std::cell::Cell;
use std::fmt;

use product::Factor;
pub use product::Product;

use crate::node::{Analytic, ExprNode, Function, Id, Operation, Term};
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

    fn enclosed(self, text: &str, unicode: [&str; 2], latex: [&str; 2]) -> String {
        let [open, close] = self.either(unicode, latex);
        format!("{open}{text}{close}")
    }

    fn parenthesized(self, text: &str) -> String {
        self.enclosed(text, ["(", ")"], ["\\left(", "\\right)"])
    }

    fn joined(self, factors: &[String]) -> String {
        factors.join(self.either("·", "\\,"))
    }

    /// An operand with something above it: in Unicode behind it. In LaTeX a base that has an exponent already stands in braces, as
    /// it knows no second one.
    fn raised(self, base: &str, unicode: &str, latex: &str) -> String {
        let is_raised = base.contains('^') && !base.ends_with("\\right)");
        match self {
            Notation::Unicode => format!("{base}{unicode}"),
            Notation::Latex if is_raised => format!("{{{base}}}^{{{latex}}}"),
            Notation::Latex => format!("{base}^{{{latex}}}"),
        }
    }
}

/// How tightly the outermost operation binds.
#[derive(Copy, Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
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

/// In greater powers a sum keeps its common factors.
const MOST_SPLIT: i64 = 8;

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
        self.node(id).at(place, self.notation)
    }

    /// The text of a node.
    fn node(&self, id: Id) -> Factor {
        self.product(id, true).as_factor(self.notation)
    }

    /// A node as a product. Common factors of the terms of a sum stand in front of it, and in front of linear operations on it.
    /// A common number of a sum that `is_open`, without brackets around it, stays in its terms.
    fn product(&self, id: Id, is_open: bool) -> Product {
        if let Some(name) = self.names.get(&id) {
            return self.factor(id, Factor::atom(name.clone()));
        }
        self.left.set(self.left.get().saturating_sub(1));
        if self.left.get() == 0 {
            return self.factor(id, Factor::atom(String::new()));
        }
        let shape = self.graph.shape(id);
        let product = match &*self.graph.node(id) {
            ExprNode::Sum(terms) => Product::sum(terms.each(|term| self.term(term, shape)), self.notation, is_open),
            ExprNode::Word(word) => self.applied(id, self.word(word), |word| word),
            ExprNode::Trace(word) => self.applied(id, self.word(word), |word| {
                let name = self.notation.either("tr", "\\operatorname{tr}");
                Factor::atom(name.to_string() + &self.notation.parenthesized(&word.text))
            }),
            ExprNode::Hadamard(a, b) => self.hadamard(id, [*a, *b]),
            // a scalar has no matrix factor
            ExprNode::Of(operation, a) if operation.is_linear() && !self.graph.shape(*a).is_scalar() => {
                self.applied(id, self.product(*a, false), |operand| self.operation(*operation, operand, *a, shape))
            }
            ExprNode::Of(operation, a) => self.factor(id, self.operation(*operation, self.node(*a), *a, shape)),
            node => self.factor(id, self.atom(node, shape)),
        };
        // an expression in several places is printed in each
        work::spend(1 + product.length() / 64);
        product
    }

    fn factor(&self, id: Id, factor: Factor) -> Product {
        Product::factor(factor, self.graph.shape(id).is_scalar())
    }

    /// A linear operation on a product, behind its scalars. `write` has its matrix factors.
    fn applied(&self, id: Id, operand: Product, write: impl FnOnce(Factor) -> Factor) -> Product {
        let (mut product, letters) = operand.split();
        product.multiply(&self.factor(id, write(letters.as_factor(self.notation))));
        product
    }

    fn hadamard(&self, id: Id, factors: [Id; 2]) -> Product {
        let [(mut product, a), (scalars, b)] = both(factors, |factor| self.product(factor, false).split());
        product.multiply(&scalars);
        let [a, b] = both([a, b], |factor| factor.as_factor(self.notation).at(Binding::Atom, self.notation));
        let text = a + self.notation.either(" ∘ ", " \\circ ") + &b;
        product.multiply(&self.factor(id, Factor { binding: Binding::Sum, ..Factor::atom(text) }));
        product
    }

    /// A product of matrices.
    fn word(&self, word: &[Id]) -> Product {
        word.iter().fold(Product::number(Rational::one()), |mut product, letter| {
            product.multiply(&self.product(*letter, false));
            product
        })
    }

    fn term(&self, term: &Term, shape: Shape) -> Product {
        let mut product = Product::number(term.coefficient.clone());
        for &(base, exponent) in &term.scalars {
            if exponent.is_integer() && exponent.parts().0.abs() <= MOST_SPLIT {
                product.multiply_by_power(&self.product(base, false), exponent);
            } else {
                product.multiply_power(&self.node(base), exponent);
            }
        }
        product.multiply(&self.word(&term.word));
        if term.word.is_empty() && !shape.is_scalar() {
            product.multiply(&Product::factor(Factor::atom("I".into()), false));
        }
        product
    }

    /// A node that is no sum, no product and no operation.
    fn atom(&self, node: &ExprNode, shape: Shape) -> Factor {
        Factor::atom(match node {
            ExprNode::Symbol(symbol) => return Factor { is_name: true, ..Factor::atom(self.symbol(&symbol.name)) },
            ExprNode::Literal(entries) => self.rows(shape, entries.each(|entry| self.rational(entry))),
            ExprNode::Stack(entries) => self.rows(shape, self.all(entries)),
            ExprNode::Opaque(name, output, arguments) => {
                let name = self.symbol(name);
                let number = if arguments.len() > 1 { output.to_string() } else { String::new() };
                let nabla = self.notation.either("∇", "\\nabla ");
                let name = if *output == 0 { name } else { format!("{nabla}{number}{name}") };
                format!("{name}({})", self.all(arguments).join(", "))
            }
            _ => self.notation.either("π", "\\pi").into(),
        })
    }

    /// An operation on an operand of this shape.
    fn operation(&self, operation: Operation, operand: Factor, a: Id, shape: Shape) -> Factor {
        let raised = |unicode: &str, latex: &str| {
            Factor::atom(self.notation.raised(&operand.at(Binding::Atom, self.notation), unicode, latex))
        };
        let inner = &operand.text;
        let (unicode, latex) = match operation {
            Operation::Transpose => return raised("ᵀ", "\\mathsf T"),
            Operation::Inverse => return raised("⁻¹", "-1"),
            Operation::Wedge(_) => return raised("^", "\\wedge"),
            Operation::Components(_) => {
                return Factor::atom(self.notation.enclosed(inner, ["⟨", ", E⟩"], ["\\langle ", ", E \\rangle"]));
            }
            Operation::Block(row, column) => return self.block(&operand, (row, column), self.graph.shape(a), shape),
            Operation::Embed(row, column) => {
                let name = self.notation.either("embed", "\\operatorname{embed}");
                return Factor::atom(format!("{name}({inner}, {row}, {column})"));
            }
            Operation::Function(Function::Stumpff(k)) => {
                let unicode = format!("c{}", in_digits(k.into(), "₋₀₁₂₃₄₅₆₇₈₉"));
                (unicode, format!("c_{{{k}}}"))
            }
            Operation::Function(function) => (function.name(), format!("\\{}", function.name())),
            Operation::Determinant => ("det".into(), "\\det".into()),
            Operation::Analytic(Analytic::Exponential) => ("exp".into(), "\\exp".into()),
            Operation::Analytic(Analytic::Phi) => ("φ".into(), "\\varphi".into()),
            Operation::Analytic(Analytic::Logarithm | Analytic::MotionLogarithm) => ("log".into(), "\\log".into()),
            Operation::DiagonalMatrix => ("diag".into(), "\\operatorname{diag}".into()),
            Operation::Diagonal => ("diagonal".into(), "\\operatorname{diagonal}".into()),
        };
        Factor::atom(self.notation.either(unicode, latex) + &self.notation.parenthesized(inner))
    }

    fn all(&self, ids: &[Id]) -> Vec<String> {
        ids.each(|id| self.print(*id, Binding::Sum))
    }

    fn symbol(&self, name: &str) -> String {
        if self.notation == Notation::Latex { latex_name(name) } else { name.to_string() }
    }

    fn rows(&self, shape: Shape, entries: Vec<String>) -> String {
        let rows: Vec<String> =
            entries.chunks(shape.columns).map(|row| row.join(self.notation.either(", ", " & "))).into_list();
        let text = rows.join(self.notation.either("; ", " \\\\ "));
        self.notation.enclosed(&text, ["[", "]"], ["\\begin{pmatrix}", "\\end{pmatrix}"])
    }

    /// A block of an operand that has the shape `of`.
    fn block(&self, operand: &Factor, (row, column): (usize, usize), of: Shape, shape: Shape) -> Factor {
        let range = |start: usize, length: usize| {
            if length == 1 { start.to_string() } else { format!("{start}..{}", start + length) }
        };
        let mut index = range(row, shape.rows);
        if !of.is_column() {
            index = format!("{index}, {}", range(column, shape.columns));
        }
        let base = operand.at(Binding::Atom, self.notation);
        // LaTeX knows no second subscript
        let is_lowered = self.notation == Notation::Latex && base.contains('_') && !base.ends_with("\\right)");
        let base = if is_lowered { format!("{{{base}}}") } else { base };
        let text = base + &self.notation.enclosed(&index, ["[", "]"], ["_{", "}"]);
        Factor { is_name: operand.is_name, ..Factor::atom(text) }
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
