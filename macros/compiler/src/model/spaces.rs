//! The two typed arguments of the action: the group and the space of configurations, with products of both.

use clebsch_symbolic::{Group, Property, Shape};
use proc_macro2::Span;
use syn::{Generics, Type};

use super::groups::{GroupNames, group, suggestion, unknown_group};
use super::quaternion;
use super::sizes::{IN_LOOPS, LEAVES, length};
use super::vectors::{Vectors, arguments, hint, last_segment, vectors};
use super::{Layout, LeafSpace};
use crate::diagnostic::{Diagnostic, Diagnostics, Location};
use crate::parse::spell_type;

/// A type as a product of leaves.
pub(super) struct Product<'t, L> {
    pub structure: Layout,
    /// Each leaf with its type.
    pub leaves: Vec<(L, &'t Type)>,
}

/// A leaf of the configuration.
#[derive(Copy, Clone)]
pub(super) struct SpaceType<'t> {
    pub space: LeafSpace,
    pub shape: Shape,
    pub is_quaternion: bool,
    /// The scalar, if it is written.
    pub scalar: Option<&'t Type>,
}

impl SpaceType<'_> {
    /// What holds for every point.
    pub fn property(&self) -> Property {
        match self.space {
            LeafSpace::Vectors => Property::General,
            LeafSpace::Unit => Property::Unit,
            LeafSpace::Group(group) => group.element_property(),
        }
    }
}

/// Reads the type of the group element.
pub(super) fn read_groups<'t>(
    ty: &'t Type,
    names: GroupNames,
    diagnostics: &mut Diagnostics,
) -> Option<Product<'t, Group>> {
    let leaf = |ty: &'t Type| group(ty, names).unwrap_or_else(|| Err(unknown_group(ty, names)));
    read_product(ty, names.generics, &leaf, diagnostics)
}

/// Reads the type of the configuration.
pub(super) fn read_spaces<'t>(
    ty: &'t Type,
    names: GroupNames,
    diagnostics: &mut Diagnostics,
) -> Option<Product<'t, SpaceType<'t>>> {
    let leaf = |ty: &'t Type| read_space(ty, names);
    read_product(ty, names.generics, &leaf, diagnostics)
}

fn read_product<'t, L: Copy>(
    ty: &'t Type,
    generics: &Generics,
    leaf: &impl Fn(&'t Type) -> Result<L, Diagnostic>,
    diagnostics: &mut Diagnostics,
) -> Option<Product<'t, L>> {
    let mut leaves = Vec::new();
    let structure = read_structure(ty, generics, leaf, &mut leaves, diagnostics)?;
    if leaves.len() > LEAVES {
        diagnostics.push(too_many(ty, leaves.len()));
        return None;
    }
    Some(Product { structure, leaves })
}

fn read_structure<'t, L: Copy>(
    ty: &'t Type,
    generics: &Generics,
    leaf: &impl Fn(&'t Type) -> Result<L, Diagnostic>,
    leaves: &mut Vec<(L, &'t Type)>,
    diagnostics: &mut Diagnostics,
) -> Option<Layout> {
    match ty {
        Type::Group(group) => read_structure(&group.elem, generics, leaf, leaves, diagnostics),
        Type::Paren(paren) => read_structure(&paren.elem, generics, leaf, leaves, diagnostics),
        Type::Tuple(tuple) if !tuple.elems.is_empty() => {
            let parts: Vec<Layout> = tuple
                .elems
                .iter()
                .filter_map(|part| read_structure(part, generics, leaf, leaves, diagnostics))
                .collect();
            (parts.len() == tuple.elems.len()).then_some(Layout::Tuple(parts))
        }
        Type::Array(array) => {
            let length = length(&array.len, generics).map_err(|error| diagnostics.push(error)).ok()?;
            let first = leaves.len();
            let part = read_structure(&array.elem, generics, leaf, leaves, diagnostics)?;
            let element: Vec<(L, &'t Type)> = leaves[first..].to_vec();
            if length * element.len() > LEAVES {
                diagnostics.push(too_many(ty, length * element.len()));
                return None;
            }
            (1..length).for_each(|_| leaves.extend(element.iter().copied()));
            Some(Layout::Array((0..length).map(|i| part.shifted(i * element.len())).collect()))
        }
        _ => match leaf(ty) {
            Ok(found) => {
                leaves.push((found, ty));
                Some(Layout::Leaf(leaves.len() - 1))
            }
            Err(error) => {
                diagnostics.push(error);
                None
            }
        },
    }
}

fn too_many(ty: &Type, count: usize) -> Diagnostic {
    Diagnostic::new(Location::of(ty), format!("`{}` has {count} factors, more than {LEAVES}", spell_type(ty)))
        .help(IN_LOOPS)
        .note("the code of a step is written out at compile time and grows with the number of factors")
}

fn read_space<'t>(ty: &'t Type, names: GroupNames) -> Result<SpaceType<'t>, Diagnostic> {
    if let Some(found) = group(ty, names) {
        let group = found?;
        let (shape, is_quaternion) = (group.element_shape(), group == Group::UnitQuaternions);
        return Ok(SpaceType { space: space_of(group), shape, is_quaternion, scalar: None });
    }
    let generics = names.generics;
    if let Some(found) = vectors(ty, generics) {
        return found.map(|vectors| space(LeafSpace::Vectors, &vectors));
    }
    match last_segment(ty) {
        Some(segment) if segment.ident == "Unit" => match arguments(segment).as_slice() {
            [syn::GenericArgument::Type(inner)] => match vectors(inner, generics) {
                Some(Ok(vectors)) if vectors.shape.is_column() && vectors.shape.rows > 1 => {
                    Ok(space(LeafSpace::Unit, &vectors))
                }
                Some(Err(error)) => Err(error),
                _ => Err(no_unit(ty)),
            },
            _ => Err(no_unit(ty)),
        },
        Some(segment) if segment.ident == "Quaternion" => {
            let scalar = match arguments(segment).as_slice() {
                [] => None,
                [syn::GenericArgument::Type(scalar)] => Some(scalar),
                _ => return Err(unknown_space(ty, "Quaternion", names)),
            };
            let shape = Shape::vector(quaternion::COORDINATES);
            Ok(SpaceType { space: LeafSpace::Vectors, shape, is_quaternion: true, scalar })
        }
        Some(segment) if segment.ident == "UnitQuaternion" => Err(no_unit(ty)),
        segment => Err(unknown_space(ty, &segment.map(|segment| segment.ident.to_string()).unwrap_or_default(), names)),
    }
}

fn space<'t>(space: LeafSpace, vectors: &Vectors<'t>) -> SpaceType<'t> {
    SpaceType { space, shape: vectors.shape, is_quaternion: false, scalar: vectors.scalar }
}

/// The space that the elements of a group make. Elements of `Translation<n>` are vectors, and every vector is one.
pub(super) fn space_of(group: Group) -> LeafSpace {
    if group.is_translation() { LeafSpace::Vectors } else { LeafSpace::Group(group) }
}

fn no_unit(ty: &Type) -> Diagnostic {
    let text = spell_type(ty);
    if text.contains("Quaternion") {
        return Diagnostic::new(Location::of(ty), format!("`{text}` is written as a group"))
            .help("write `SU<2>`")
            .note("unit quaternions are the elements of SU(2)");
    }
    Diagnostic::new(Location::of(ty), format!("`{}` is no sphere", spell_type(ty)))
        .help("write `Unit<Vector3>` for unit vectors")
}

fn unknown_space(ty: &Type, name: &str, names: GroupNames) -> Diagnostic {
    let text = spell_type(ty);
    let error = Diagnostic::new(Location::of(ty), format!("unknown space `{text}`"));
    if matches!(name, "f32" | "f64") {
        return error.help("write `Vector1` for a single coordinate");
    }
    match suggestion(name, names).map(|group| format!("write `{group}`")).or_else(|| hint(name)) {
        Some(help) => error.help(help),
        None => {
            error.help("write a space of vectors (`Vector3`), of unit vectors (`Unit<Vector3>`) or a group (`SO<3>`)")
        }
    }
}

/// Where a type begins.
pub(super) fn span_of(ty: &Type) -> Span {
    Location::of(ty).start()
}
