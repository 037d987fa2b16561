//! The keys of `#[clebsch(…)]`: one table says how each is read, its default, its needs, and its meaning.

use std::collections::BTreeMap;

use proc_macro2::{Ident, Span};

use super::dials::{
    ChartChoice, CodeForm, Dials, Discretization, Isotropy, Meanings, Order, Promise, RungeKutta, Signature, Solver,
    Summation, emitted_meanings, meanings,
};
use super::spelling::listed;
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

/// A key: a name that can stand on the left of `=`.
pub(super) struct Key {
    pub name: &'static str,
    /// How its value is read.
    pub kind: Kind,
    /// A value that it may have.
    pub example: &'static str,
    /// Its value where it is left out.
    pub default: &'static str,
    /// The other parts of a declaration without which it has no meaning.
    pub needs: &'static str,
    /// Its meaning, for the docs.
    pub about: &'static str,
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
    Closures,
    /// A closure, or a method of integration with the closure of a right-hand side: `rk4(closure)`.
    Motion,
    /// Any other key. It has a function that reads it, and one that prints it and gives its place, if it was given.
    /// Last are the values from which it chooses, with meanings.
    Dial(fn(&mut Dials, Reader) -> Result<(), Diagnostic>, fn(&Dials) -> Option<Located<String>>, fn() -> Meanings),
}

use Kind::{Closures, Dial};

const MECHANICS: &str = "`cost` or `lagrangian`";
const PRICE: &str = "`cost`, the price of an input";
const CHOICE: &str = "`controls`, `dynamics` or `effort`";
const ITERATED: &str = "an implicit momentum equation";

/// All keys: the name, how the value is read, an example, the default, the needs, and the meaning.
#[rustfmt::skip]
pub(super) const KEYS: [Key; 29] = [
    key("action", Kind::Closure, "|F: SO<3>, R: SO<3>| …", "required, or `dynamics`", "",
        "The type of the first argument is the group, that of the second the space of configurations. The value is the moved configuration. Whether the action is left or right is found."),
    key("cost", Kind::Closure, "|h, F| …", "required, or `lagrangian`", "",
        "The kinetic part of the discrete Lagrangian of one step, in J·s. The macro subtracts h·V. With `controls` or `dynamics` it is the price of the input of one step."),
    key("lagrangian", Kind::Closure, "|omega| …", "required, or `cost`", "",
        "The Lagrangian ℓ(q, ξ), most often the kinetic energy, in joules. The macro discretises it. The last argument is a new name for ξ, the velocity in the basis of the group. A T(ξ) − V(q) without the time in one closure is the same as T here and V in `potential`."),
    key("potential", Kind::Potential, "|q| …", "none", MECHANICS,
        "The potential energy V(q), in joules. Where no formula exists, `opaque(Self::value, Self::gradient)` names two methods of the struct. `opaque(t, …)` is for methods that take the time first."),
    key("symmetry", Closures, "|S: SO<3>, q, F| (S * q, S * F * S.transpose())", "found", MECHANICS,
        "A symmetry that lies outside the declared group, such as rotations of a system of translations. The value is the pair of the moved configuration and the group element of the moved step. The macro checks it and adds its momentum to the conserved ones. `[closure, closure]` offers several."),
    key("force", Kind::Closure, "|omega, torque: Vector3| torque - self.damping * omega", "none", MECHANICS,
        "A force that is no gradient, in the components of the momentum. A last argument with a type is an input, which each step is given or which `effort` chooses. With `effort`, names with types behind it are references: data of each step of a plan."),
    key("force_on", Kind::Closure, "|x, thrust: Vector3| thrust", "none", MECHANICS,
        "A force as a covector of the configuration, in its shape. It takes the same arguments as `force`."),
    key("constraint", Closures, "|xi| [xi.z == 0]", "every motion is allowed", MECHANICS,
        "Equations that the motion obeys. With the velocity ξ among the arguments, a new name, they are affine in ξ, as for rolling without slipping. Without it they are equations of the configuration, as for joints. Both sides may be vectors, and a block with `let` ends in the list. An element `(0..3).map(|i| a == b)` is an equation for each number. `[closure, closure]` has both kinds."),
    key("space", Closures, "[|dx, q, next| (next - q).norm_squared() / (2 * dx.powi(2))]", "a system without neighbours", MECHANICS,
        "The energy of an edge from a site to its neighbour, in joules: one closure for each direction of space. The declaration is that of one site. The number of sites and their boundary are said at run time: `field.grid([64, 64])`. The first argument is a new name for the spacing of the direction, the last one for the configuration of the neighbour."),
    key("controls", Kind::Closure, "|u: Vector2| vector![u.x, u.y, 0]", "", PRICE,
        "The velocity that an input gives, in the basis of the group. It moves the configuration directly, without mass or momentum. Names with types behind the input are references: data of each step."),
    key("dynamics", Kind::Motion, "|h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x]", "", PRICE,
        "The next configuration, by any map of a vector space. It replaces `action`. Its first two typed arguments are the configuration and the input. Those behind them are references: data of each step. A right-hand side of x′ = f(t, x, u) stands in the parentheses of a method: `rk4(|x: Vector2, u: Vector1| vector![x.y, u.x])`."),
    key("effort", Kind::Closure, "|h, torque| h * torque.norm_squared() / 2", "nothing is chosen", "`force` or `force_on` with an input",
        "The price of the input of one step. Plans make the sum of these prices least."),
    key("bounds", Kind::Closure, "|u| [u.x <= 1, u.x + u.y == 0]", "none", CHOICE,
        "Inequalities of scalars, with `<=` or `>=`, and equations of scalars or vectors, with `==`, that hold in every step of a plan. A field that only inequalities read may be infinite: plans are then those without them."),
    key("endpoint", Kind::Closure, "|q| …", "none", "`controls`, `dynamics`, `effort` or `emit = [boundary]`",
        "The price of the end of a plan, or of a path of least action with a free end. It is added to the prices of all steps."),
    key("target", Kind::Closure, "|q| [q.x == 1, q.y <= 2]", "none", CHOICE,
        "Conditions that hold at the end of plans to `Target::Conditions`: equations of scalars or vectors, and inequalities of scalars. A block with `let` may end in the list."),
    key("step", Kind::Closure, "|q| q.norm()", "steps of the size h", "`lagrangian` or `cost`, and a potential",
        "The monitor g(q) > 0, for close approaches. A step of the size h takes the time t with dt = g(q) ds, s from 0 to h. It is short where g is small. Steps are reversible and conserve momenta. For g = c/(V₀ − V) and exact drifts they are symplectic in s."),
    dial("order", Dial(|dials, value| value.order(&mut dials.order), |dials| text(&dials.order), Order::meanings), "2", "2", MECHANICS,
        "The order of accuracy: the error at a fixed time shrinks like this power of h."),
    dial("discretization", Dial(|dials, value| value.word(&mut dials.discretization), |dials| text(&dials.discretization), meanings::<Discretization>), "cayley", "`cayley` where that map stays in the group, else `exponential`", "`lagrangian` or `controls`",
        "How the velocity ξ of a step belongs to its group element F. `controls` take `cayley` and `exponential`."),
    dial("chart", Dial(|dials, value| value.word(&mut dials.chart), |dials| text(&dials.chart), meanings::<ChartChoice>), "exponential", "chosen by discretization and group", MECHANICS,
        "The coordinates in which a step looks for its group element F."),
    dial("solver", Dial(|dials, value| value.word(&mut dials.solver), |dials| text(&dials.solver), meanings::<Solver>), "fixed_point", "the one with fewer operations", ITERATED,
        "How a step starts to solve its momentum equation ρ(x) = 0."),
    dial("iterations", Dial(|dials, value| value.count(&mut dials.iterations), |dials| text(&dials.iterations), Vec::new), "4", "the limits of the solver", ITERATED,
        "The most iterations for each momentum equation, a positive integer. A step that needs more is `Error::NotConverged`, in bounded time."),
    dial("tolerance", Dial(|dials, value| value.part(&mut dials.tolerance), |dials| dials.tolerance.as_ref().map(|part| part.to(format!("{:e}", part.value))), Vec::new), "1e-8", "round-off", ITERATED,
        "An iteration ends before a correction below this fraction of the step, a number between 0 and 1. The step is then no longer symplectic, and energies drift."),
    dial("summation", Dial(|dials, value| value.word(&mut dials.summation), |dials| text(&dials.summation), meanings::<Summation>), "compensated", "`plain`", MECHANICS,
        "How a step adds its increments to configuration and momentum."),
    dial("code", Dial(|dials, value| value.word(&mut dials.code), |dials| text(&dials.code), meanings::<CodeForm>), "matrices", "chosen by the size", "",
        "How the code of a step is written."),
    key("isotropy", Dial(|dials, value| value.word(&mut dials.isotropy), |dials| text(&dials.isotropy), meanings::<Isotropy>), "free", "`fixed`", MECHANICS,
        "Motions of the group that move no configuration, such as turns about a point on a sphere. With `fixed` the kinetic energy may omit them, as |Φ_F(q) − q|² does: a vertical term is added, which does not change the motion of q."),
    key("signature", Dial(|dials, value| value.word(&mut dials.signature), |dials| text(&dials.signature), meanings::<Signature>), "indefinite", "`definite`", MECHANICS,
        "The signs that the kinetic energy may have. `stepper()` checks the inertia of the parameters; `state()` checks an inertia that depends on the configuration or the time."),
    key("emit", Dial(|dials, value| value.words(&mut dials.emit), |dials| dials.emit.text().map(somewhere), emitted_meanings), "[generated]", "`[]`", "",
        "Further items that the macro derives, a list of words."),
    key("scalar", Dial(|dials, value| value.ident(&mut dials.scalar), |dials| dials.scalar.as_ref().map(Ident::to_string).map(somewhere), Vec::new), "f64", "`f64`", "a struct whose closures read no field",
        "The scalar type: `f64`, `f32` or a type parameter of the struct. Fields and spaces that name a scalar decide it otherwise."),
    key("crate", Dial(|dials, value| value.path(&mut dials.krate), |dials| dials.krate.as_ref().map(super::spelling::tokens).map(somewhere), Vec::new), "::clebsch", "`::clebsch`", "",
        "The path of this crate, for a dependency that is renamed or re-exported."),
];

type Text = &'static str;

const fn key(name: Text, kind: Kind, example: Text, default: Text, needs: Text, about: Text) -> Key {
    Key { name, kind, example, default, needs, about, of_method: false }
}

/// A dial of a method.
const fn dial(name: Text, kind: Kind, example: Text, default: Text, needs: Text, about: Text) -> Key {
    Key { name, kind, example, default, needs, about, of_method: true }
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
    /// The values that it chooses from, each with its meaning; none where it takes others.
    fn values(&self) -> Meanings {
        match self.kind {
            Dial(_, _, values) => values(),
            Kind::Motion => meanings::<RungeKutta>(),
            _ => Vec::new(),
        }
    }
}

impl Dials {
    /// The dials that were given, with their values as they are written, in the order of the table.
    pub(crate) fn given(&self) -> impl Iterator<Item = (&'static str, Located<String>)> {
        KEYS.iter().filter_map(|key| match key.kind {
            Kind::Dial(_, given, _) => Some((key.name, given(self)?)),
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
    /// How the right-hand side of `dynamics` is integrated, where it is one.
    pub integration: Option<RungeKutta>,
    /// The same of lists of closures.
    pub lists: BTreeMap<&'static str, Vec<Closure>>,
    pub groups: Vec<DeclaredGroup>,
    /// Each method with its keys, and where each of these was given.
    pub methods: Vec<(Ident, Keys<'d>)>,
    pub dials: Dials,
    /// Whether a name stands in the place of a key that is none.
    pub has_unknown: bool,
    given: Vec<(String, Span)>,
}

impl<'d> Keys<'d> {
    pub fn new(diagnostics: &'d Diagnostics) -> Keys<'d> {
        Keys {
            diagnostics,
            closures: BTreeMap::new(),
            potential: None,
            integration: None,
            lists: BTreeMap::new(),
            groups: Vec::new(),
            methods: Vec::new(),
            dials: Dials::default(),
            has_unknown: false,
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

/// The table of all keys in Markdown, then a section for each. `arguments` gives those of a closure, `refused` the conflicts of a key.
pub(crate) fn keys_as_markdown(
    arguments: impl Fn(&str) -> Option<String>,
    refused: impl Fn(&str) -> Vec<String>,
) -> String {
    let keys = || KEYS.iter();
    let head = "| key | example | default | needs |\n|---|---|---|---|\n";
    let table = keys().map(markdown_row).fold(head.to_string(), |table, row| table + &row);
    let sections = keys().map(|key| {
        let values = key.values().into_iter().map(|(word, meaning)| format!("* `{word}`: {meaning}\n"));
        let arguments = arguments(key.name).map(|names| format!("* arguments: {names}\n"));
        let refused = refused(key.name).into_iter().map(|line| format!("* {line}\n"));
        let lines: String = values.chain(arguments).chain(refused).collect();
        let gap = if lines.is_empty() { "" } else { "\n" };
        format!("\n## `{}`\n\n{}\n{gap}{lines}", key.name, key.about)
    });
    table + &sections.collect::<String>()
}

/// Whether a key chooses its value from words.
pub(crate) fn has_words(name: &Ident) -> bool {
    let known = KEYS.iter().find(|key| name == key.name);
    known.is_some_and(|key| key.values().iter().any(|(word, _)| is_word(word)))
}

/// Whether a value is a name, not a number.
fn is_word(value: &str) -> bool {
    value.starts_with(char::is_alphabetic)
}

/// The documented items that stand for keys and for their words: empty modules.
pub(crate) fn keys_as_rust() -> String {
    let keys = KEYS.iter().filter(|key| key.name != "crate");
    let of_key = |key: &Key| {
        let (words, numbers): (Meanings, Meanings) = key.values().into_iter().partition(|(word, _)| is_word(word));
        let numbers: Vec<String> = numbers.iter().map(|(number, meaning)| format!("* {number}: {meaning}")).collect();
        let text = format!("{}\n\nExample: `{} = {}`", key.about, key.name, key.example);
        let text = if numbers.is_empty() { text } else { format!("{text}\n\n{}", numbers.join("\n")) };
        documented(key.name, &text, &words)
    };
    let method = "A further way to step the same system, a unit struct of yours: `method Fine = (order = 6)`.";
    let group = "A group of your own: `group NAME = |F: Matrix4| a == b`, or `group NAME = basis([A, B])`.";
    let field = "Promises on the values of a field.";
    let others = documented("group", group, &[])
        + &documented("method", method, &[])
        + &documented("field", field, &meanings::<Promise>());
    keys.map(of_key).collect::<String>() + &others
}

/// An empty module with a text, and one in it for each word.
fn documented(name: &str, text: &str, words: &[(String, &str)]) -> String {
    let comment = |indent: &str, text: &str| -> String {
        text.lines().map(|line| format!("{indent}/// {line}").trim_end().to_string() + "\n").collect()
    };
    let words = words.iter().map(|(word, meaning)| comment("    ", meaning) + &format!("    pub mod {word} {{}}\n"));
    let words: Vec<String> = words.collect();
    let body = if words.is_empty() { String::new() } else { format!("\n{}", words.join("\n")) };
    format!("\n{}pub mod {name} {{{body}}}\n", comment("", text))
}

/// The names of the dials that a method takes.
pub(crate) fn dials_of_method() -> String {
    listed(KEYS.iter().filter(|key| key.of_method).map(|key| key.name))
}

fn markdown_row(key: &Key) -> String {
    let Key { name, example, default, needs, .. } = key;
    // a bar would end a cell
    format!("| [`{name}`](#{name}) | `{name} = {}` | {default} | {needs} |\n", example.replace('|', "\\|"))
}
