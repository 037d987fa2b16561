//! The keys of `#[clebsch(…)]`: one table says how each is read, its default and what it belongs to.

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use proc_macro2::{Ident, Span};

use super::dials::Dials;
use super::values::Reader;
use super::{Closure, DeclaredGroup, Potential};
use crate::diagnostic::{Diagnostic, Diagnostics};

/// A value and where it was written.
#[derive(Clone, Debug)]
pub struct Located<T> {
    /// The value.
    pub value: T,
    /// Where it was written.
    pub span: Span,
}

impl<T> Located<T> {
    /// Another value at the same place.
    fn to<U>(&self, value: U) -> Located<U> {
        Located { value, span: self.span }
    }
}

/// A key: what can stand on the left of `=`.
pub(super) struct Key {
    pub name: &'static str,
    /// How its value is read.
    pub kind: Kind,
    /// A value that it may have.
    pub example: &'static str,
    /// What holds where it is left out.
    pub default: &'static str,
    /// What it belongs to.
    pub of: &'static str,
    /// Whether a method takes it too.
    pub of_method: bool,
}

/// How the value of a key is read.
#[derive(Copy, Clone)]
pub(super) enum Kind {
    /// A closure.
    Closure,
    /// A closure, or two methods of the struct.
    Potential,
    /// A closure, or a list of them.
    Symmetry,
    /// Anything else: how it is read; and how it prints and where it is, if it was given.
    Dial(fn(&mut Dials, Reader) -> Result<(), Diagnostic>, fn(&Dials) -> Option<Located<String>>),
    /// Part of the language, but not of this version.
    Later,
}

use Kind::{Dial, Later, Symmetry};

const MECHANICS: &str = "mechanics";
const STEERED: &str = "inputs that move the configuration";
const CHOICE: &str = "inputs that are chosen";
const ALL: &str = "every declaration";
const ITERATED: &str = "implicit momentum equations";

/// All keys: the name, how the value is read, an example, the default, and what the key belongs to.
#[rustfmt::skip]
pub(super) const KEYS: [Key; 27] = [
    key("action", Kind::Closure, "|F: SO<3>, R: SO<3>| …", "", "every declaration but `dynamics`"),
    key("cost", Kind::Closure, "|h, F| …", "", "mechanics, or the price of a step of inputs"),
    key("lagrangian", Kind::Closure, "|omega| …", "", MECHANICS),
    key("potential", Kind::Potential, "|q| …", "none", MECHANICS),
    key("symmetry", Symmetry, "|S: SO<3>, q, F| (S * q, S * F * S.transpose())", "found", MECHANICS),
    key("force", Kind::Closure, "|omega, torque: Vector3| torque - self.damping * omega", "none", MECHANICS),
    key("force_on", Kind::Closure, "|x, thrust: Vector3| thrust", "none", MECHANICS),
    key("controls", Kind::Closure, "|u: Vector2| vector![u.x, u.y, 0]", "", STEERED),
    key("dynamics", Kind::Closure, "|h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x]", "", STEERED),
    key("effort", Kind::Closure, "|h, torque| h * torque.norm_squared() / 2", "nothing is chosen", "forces with an input"),
    key("bounds", Kind::Closure, "|u| [u.x <= 1, -1 <= u.x]", "none", CHOICE),
    key("endpoint", Kind::Closure, "|q| …", "none", "inputs that are chosen, and `emit = [boundary]`"),
    dial("order", Dial(|dials, value| value.order(&mut dials.order), |dials| text(&dials.order)), "2", "2", MECHANICS),
    dial("discretization", Dial(|dials, value| value.word(&mut dials.discretization), |dials| text(&dials.discretization)), "cayley", "`cayley` where that map stays in the group, else `exponential`", "a `lagrangian`, and `controls`"),
    dial("chart", Dial(|dials, value| value.word(&mut dials.chart), |dials| text(&dials.chart)), "exponential", "by the discretization and the group", MECHANICS),
    dial("solver", Dial(|dials, value| value.word(&mut dials.solver), |dials| text(&dials.solver)), "fixed_point", "what takes fewer operations", ITERATED),
    dial("iterations", Dial(|dials, value| value.count(&mut dials.iterations), |dials| text(&dials.iterations)), "4", "until round-off", ITERATED),
    dial("tolerance", Dial(|dials, value| value.part(&mut dials.tolerance), |dials| dials.tolerance.as_ref().map(|part| part.to(format!("{:e}", part.value)))), "1e-8", "round-off", ITERATED),
    dial("summation", Dial(|dials, value| value.word(&mut dials.summation), |dials| text(&dials.summation)), "compensated", "`plain`", MECHANICS),
    dial("code", Dial(|dials, value| value.word(&mut dials.code), |dials| text(&dials.code)), "matrices", "by the size", ALL),
    key("isotropy", Dial(|dials, value| value.word(&mut dials.isotropy), |dials| text(&dials.isotropy)), "free", "`fixed`", MECHANICS),
    key("emit", Dial(|dials, value| value.words(&mut dials.emit), |dials| dials.emit.text().map(somewhere)), "[generated]", "`[]`", ALL),
    key("scalar", Dial(|dials, value| value.ident(&mut dials.scalar), |dials| dials.scalar.as_ref().map(Ident::to_string).map(somewhere)), "f64", "`f64`", "structs without fields"),
    key("crate", Dial(|dials, value| value.path(&mut dials.krate), |dials| dials.krate.as_ref().map(super::spelling::tokens).map(somewhere)), "::clebsch", "`::clebsch`", ALL),
    key("constraint", Later, "…", "", ""),
    key("discrete_constraint", Later, "…", "", ""),
    key("space", Later, "…", "", ""),
];

const fn key(name: &'static str, kind: Kind, example: &'static str, default: &'static str, of: &'static str) -> Key {
    Key { name, kind, example, default, of, of_method: false }
}

/// A dial of a method.
const fn dial(name: &'static str, kind: Kind, example: &'static str, default: &'static str, of: &'static str) -> Key {
    Key { name, kind, example, default, of, of_method: true }
}

/// A value as it is written, where it was given.
fn text<T: ToString>(value: &Option<Located<T>>) -> Option<Located<String>> {
    value.as_ref().map(|located| located.to(located.value.to_string()))
}

/// A value whose place is not known.
fn somewhere(value: String) -> Located<String> {
    Located { value, span: Span::call_site() }
}

impl Key {
    pub fn comes_later(&self) -> bool {
        matches!(self.kind, Kind::Later)
    }
}

impl Dials {
    /// The dials that were given, with their values as they are written, in the order of the table.
    pub(crate) fn given(&self) -> impl Iterator<Item = (&'static str, Located<String>)> {
        KEYS.iter().filter_map(|key| match key.kind {
            Kind::Dial(_, given) => Some((key.name, given(self)?)),
            _ => None,
        })
    }

    /// Those that say how a step is made, of a system that has all the others.
    pub(crate) fn of_steps(&self) -> Dials {
        let Dials { chart, solver, tolerance, iterations, summation, code, .. } = self.clone();
        Dials { chart, solver, tolerance, iterations, summation, code, ..Dials::default() }
    }
}

/// All keys that were given, and the errors of reading them.
pub(super) struct Keys<'d> {
    pub diagnostics: &'d Diagnostics,
    /// Those that are closures and could be read, by name.
    pub closures: BTreeMap<&'static str, Closure>,
    pub potential: Option<Potential>,
    pub symmetries: Vec<Closure>,
    pub groups: Vec<DeclaredGroup>,
    /// Each method with its keys, and where each of these was given.
    pub methods: Vec<(Ident, Keys<'d>)>,
    pub dials: Dials,
    given: Vec<(String, Span)>,
}

impl<'d> Keys<'d> {
    pub fn new(diagnostics: &'d Diagnostics) -> Keys<'d> {
        Keys {
            diagnostics,
            closures: BTreeMap::new(),
            potential: None,
            symmetries: Vec::new(),
            groups: Vec::new(),
            methods: Vec::new(),
            dials: Dials::default(),
            given: Vec::new(),
        }
    }

    /// Notes that a key was given; `false` if it was given before.
    pub fn give(&mut self, key: &Ident) -> bool {
        let name = key.to_string();
        let first = !self.was_given(&name);
        self.given.push((name, key.span()));
        first
    }

    /// Whether a key was given, readable or not.
    pub fn was_given(&self, name: &str) -> bool {
        self.place_of(name).is_some()
    }

    pub fn place_of(&self, name: &str) -> Option<Span> {
        self.given.iter().find(|(given, _)| given == name).map(|(_, span)| *span)
    }

    pub fn is_empty(&self) -> bool {
        self.given.is_empty()
    }
}

/// The table of all keys in Markdown.
pub fn keys_as_markdown() -> String {
    let head = "| key | an example | default | of |\n|---|---|---|---|\n";
    let rows = KEYS.iter().filter(|key| !key.comes_later()).map(markdown_row);
    let table = rows.fold(head.to_string(), |table, row| table + &row);
    let dials: Vec<String> = KEYS.iter().filter(|key| key.of_method).map(|key| format!("`{}`", key.name)).collect();
    format!(
        "{table}
`method NAME = (dial = value, …)` declares a further way to step the same system. `NAME` is a unit struct of yours. There may be any number of methods.
The dials of a method are {}. One that a method does not name has its default, whatever the declaration says.
`emit = [tangent]` and `[boundary]` serve every method whose steps can be differentiated. `effort` is of the steps with the declared dials.
",
        dials.join(", ")
    )
}

fn markdown_row(key: &Key) -> String {
    let Key { name, example, default, of, .. } = key;
    // a bar would end a cell
    format!("| `{name}` | `{name} = {}` | {default} | {of} |\n", example.replace('|', "\\|"))
}
