//! A formula: one row of the table, with its expressions; text is made of them when it is asked for.

use std::cell::OnceCell;
use std::fmt;

use clebsch_symbolic::{Elements, Expr, IntoList, Notation, Shape, work};

use super::{Entry, Id, Reference, latex};

/// A text of more characters has names for its parts.
const LONGEST: usize = 16_384;

/// The work to expand a formula for its text, at most.
const EXPANSION: u64 = 100_000;

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
    pub(super) text: OnceCell<RightSide>,
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

    /// The right side.
    fn text(&self) -> &RightSide {
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
        let text = self.text();
        let parts = text.parts(", ");
        match text.sides.as_slice() {
            [only] => format!("{} = {only}{parts}", self.symbol),
            several => format!("{} = ({}){parts}", self.symbol, several.join(", ")),
        }
    }

    /// `symbol &= expression` in LaTeX, tuples in parentheses.
    pub(super) fn equation_in_latex(&self) -> String {
        let symbol = match self.id {
            Id::Conserved(_) => format!("\\text{{{}}}", self.symbol),
            _ => latex::left_side(&self.symbol),
        };
        let text = self.right_side(Notation::Latex);
        let parts = text.parts(",\\quad ");
        let equation = match text.sides.as_slice() {
            [only] => format!("{symbol} &= {only}{parts}"),
            several => format!("{symbol} &= \\left({}\\right){parts}", several.join(", ")),
        };
        latex::in_ascii(&equation)
    }

    /// The text of the right side. It never uses up the budget of the expansion: a long one is written shorter.
    fn right_side(&self, notation: Notation) -> RightSide {
        let words = |unicode: &String, latex: &String| notation.either(unicode, latex).clone();
        let written = work::apart(u64::MAX, || match &self.wording {
            Wording::AsIs => within_length(&self.expressions().each(|value| without_embeddings(*value)), notation),
            Wording::Shorter => {
                within_length(&self.expressions().each(|value| without_embeddings(shorter(*value))), notation)
            }
            Wording::Words(unicode, latex) => RightSide { sides: vec![words(unicode, latex)], parts: Vec::new() },
            Wording::AndKick(place, kicks) => self.with_kicks(notation, place, kicks),
        });
        // by construction: it has no limit
        let mut written = written.expect("a text");
        for (k, mu, f) in &self.free {
            let (mu, f) = (mu.written(notation), f.written(notation));
            let Some(side) = written.sides.get_mut(*k) else { continue };
            *side += &notation.either(
                format!(", {mu} the momentum of the free motion from I to {f} in h, by less than half a turn"),
                format!(
                    ",\\quad {mu} \\text{{ the momentum of the free motion from }} I \\text{{ to }} {f} \\text{{ in }} h, \\text{{ by less than half a turn}}"
                ),
            );
        }
        written
    }

    fn with_kicks(&self, notation: Notation, place: &str, kicks: &[Expr<'g>]) -> RightSide {
        let values = self.expressions().iter().map(|value| without_embeddings(*value));
        let all: Vec<_> = values.chain(kicks.iter().map(|kick| shorter(*kick))).into_list();
        let RightSide { mut sides, parts } = within_length(&all, notation);
        let latex_place = place.replace('⁺', "^+");
        let kicks = sides.split_off(sides.len() / 2);
        let with_kick = |(value, kick): (String, String)| {
            let latex = format!("{value} + \\left[{kick}\\right]_{{{latex_place}}}");
            notation.either(format!("{value} + [{kick}] at {place}"), latex)
        };
        RightSide { sides: sides.into_iter().zip(kicks).map(with_kick).into_list(), parts }
    }
}

/// The text of a right side.
#[derive(Clone)]
pub(super) struct RightSide {
    /// One text for each factor or leaf.
    sides: Vec<String>,
    /// The parts of long ones, as `P₁ = …`.
    parts: Vec<String>,
}

impl RightSide {
    /// The parts behind the formula.
    fn parts(&self, separator: &str) -> String {
        self.parts.iter().map(|part| format!("{separator}{part}")).collect()
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
        self.0.iter().filter(|row| row.is_listed && row.text().sides.iter().any(|text| text != "0"))
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
    let text = expression.written_within(Notation::Unicode, LONGEST);
    if text.as_ref().is_some_and(|text| !text.contains("embed(")) {
        return expression;
    }
    let blockwise = work::apart(EXPANSION, || expression.expand().blockwise().expand()).ok();
    let is_shorter = |blockwise: &Expr<'_>| length(*blockwise) < text.map_or(usize::MAX, |text| text.chars().count());
    blockwise.filter(is_shorter).unwrap_or(expression)
}

/// An expression as it is or expanded, whichever is shorter.
pub(super) fn shorter(expression: Expr<'_>) -> Expr<'_> {
    let expanded = work::apart(EXPANSION, || expression.expand()).ok();
    expanded.filter(|expanded| length(*expanded) <= length(expression).min(LONGEST)).unwrap_or(expression)
}

/// The characters of a formula, where they are not too many.
fn length(expression: Expr<'_>) -> usize {
    let text = expression.written_within(Notation::Unicode, LONGEST);
    text.map_or(usize::MAX, |text| text.chars().count())
}

/// The texts of expressions: in full, or with names for their parts, or the words that they are too long.
fn within_length(expressions: &[Expr<'_>], notation: Notation) -> RightSide {
    let in_full = expressions.iter().map(|expression| expression.written_within(notation, LONGEST));
    if let Some(sides) = in_full.collect::<Option<Vec<String>>>()
        && sides.iter().map(|side| side.chars().count()).sum::<usize>() <= LONGEST
    {
        return RightSide { sides, parts: Vec::new() };
    }
    let in_parts = expressions.first().and_then(|any| any.graph().written_in_parts(expressions, notation, LONGEST));
    match in_parts {
        Some((sides, parts)) => RightSide { sides, parts },
        None => {
            let words = notation.either("… (too long to print)", "\\dots \\text{ (too long to print)}");
            RightSide { sides: vec![words.to_string(); expressions.len()], parts: Vec::new() }
        }
    }
}
