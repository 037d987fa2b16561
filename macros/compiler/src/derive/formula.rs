//! A formula: one row of the table, with its expressions; text is made of them when it is asked for.

use std::cell::OnceCell;
use std::fmt;

use clebsch_symbolic::{Elements, Expr, IntoList, Notation, Shape};

use super::{Entry, Id, Reference, latex};

/// A derived formula, `symbol = value`.
#[derive(Clone)]
pub struct Formula<'g> {
    /// Which it is.
    pub id: Id,
    /// Its name, in words.
    pub title: &'static str,
    /// The left side, `J(q, p)`.
    pub symbol: String,
    /// The expressions that are computed; one for each factor or leaf.
    pub value: Vec<Expr<'g>>,
    /// The right side of the print, if it differs from the computed expressions. For example F⁻¹ is written, and the
    /// inverse of its group is computed.
    pub(super) written: Option<Vec<Expr<'g>>>,
    /// Where it comes from.
    pub source: Option<Reference>,
    /// Whether prints and `DERIVATION` list it.
    pub(super) is_listed: bool,
    /// How the right side is written.
    pub(super) wording: Wording<'g>,
    /// Which of its expressions are said in the momentum μ of the free motion to F, with μ and F.
    pub(super) free: Vec<(usize, Expr<'g>, Expr<'g>)>,
    pub(super) text: OnceCell<Vec<String>>,
}

/// How the right side of a formula is written.
#[derive(Clone)]
pub(super) enum Wording<'g> {
    /// As its expressions are.
    AsIs,
    /// Each expression as it is or expanded, whichever is shorter.
    Shorter,
    /// In words: Unicode and LaTeX.
    Words(String, String),
    /// Each expression with a kick at this place, q⁺, added to it.
    AndKick(String, Vec<Expr<'g>>),
}

impl<'g> Formula<'g> {
    /// A formula that is written as its expressions are.
    pub(super) fn new(id: Id, symbol: impl Into<String>, value: impl Into<Vec<Expr<'g>>>) -> Formula<'g> {
        let Entry { title, source, is_listed, .. } = id.entry();
        Formula {
            id,
            title,
            symbol: symbol.into(),
            value: value.into(),
            written: None,
            source,
            is_listed,
            wording: Wording::AsIs,
            free: Vec::new(),
            text: OnceCell::new(),
        }
    }

    /// A formula whose expressions are written expanded where that is shorter.
    pub(super) fn shorter(id: Id, symbol: impl Into<String>, value: impl Into<Vec<Expr<'g>>>) -> Formula<'g> {
        Formula { wording: Wording::Shorter, ..Formula::new(id, symbol, value) }
    }

    /// The same formula with other expressions to compute than those in print.
    pub(super) fn computed_as(self, value: Vec<Expr<'g>>) -> Formula<'g> {
        if value == self.value { self } else { Formula { written: Some(self.value), value, ..self } }
    }

    pub(super) fn in_words(self, unicode: String, latex: String) -> Formula<'g> {
        Formula { wording: Wording::Words(unicode, latex), ..self }
    }

    /// The right side, one text for each factor or leaf.
    fn text(&self) -> &[String] {
        self.text.get_or_init(|| self.right_side(Notation::Unicode))
    }

    /// The shapes of the right sides.
    pub fn shapes(&self) -> Vec<Shape> {
        self.expressions().each(|value| value.shape())
    }

    /// The expressions in print.
    fn expressions(&self) -> &[Expr<'g>] {
        self.written.as_deref().unwrap_or(&self.value)
    }

    /// `symbol = expression`, tuples in parentheses.
    pub fn equation(&self) -> String {
        match self.text() {
            [only] => format!("{} = {only}", self.symbol),
            several => format!("{} = ({})", self.symbol, several.join(", ")),
        }
    }

    /// `symbol &= expression` in LaTeX, tuples in parentheses.
    fn equation_in_latex(&self) -> String {
        let symbol = match self.id {
            Id::Conserved(_) => format!("\\text{{{}}}", self.symbol),
            _ => latex::left_side(&self.symbol),
        };
        match self.right_side(Notation::Latex).as_slice() {
            [only] => format!("{symbol} &= {only}"),
            several => format!("{symbol} &= \\left({}\\right)", several.join(", ")),
        }
    }

    fn right_side(&self, notation: Notation) -> Vec<String> {
        let write = |value: Expr<'g>| without_embeddings(value).written(notation);
        let values = self.expressions().iter().copied();
        let mut written: Vec<String> = match &self.wording {
            Wording::AsIs => values.map(write).into_list(),
            Wording::Shorter => values.map(|value| write(shorter(value))).into_list(),
            Wording::Words(unicode, latex) => vec![notation.either(unicode, latex).clone()],
            Wording::AndKick(place, kicks) => {
                let with_kick = |(value, kick): (Expr<'g>, &Expr<'g>)| {
                    let (value, kick) = (write(value), shorter(*kick).written(notation));
                    let latex = format!("{value} + \\left[{kick}\\right]_{{{}}}", place.replace('⁺', "^+"));
                    notation.either(format!("{value} + [{kick}] at {place}"), latex)
                };
                values.zip(kicks).map(with_kick).into_list()
            }
        };
        for (k, mu, f) in &self.free {
            let (mu, f) = (mu.written(notation), f.written(notation));
            written[*k] += &notation.either(
                format!(", {mu} the momentum of the free motion from I to {f} in h, by less than half a turn"),
                format!(
                    ",\\quad {mu} \\text{{ the momentum of the free motion from }} I \\text{{ to }} {f} \\text{{ in }} h, \\text{{ by less than half a turn}}"
                ),
            );
        }
        written
    }
}

/// The formulas of a system, in the order of the derivation.
pub struct FormulaTable<'g>(Vec<Formula<'g>>);

impl<'g> FormulaTable<'g> {
    /// The table of these rows, without those that say nothing.
    pub(super) fn new(mut rows: Vec<Formula<'g>>) -> FormulaTable<'g> {
        rows.retain(|row| !row.value.is_empty());
        FormulaTable(rows)
    }

    /// All formulas.
    pub fn rows(&self) -> &[Formula<'g>] {
        &self.0
    }

    /// The formulas that prints and `DERIVATION` show: those that are listed, unless they say that something vanishes.
    pub fn listing(&self) -> impl Iterator<Item = &Formula<'g>> {
        self.0.iter().filter(|row| row.is_listed && row.text().iter().any(|text| text != "0"))
    }

    /// The formula with an id, or none where a system does not have it.
    pub fn titled(&self, id: Id) -> &[Formula<'g>] {
        self.titled_all(|other| other == id)
    }

    /// The right sides of a formula; `None` where a system does not have it.
    pub fn value(&self, id: Id) -> Option<&[Expr<'g>]> {
        self.titled(id).first().map(|row| row.value.as_slice())
    }

    /// The formulas whose ids are of a kind; they stand together in the table.
    pub fn titled_all(&self, is_meant: impl Fn(Id) -> bool) -> &[Formula<'g>] {
        self.titled_by(&is_meant)
    }

    fn titled_by(&self, is_meant: &dyn Fn(Id) -> bool) -> &[Formula<'g>] {
        let is_meant = |row: &Formula<'g>| is_meant(row.id);
        let Some(first) = self.0.iter().position(&is_meant) else { return &[] };
        let count = self.0[first..].iter().take_while(|row| is_meant(row)).count();
        &self.0[first..first + count]
    }

    /// The formulas that `DERIVATION` lists, in an `align*`.
    pub fn latex(&self) -> String {
        let mut rows = Vec::new();
        for formula in self.listing() {
            let title = if formula.title.is_empty() { String::new() } else { format!("% {}\n", formula.title) };
            rows.push(title + &formula.equation_in_latex());
        }
        format!("\\begin{{align*}}\n{}\n\\end{{align*}}\n", rows.join(" \\\\\n"))
    }
}

impl fmt::Display for FormulaTable<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.listing().try_for_each(|formula| writeln!(f, "{}", formula.to_string().trim_end()))
    }
}

impl fmt::Display for Formula<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<24} {}", self.title, self.equation())
    }
}

/// The expression with matrices of blocks multiplied block by block, where it has such and that is shorter.
fn without_embeddings(expression: Expr<'_>) -> Expr<'_> {
    let text = expression.to_string();
    if !text.contains("embed(") {
        return expression;
    }
    let blockwise = expression.expand().blockwise().expand();
    if blockwise.to_string().chars().count() < text.chars().count() { blockwise } else { expression }
}

/// An expression as it is or expanded, whichever is shorter.
fn shorter(expression: Expr<'_>) -> Expr<'_> {
    let length = |expression: &Expr<'_>| expression.to_string().chars().count();
    let expanded = expression.expand();
    if length(&expression) < length(&expanded) { expression } else { expanded }
}
