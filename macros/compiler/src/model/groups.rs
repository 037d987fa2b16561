//! The groups by name, built in and declared.

use std::cell::Cell;

use clebsch_symbolic::{Elements, Graph, Group};
use proc_macro2::Ident;
use syn::ext::IdentExt;
use syn::{GenericArgument, Generics, PathSegment, Type};

use super::features::{self, Feature, Found};
use super::shapes::{GROWS, LARGEST, arguments, last_name, last_segment, named_shape, size_argument};
use super::{ChartChoice, Configuration, Factor, LeafSpace};
use crate::diagnostic::{Diagnostic, Diagnostics, bail, error, nearest, report};
use crate::parse::{Declaration, Dials, listed, spell_type};

/// The meaning of the names in types, and the collector of errors in types.
#[derive(Copy, Clone)]
pub(super) struct GroupNames<'d> {
    pub generics: &'d Generics,
    pub declared: &'d DeclaredGroups,
    pub diagnostics: &'d Diagnostics,
}

/// The groups of the user's own: the name of each, and whether a type names it.
#[derive(Default)]
pub(super) struct DeclaredGroups {
    known: Vec<(Ident, Group, Cell<bool>)>,
}

impl DeclaredGroups {
    pub fn add(&mut self, name: Ident, group: Group) {
        self.known.push((name, group, Cell::new(false)));
    }

    pub fn find(&self, name: &Ident) -> Option<Group> {
        let (_, group, used) = self.known.iter().find(|(known, ..)| known.unraw() == name.unraw())?;
        used.set(true);
        Some(*group)
    }

    pub fn check_used(&self, diagnostics: &Diagnostics) {
        for (name, ..) in self.known.iter().filter(|(.., used)| !used.get()) {
            report!(diagnostics, name.span(), "the group `{name}` is declared and not used";
                help "write `F: {name}` in the action, or remove the group");
        }
    }
}

/// How a group is made from its sizes.
struct Maker {
    name: &'static str,
    /// The smallest n.
    least: usize,
    /// From one n.
    make: fn(usize) -> Group,
    /// From p and q, where it takes two sizes as well.
    of_two: Option<fn(usize, usize) -> Group>,
    /// Whether n is even.
    even: bool,
    /// The description of its elements, and its dimension, for the docs.
    about: [&'static str; 2],
}

/// All groups that are built in.
#[rustfmt::skip]
const GROUPS: [Maker; 11] = [
    Maker { of_two: Some(Group::PseudoOrthogonal), ..maker("SO", 2, Group::SpecialOrthogonal,
        ["rotations, FᵀF = I and det F = 1; `SO<P, Q>`: FᵀηF = η with η = diag(1, …, −1, …)", "N(N − 1)/2, N = P + Q"]) },
    maker("SE",          2, Group::SpecialEuclidean, ["rigid motions x ↦ R x + a, as matrices (R a; 0 1)", "N(N + 1)/2"]),
    maker("Translation", 1, Group::Translation, ["vectors under addition; the identity is 0", "N"]),
    maker("GL",          1, Group::GeneralLinear, ["invertible matrices", "N²"]),
    maker("SL",          2, Group::SpecialLinear, ["det F = 1", "N² − 1"]),
    Maker { even: true, ..maker("Sp", 2, Group::Symplectic, ["FᵀΩF = Ω with Ω = (0 I; −I 0); N is even", "N(N + 1)/2"]) },
    maker("U",           1, Group::Unitary, ["unitary matrices A + iB, as real matrices (A −B; B A)", "N²"]),
    // SU(2) is made of quaternions, the others of real matrices
    maker("SU",          2, |n| if n == 2 { Group::UnitQuaternions } else { Group::SpecialUnitary(n) },
        ["`SU<2>`: unit quaternions; else unitary matrices of determinant 1, as of `U<N>`", "N² − 1"]),
    maker("Heisenberg",  1, Group::Heisenberg, ["matrices (1 xᵀ z; 0 I y; 0 0 1)", "2N + 1"]),
    maker("Aff",         1, Group::Affine, ["affine maps x ↦ A x + a with det A > 0, as matrices (A a; 0 1)", "N² + N"]),
    maker("Sim",         2, Group::Similarity, ["similarities x ↦ s R x + a with s > 0, as matrices (sR a; 0 1)", "N(N + 1)/2 + 1"]),
];

const fn maker(name: &'static str, least: usize, make: fn(usize) -> Group, about: [&'static str; 2]) -> Maker {
    Maker { name, least, make, of_two: None, even: false, about }
}

/// The table of the groups that are built in, in Markdown.
pub(crate) fn groups_as_markdown() -> String {
    let head = "| group | elements | dimension |\n|---|---|---|\n";
    let row = |maker: &Maker| {
        let Maker { name, of_two, about: [elements, dimension], .. } = maker;
        let of_two = if of_two.is_some() { format!(", `{name}<P, Q>`") } else { String::new() };
        format!("| `{name}<N>`{of_two} | {elements} | {dimension} |\n")
    };
    GROUPS.iter().map(row).fold(head.to_string(), |table, row| table + &row)
}

/// The largest dimension of a group whose elements are found by an equation: formulas are looked at in all of its directions.
const DIMENSION: usize = 128;

/// The largest dimension of a group of rotations of unit vectors in which conserved momenta are looked for among all combinations of
/// components.
const COMBINED: usize = 64;

/// Whether conserved momenta are looked for among single components alone, as there are many.
pub fn is_large(group: Group, configurations: &[Configuration<'_>]) -> bool {
    group.dimension() > COMBINED && configurations.iter().all(|leaf| leaf.space == LeafSpace::Unit)
}

pub(super) fn is_built_in(name: &str) -> bool {
    GROUPS.iter().any(|maker| maker.name == name)
}

/// Reads a group by its name; `None` if the type has another name.
pub(super) fn group(ty: &Type, names: GroupNames) -> Option<Result<Group, Diagnostic>> {
    let segment = last_segment(ty)?;
    let ident = &segment.ident;
    match names.declared.find(ident) {
        Some(_) if !segment.arguments.is_none() => Some(Err(error!(ty, "`{ident}` has no size to choose";
            help "write `{ident}`"; note "a group that is declared here is one group"))),
        Some(group) => Some(Ok(group)),
        None => {
            let maker = GROUPS.iter().find(|maker| ident == maker.name)?;
            Some(built_in(ty, maker, &arguments(segment), names).and_then(|group| check_dimension(ty, group)))
        }
    }
}

/// Reads a group where no other type can stand.
pub(super) fn known_group(ty: &Type, names: GroupNames) -> Result<Group, Diagnostic> {
    group(ty, names).unwrap_or_else(|| Err(unknown_group(ty, names)))
}

fn built_in(ty: &Type, maker: &Maker, sizes: &[&GenericArgument], names: GroupNames) -> Result<Group, Diagnostic> {
    let Maker { name, least, make, of_two, even, .. } = maker;
    let text = spell_type(ty);
    let size = |argument: &GenericArgument| size_argument(argument, names.generics);
    let n = match (sizes, of_two) {
        ([n], _) => size(n)?,
        ([p, q], Some(make)) => return Ok(make(size(p)?, size(q)?)),
        (_, Some(_)) => bail!(ty, "`{text}` needs one size or two";
            help "write `{name}<3>` for rotations, `{name}<1, 3>` for Lorentz transformations"),
        _ => bail!(ty, "`{text}` needs one size"; help "write `{name}<{}>`", if *even { 4 } else { 3 }),
    };
    if *even && n % 2 == 1 {
        bail!(ty, "`{text}` needs an even size";
            help "write `{name}<{}>`", n + 1; note "its matrices act on as many momenta as coordinates");
    }
    // the motions of a line have no rotations, and a name for themselves
    let same = [("SE", "Translation<1>"), ("Sim", "Aff<1>")].into_iter().find(|(other, _)| n == 1 && other == name);
    if let Some((_, same)) = same {
        bail!(ty, "`{text}` has no rotations"; help "write `{same}`, which is the same group");
    }
    if n < *least {
        bail!(ty, "`{text}` has only one element"; help "`{name}<n>` needs n ≥ {least}");
    }
    Ok(make(n))
}

fn check_dimension(ty: &Type, group: Group) -> Result<Group, Diagnostic> {
    let (text, rows, dimension) = (spell_type(ty), group.element_shape().rows, group.dimension());
    if rows > LARGEST {
        bail!(ty, "the matrices of `{text}` have {rows} rows, more than {LARGEST}"; note "{GROWS}");
    }
    // spheres need no equation, and it is only known later whether rotations move one
    if dimension > DIMENSION && !matches!(group, Group::SpecialOrthogonal(_)) {
        bail!(ty, "`{text}` has {dimension} dimensions, more than {DIMENSION}"; note "{GROWS}");
    }
    Ok(group)
}

/// Refuses a large group, unless it is one of rotations of unit vectors, whose steps are found without an equation. It
/// also refuses features that are not available for those.
pub(super) fn large(declaration: &Declaration, factors: &[Factor], leaves: &[Configuration]) -> Option<Diagnostic> {
    let is_looked_at = |factor: &&Factor| factor.group.dimension() > DIMENSION || is_large(factor.group, leaves);
    let factor = factors.iter().find(is_looked_at)?;
    let text = factor.group.name(factor.symbol.graph());
    if !is_large(factor.group, leaves) {
        let dimension = factor.group.dimension();
        return Some(error!(factor.span, "`{text}` has {dimension} dimensions, more than {DIMENSION}";
            help "use a smaller group, or a product of several";
            note "only rotations of a unit vector may have more: the others are found by an equation in all of them"));
    }
    let offered = Found::at(&declaration.symmetries.first()?.body).named(text);
    Some(features::refusal((Feature::Symmetry, offered), (Feature::LargeGroup, Found::somewhere())))
}

/// The chart that is chosen has to stay in the group.
pub(super) fn check_chart(graph: &Graph, dials: &Dials, factors: &[Factor], diagnostics: &Diagnostics) {
    let Some(chosen) = dials.chart.as_ref().filter(|chosen| chosen.value == ChartChoice::Cayley) else { return };
    if let Some(factor) = without_cayley_map(graph, factors) {
        let beside = Found::somewhere().named(factor.group.name(graph));
        let chosen = Found::at(chosen.span);
        diagnostics.push(features::refusal((Feature::CayleyChart, chosen), (Feature::NoCayleyMap, beside)));
    }
}

/// The first factor whose group Cayley's map leaves.
pub(super) fn without_cayley_map<'f, 'g>(graph: &Graph, factors: &'f [Factor<'g>]) -> Option<&'f Factor<'g>> {
    factors.iter().find(|factor| !factor.group.is_translation() && !factor.group.has_cayley_chart(graph))
}

/// Spaces whose points are vectors or matrices with a property.
const SPACES_OF_VECTORS: [&str; 4] = ["Unit", "Symmetric", "Projector", "Orthonormal"];

/// The name of the type in angle brackets.
fn vectors_of(segment: &PathSegment) -> Option<String> {
    match arguments(segment).first() {
        Some(GenericArgument::Type(inner)) => Some(last_name(inner)),
        _ => None,
    }
}

/// The error for a type that is no group, where a group is expected.
fn unknown_group(ty: &Type, names: GroupNames) -> Diagnostic {
    let (text, name) = (spell_type(ty), last_name(ty));
    // the vectors of a space like `Unit<Vector3>`
    let vectors = last_segment(ty).filter(|_| SPACES_OF_VECTORS.contains(&name.as_str())).and_then(vectors_of);
    if let Some(shape) = named_shape(vectors.as_ref().unwrap_or(&name)) {
        let (n, error) =
            (shape.rows, error!(ty, "`{text}` is a space, but the first argument of the action is a group element"));
        return error.help(match vectors {
            Some(_) if name == "Symmetric" => {
                format!("write `GL<{n}>` for invertible matrices, which act by `F * P * F.transpose()`")
            }
            Some(_) => format!("write `SO<{n}>` for rotations, which move its points"),
            None if shape.is_column() => format!("write `Translation<{n}>` to shift by a vector"),
            None => format!("write `SO<{n}>` for rotations, `GL<{n}>` for all invertible matrices"),
        });
    }
    let name = vectors.unwrap_or(name);
    let error = error!(ty, "unknown group `{text}`");
    let known = format!("the groups that are built in are {}", listed(GROUPS.iter().map(|maker| maker.name)));
    if name.is_empty() {
        return error.help("write a group, as in `SO<3>`, or a tuple of groups").note(known);
    }
    if ["Quaternion", "UnitQuaternion"].contains(&name.as_str()) {
        return error.help("write `SU<2>`: its elements are unit quaternions");
    }
    match suggestion(&name, names) {
        Some(suggestion) => error.help(format!("write `{suggestion}`")),
        None => error.help(format!("declare it, `group {name} = |F: Matrix3| F.transpose() * F == I`")).note(known),
    }
}

/// The group that a name like `SO3`, `So` or `Rotation3` most likely means.
pub(super) fn suggestion(name: &str, names: GroupNames) -> Option<String> {
    let own: Vec<String> = names.declared.known.each(|(name, ..)| name.unraw().to_string());
    if let Some(similar) = nearest(name, own.iter().map(String::as_str)).filter(|_| name.len() > 2) {
        return Some(similar.to_string());
    }
    let base = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let digits = &name[base.len()..];
    let size = if digits.is_empty() { "3" } else { digits };
    let synonym = match base {
        "Rotation" | "Rot" | "Orthogonal" | "SpecialOrthogonal" => Some("SO"),
        "Isometry" | "Euclidean" | "SpecialEuclidean" | "RigidMotion" => Some("SE"),
        "Similarity" => Some("Sim"),
        "Affine" => Some("Aff"),
        "Symplectic" => Some("Sp"),
        "Unitary" => Some("U"),
        "Lorentz" => return Some("SO<1, 3>".into()),
        "UnitQuaternion" => return Some("SU<2>".into()),
        "UnitComplex" => return Some("SO<2>".into()),
        "Translate" | "Shift" => Some("Translation"),
        _ => None,
    };
    let mut known = GROUPS.iter().map(|maker| maker.name);
    let synonym = synonym.or_else(|| known.clone().find(|group| group.eq_ignore_ascii_case(base)));
    let similar = synonym.or_else(|| nearest(base, known.by_ref()).filter(|_| base.len() > 2));
    similar.map(|group| format!("{group}<{size}>"))
}
