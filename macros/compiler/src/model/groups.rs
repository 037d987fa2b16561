//! The groups by name, built in and declared.

use clebsch_symbolic::Group;
use syn::{GenericArgument, Generics, PathSegment, Type};

use super::declared::DeclaredGroups;
use super::features::{self, Feature, Found};
use super::sizes::{LARGEST, size_argument};
use super::vectors::{arguments, last_segment, named_shape};
use super::{Configuration, Factor, LeafSpace};
use crate::diagnostic::{Diagnostic, Location, nearest};
use crate::parse::{Declaration, spell_type};

/// What the names in types refer to.
#[derive(Copy, Clone)]
pub(super) struct GroupNames<'d> {
    pub generics: &'d Generics,
    pub declared: &'d DeclaredGroups,
}

/// How a group is made from its sizes.
#[derive(Copy, Clone)]
enum Maker {
    /// From one n, at least the first number.
    One(usize, fn(usize) -> Group),
    /// From one n, or from p and q.
    OneOrTwo(usize, fn(usize) -> Group, fn(usize, usize) -> Group),
    /// From an even n.
    Even(fn(usize) -> Group),
}

/// All groups that are built in.
#[rustfmt::skip]
const GROUPS: [(&str, Maker); 11] = [
    ("SO",          Maker::OneOrTwo(2, Group::SpecialOrthogonal, Group::PseudoOrthogonal)),
    ("SE",          Maker::One(2, Group::SpecialEuclidean)),
    ("Translation", Maker::One(1, Group::Translation)),
    ("GL",          Maker::One(1, Group::GeneralLinear)),
    ("SL",          Maker::One(2, Group::SpecialLinear)),
    ("Sp",          Maker::Even(Group::Symplectic)),
    ("U",           Maker::One(1, Group::Unitary)),
    ("SU",          Maker::One(2, special_unitary)),
    ("Heisenberg",  Maker::One(1, Group::Heisenberg)),
    ("Aff",         Maker::One(1, Group::Affine)),
    ("Sim",         Maker::One(2, Group::Similarity)),
];

/// The largest dimension of a group whose elements are found by an equation: formulas are looked at in all of its directions.
const DIMENSION: usize = 128;

/// The largest dimension of a group of rotations of unit vectors in which conserved momenta are looked for among all combinations of
/// components.
const COMBINED: usize = 64;

/// Whether conserved momenta are looked for among single components alone, as there are many.
pub fn is_large(group: Group, configurations: &[Configuration<'_>]) -> bool {
    group.dimension() > COMBINED && configurations.iter().all(|leaf| leaf.space == LeafSpace::Unit)
}

/// SU(2) is made of quaternions, the others of real matrices.
fn special_unitary(n: usize) -> Group {
    if n == 2 { Group::UnitQuaternions } else { Group::SpecialUnitary(n) }
}

/// Whether a name is that of a group that is built in.
pub(super) fn is_built_in(name: &str) -> bool {
    GROUPS.iter().any(|(group, _)| *group == name)
}

/// Reads a group by its name; `None` if the type has another name.
pub(super) fn group(ty: &Type, names: GroupNames) -> Option<Result<Group, Diagnostic>> {
    let segment = last_segment(ty)?;
    if let Some(group) = names.declared.find(&segment.ident) {
        return Some(declared(ty, segment, group));
    }
    let &(name, maker) = GROUPS.iter().find(|(name, _)| segment.ident == name)?;
    Some(built_in(ty, name, maker, &arguments(segment), names).and_then(|group| check_dimension(ty, group)))
}

/// A declared group is a name without sizes.
fn declared(ty: &Type, segment: &PathSegment, group: Group) -> Result<Group, Diagnostic> {
    match segment.arguments.is_none() {
        true => Ok(group),
        false => Err(Diagnostic::new(Location::of(ty), format!("`{}` has no size to choose", segment.ident))
            .help(format!("write `{}`", segment.ident))
            .note("a group that is declared here is one group")),
    }
}

fn built_in(
    ty: &Type,
    name: &str,
    maker: Maker,
    sizes: &[&GenericArgument],
    names: GroupNames,
) -> Result<Group, Diagnostic> {
    let size = |position: usize| size_argument(sizes[position], names.generics);
    let place = Location::of(ty);
    match (maker, sizes.len()) {
        (Maker::One(least, make) | Maker::OneOrTwo(least, make, _), 1) => match size(0)? {
            n if n >= least => Ok(make(n)),
            _ => Err(Diagnostic::new(place, format!("`{}` has only one element", spell_type(ty)))
                .help(format!("`{name}<n>` needs n ≥ {least}"))),
        },
        (Maker::OneOrTwo(_, _, make), 2) => Ok(make(size(0)?, size(1)?)),
        (Maker::Even(make), 1) => match size(0)? {
            n if n % 2 == 0 => Ok(make(n)),
            n => Err(Diagnostic::new(place, format!("`{}` needs an even size", spell_type(ty)))
                .help(format!("write `{name}<{}>`", n + 1))
                .note("its matrices act on as many momenta as coordinates")),
        },
        (Maker::OneOrTwo(..), _) => Err(Diagnostic::new(place, format!("`{}` needs one size or two", spell_type(ty)))
            .help(format!("write `{name}<3>` for rotations, `{name}<1, 3>` for Lorentz transformations"))),
        _ => Err(Diagnostic::new(place, format!("`{}` needs one size", spell_type(ty)))
            .help(format!("write `{name}<{}>`", if matches!(maker, Maker::Even(_)) { 4 } else { 3 }))),
    }
}

fn check_dimension(ty: &Type, group: Group) -> Result<Group, Diagnostic> {
    let text = spell_type(ty);
    let note = "the code of a step is written out at compile time and grows with the size";
    let rows = group.element_shape().rows;
    if rows > LARGEST {
        let message = format!("the matrices of `{text}` have {rows} rows, more than {LARGEST}");
        return Err(Diagnostic::new(Location::of(ty), message).note(note));
    }
    // spheres need no equation, and it is only known later whether rotations move one
    if group.dimension() > DIMENSION && !matches!(group, Group::SpecialOrthogonal(_)) {
        let message = format!("`{text}` has {} dimensions, more than {DIMENSION}", group.dimension());
        return Err(Diagnostic::new(Location::of(ty), message).note(note));
    }
    Ok(group)
}

/// Refuses a large group that is not one of rotations of unit vectors, whose steps are found without an equation, and what is not
/// looked at for those.
pub(super) fn check_large(
    declaration: &Declaration,
    factors: &[Factor<'_>],
    configurations: &[Configuration<'_>],
) -> Result<(), Diagnostic> {
    let must_be_looked_at =
        |factor: &&Factor<'_>| factor.group.dimension() > DIMENSION || is_large(factor.group, configurations);
    let Some(factor) = factors.iter().find(must_be_looked_at) else { return Ok(()) };
    let text = factor.group.name(factor.symbol.graph());
    if !is_large(factor.group, configurations) {
        let message = format!("`{text}` has {} dimensions, more than {DIMENSION}", factor.group.dimension());
        return Err(Diagnostic::new(factor.span, message).help("use a smaller group, or a product of several").note(
            "only rotations of a unit vector may have more: the others are found by an equation in all of them",
        ));
    }
    let Some(symmetry) = declaration.symmetries.first() else { return Ok(()) };
    let offered = Found::at(Location::of(&symmetry.body)).named(text);
    Err(features::refusal((Feature::Symmetry, offered), (Feature::LargeGroup, Found::somewhere())))
}

/// The error for a type that is no group, where a group is expected.
pub(super) fn unknown_group(ty: &Type, names: GroupNames) -> Diagnostic {
    let text = spell_type(ty);
    let place = Location::of(ty);
    let name = last_segment(ty).map(|segment| segment.ident.to_string()).unwrap_or_default();
    if let Some(shape) = named_shape(&name) {
        let message = format!("`{text}` is a space, but the first argument of the action is a group element");
        let n = shape.rows;
        return Diagnostic::new(place, message).help(match shape.is_column() {
            true => format!("write `Translation<{n}>` to shift by a vector"),
            false => format!("write `SO<{n}>` for rotations, `GL<{n}>` for all invertible matrices"),
        });
    }
    let error = Diagnostic::new(place, format!("unknown group `{text}`"));
    match suggestion(&name, names) {
        Some(suggestion) => error.help(format!("write `{suggestion}`")),
        None => {
            let list: Vec<String> = GROUPS.iter().map(|(group, _)| format!("`{group}`")).collect();
            error
                .help(format!("declare it, `group {name} = |F: Matrix3| F.transpose() * F == I`"))
                .note(format!("the groups that are built in are {}", list.join(", ")))
        }
    }
}

/// The group that a name like `SO3`, `So` or `Rotation3` most likely means.
pub(super) fn suggestion(name: &str, names: GroupNames) -> Option<String> {
    let own: Vec<String> = names.declared.names().collect();
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
        "Translate" | "Shift" => Some("Translation"),
        _ => None,
    };
    let known =
        synonym.or_else(|| GROUPS.iter().map(|&(group, _)| group).find(|group| group.eq_ignore_ascii_case(base)));
    let similar = known.or_else(|| nearest(base, GROUPS.iter().map(|&(group, _)| group)).filter(|_| base.len() > 2));
    similar.map(|group| format!("{group}<{size}>"))
}
