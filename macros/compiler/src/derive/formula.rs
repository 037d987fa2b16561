//! A formula: one row of the table, with its expressions; text is made of them when it is asked for.

use std::cell::OnceCell;
use std::fmt;

use clebsch_symbolic::{Expr, Shape};

use super::{Entry, Id, Reference, latex};

/// A derived formula, `symbol = value`.
#[derive(Clone)]
pub struct Formula<'g> {
    /// Which it is.
    pub id: Id,
    /// What it is, in words.
    pub title: &'static str,
    /// The left side, `J(q, p)`.
    pub symbol: String,
    /// What is computed; one expression for each factor or leaf.
    pub value: Vec<Expr<'g>>,
    /// What is written as the right side, where that is not what is computed: F⁻¹ is written, the inverse of its group computed.
    written: Option<Vec<Expr<'g>>>,
    /// Where it comes from.
    pub source: Option<Reference>,
    /// Whether prints and `DERIVATION` list it.
    pub(super) is_listed: bool,
    /// How the right side is written.
    wording: Wording<'g>,
    /// Which of its expressions are said in the momentum μ of the free motion to F, with μ and F.
    free: Vec<(usize, Expr<'g>, Expr<'g>)>,
    text: OnceCell<Vec<String>>,
}

/// How the right side of a formula is written.
#[derive(Clone)]
enum Wording<'g> {
    /// As its expressions are.
    AsIs,
    /// Each expression as it is or expanded, whichever is shorter.
    Shorter,
    /// In words: Unicode and LaTeX.
    Words(String, String),
    /// Each expression with a kick at this place added to it.
    AndKick(String, Vec<Expr<'g>>),
}

/// A notation of formulas.
#[derive(Copy, Clone, PartialEq, Eq)]
enum Notation {
    Unicode,
    Latex,
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

    /// The same formula, of which other expressions are computed than are written.
    pub(super) fn computed_as(self, value: Vec<Expr<'g>>) -> Formula<'g> {
        if value == self.value { self } else { Formula { written: Some(self.value), value, ..self } }
    }

    /// The same formula in words.
    pub(super) fn in_words(self, unicode: String, latex: String) -> Formula<'g> {
        Formula { wording: Wording::Words(unicode, latex), ..self }
    }

    /// The same formula with a kick at q⁺ added to its expressions.
    pub(super) fn and_kick(self, place: String, kick: &[Expr<'g>]) -> Formula<'g> {
        Formula { wording: Wording::AndKick(place, kick.to_vec()), ..self }
    }

    /// The same formula, some of whose expressions are said in the momentum μ of the free motion to F.
    pub(super) fn of_free_motions(self, free: Vec<(usize, Expr<'g>, Expr<'g>)>) -> Formula<'g> {
        Formula { free, ..self }
    }

    /// The same formula, with another title than that of the catalogue.
    pub(super) fn with_title(self, title: &'static str) -> Formula<'g> {
        Formula { title, ..self }
    }

    /// The same formula, which prints leave out if it is of no step.
    pub(super) fn listed_if(self, is_stepped: bool) -> Formula<'g> {
        Formula { is_listed: self.is_listed && is_stepped, ..self }
    }

    /// The right side, one text for each factor or leaf.
    pub fn text(&self) -> &[String] {
        self.text.get_or_init(|| self.written(Notation::Unicode))
    }

    /// The same in LaTeX.
    pub fn latex(&self) -> Vec<String> {
        self.written(Notation::Latex)
    }

    /// `symbol &= expression` in LaTeX, tuples in parentheses.
    pub(super) fn equation_in_latex(&self) -> String {
        let symbol = match self.id {
            Id::Conserved(_) => format!("\\text{{{}}}", self.symbol),
            _ => latex::left_side(&self.symbol),
        };
        match self.latex().as_slice() {
            [only] => format!("{symbol} &= {only}"),
            several => format!("{symbol} &= \\left({}\\right)", several.join(", ")),
        }
    }

    /// The shapes of the right sides.
    pub fn shapes(&self) -> Vec<Shape> {
        self.expressions().iter().map(|value| value.shape()).collect()
    }

    /// What is written.
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

    /// Whether it is that something vanishes.
    pub(super) fn is_trivial(&self) -> bool {
        self.value.is_empty() || self.text().iter().all(|text| text == "0")
    }

    fn written(&self, notation: Notation) -> Vec<String> {
        let mut written = self.written_alone(notation);
        for (k, mu, f) in &self.free {
            written[*k] += &notation.of_free_motion(*mu, *f);
        }
        written
    }

    fn written_alone(&self, notation: Notation) -> Vec<String> {
        let each = |write: &dyn Fn(Expr<'g>) -> String| self.expressions().iter().map(|value| write(*value)).collect();
        match &self.wording {
            Wording::AsIs => each(&|value| notation.of(without_embeddings(value))),
            Wording::Shorter => each(&|value| notation.of(without_embeddings(shorter(value)))),
            Wording::Words(unicode, latex) => vec![if notation == Notation::Latex { latex } else { unicode }.clone()],
            Wording::AndKick(place, kicks) => {
                let write = |(value, kick): (&Expr<'g>, &Expr<'g>)| {
                    let (value, kick) = (notation.of(without_embeddings(*value)), notation.of(shorter(*kick)));
                    match notation {
                        Notation::Unicode => format!("{value} + [{kick}] at {place}"),
                        Notation::Latex => format!("{value} + \\left[{kick}\\right]_{{{}}}", place.replace('⁺', "^+")),
                    }
                };
                self.expressions().iter().zip(kicks).map(write).collect()
            }
        }
    }
}

impl Notation {
    fn of(self, expression: Expr<'_>) -> String {
        if self == Notation::Latex { expression.latex() } else { expression.to_string() }
    }

    /// What the symbol μ means where a factor moves freely.
    fn of_free_motion(self, mu: Expr<'_>, f: Expr<'_>) -> String {
        let (mu, f) = (self.of(mu), self.of(f));
        match self {
            Notation::Unicode => {
                format!(", {mu} the momentum of the free motion from I to {f} in h, by less than half a turn")
            }
            Notation::Latex => format!(
                ",\\quad {mu} \\text{{ the momentum of the free motion from }} I \\text{{ to }} {f} \\text{{ in }} h, \\text{{ by less than half a turn}}"
            ),
        }
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
        self.0.iter().filter(|row| row.is_listed && !row.is_trivial())
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
        let is_meant = |row: &Formula<'g>| is_meant(row.id);
        let Some(first) = self.0.iter().position(&is_meant) else { return &[] };
        let count = self.0[first..].iter().take_while(|row| is_meant(row)).count();
        &self.0[first..first + count]
    }
}

impl FormulaTable<'_> {
    /// The formulas that `DERIVATION` lists, in an `align*`.
    pub fn latex(&self) -> String {
        let row = |formula: &Formula<'_>| {
            let title = if formula.title.is_empty() { String::new() } else { format!("% {}\n", formula.title) };
            format!("{title}{}", formula.equation_in_latex())
        };
        let rows: Vec<String> = self.listing().map(row).collect();
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
