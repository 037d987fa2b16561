//! The two typed arguments of the action: the group and the space of configurations, with products of both.

use clebsch_symbolic::{Group, IntoList, Property, Shape};
use syn::{GenericArgument, Type};

use super::groups::{GroupNames, group, known_group, suggestion};
use super::quaternion;
use super::shapes::{
    IN_LOOPS, LEAVES, arguments, hint, last_name, last_segment, length, plain, size_argument, spelled, vectors,
};
use super::{Layout, LeafSpace, space_names};
use crate::diagnostic::{Diagnostic, bail, error, refuse};
use crate::parse::spell_type;

/// A type as a product of leaves.
#[derive(Clone)]
pub(super) struct Product<'t, L> {
    pub layout: Layout,
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
    /// The property of every point.
    pub fn property(&self) -> Property {
        match self.space {
            LeafSpace::Vectors => Property::General,
            LeafSpace::Unit => Property::Unit,
            LeafSpace::Symmetric => Property::Symmetric,
            LeafSpace::Projector(rank) => Property::Projector(rank),
            LeafSpace::Orthonormal => Property::Orthonormal,
            LeafSpace::Group(group) => group.element_property(),
        }
    }
}

pub(super) fn read_groups<'t>(ty: &'t Type, names: GroupNames) -> Option<Product<'t, Group>> {
    Product::read(ty, names, &|ty| known_group(ty, names))
}

pub(super) fn read_spaces<'t>(ty: &'t Type, names: GroupNames) -> Option<Product<'t, SpaceType<'t>>> {
    Product::read(ty, names, &|ty| read_space(ty, names))
}

impl<'t, L: Clone> Product<'t, L> {
    fn read(
        ty: &'t Type,
        names: GroupNames,
        leaf: &impl Fn(&'t Type) -> Result<L, Diagnostic>,
    ) -> Option<Product<'t, L>> {
        let ty = plain(ty);
        let read = |ty: &'t Type| Product::read(ty, names, leaf);
        let diagnostics = names.diagnostics;
        let product = match ty {
            Type::Tuple(tuple) if !tuple.elems.is_empty() => {
                let factors: Vec<_> = tuple.elems.iter().filter_map(read).into_list();
                (factors.len() == tuple.elems.len()).then(|| Product::of(factors, Layout::Tuple))?
            }
            Type::Array(array) => {
                let length = diagnostics.take(length(&array.len, names.generics))?;
                Product::of(vec![read(&array.elem)?; length], Layout::Array)
            }
            _ => Product { layout: Layout::Leaf(0), leaves: vec![(diagnostics.take(leaf(ty))?, ty)] },
        };
        if product.leaves.len() > LEAVES {
            let count = product.leaves.len();
            refuse!(diagnostics, ty, "`{}` has {count} factors, more than {LEAVES}", spell_type(ty);
                help "{IN_LOOPS}";
                note "the code of a step is unrolled at compile time and grows with the number of factors");
        }
        Some(product)
    }

    fn of(factors: Vec<Product<'t, L>>, nest: fn(Vec<Layout>) -> Layout) -> Product<'t, L> {
        let mut leaves = Vec::new();
        let mut layouts = Vec::new();
        for factor in factors {
            layouts.push(factor.layout.shifted(leaves.len()));
            leaves.extend(factor.leaves);
        }
        Product { layout: nest(layouts), leaves }
    }
}

fn read_space<'t>(ty: &'t Type, names: GroupNames) -> Result<SpaceType<'t>, Diagnostic> {
    if let Some(found) = group(ty, names) {
        let group = found?;
        let (shape, is_quaternion) = (group.element_shape(), group == Group::UnitQuaternions);
        return Ok(SpaceType { space: space_of(group), shape, is_quaternion, scalar: None });
    }
    let of_vectors = |space, (shape, scalar)| SpaceType { space, shape, is_quaternion: false, scalar };
    if let Some(found) = vectors(ty, names.generics) {
        return Ok(of_vectors(LeafSpace::Vectors, found?));
    }
    let shape = Shape::vector(quaternion::COORDINATES);
    let of_quaternions = |scalar| SpaceType { space: LeafSpace::Vectors, shape, is_quaternion: true, scalar };
    let name = last_name(ty);
    match (name.as_str(), last_segment(ty).map(arguments).unwrap_or_default().as_slice()) {
        ("Unit", [GenericArgument::Type(inner)]) => match vectors(inner, names.generics).transpose()? {
            Some(found) if found.0.is_column() && found.0.rows > 1 => Ok(of_vectors(LeafSpace::Unit, found)),
            _ => Err(no_unit(ty)),
        },
        ("Unit" | "UnitQuaternion", _) => Err(no_unit(ty)),
        ("Symmetric", [GenericArgument::Type(inner)]) => match vectors(inner, names.generics).transpose()? {
            Some(found) if found.0.is_square() => Ok(of_vectors(LeafSpace::Symmetric, found)),
            _ => Err(no_symmetric(ty)),
        },
        ("Symmetric", _) => Err(no_symmetric(ty)),
        ("Projector", [GenericArgument::Type(inner), rank]) => match vectors(inner, names.generics).transpose()? {
            Some(found) if found.0.is_square() => {
                let rank = rank_of(rank, found.0.rows, names)?;
                Ok(of_vectors(LeafSpace::Projector(rank), found))
            }
            found => Err(no_projector(ty, found.map(|(shape, _)| shape))),
        },
        ("Projector", [GenericArgument::Type(inner)]) => {
            let found = vectors(inner, names.generics).transpose()?;
            Err(no_projector(ty, found.map(|(shape, _)| shape)))
        }
        ("Projector", _) => Err(no_projector(ty, None)),
        ("Orthonormal", [GenericArgument::Type(inner)]) => match vectors(inner, names.generics).transpose()? {
            Some(found) if found.0.columns > 1 && found.0.rows > found.0.columns => {
                Ok(of_vectors(LeafSpace::Orthonormal, found))
            }
            found => Err(no_orthonormal(ty, found.map(|(shape, _)| shape))),
        },
        ("Orthonormal", _) => Err(no_orthonormal(ty, None)),
        ("Quaternion", []) => Ok(of_quaternions(None)),
        ("Quaternion", [GenericArgument::Type(scalar)]) => Ok(of_quaternions(Some(scalar))),
        _ => Err(unknown_space(ty, &name, names)),
    }
}

/// The space that the elements of a group make. Elements of `Translation<n>` are vectors, and every vector is one.
pub(super) fn space_of(group: Group) -> LeafSpace {
    if group.is_translation() { LeafSpace::Vectors } else { LeafSpace::Group(group) }
}

fn no_unit(ty: &Type) -> Diagnostic {
    let text = spell_type(ty);
    if text.contains("Quaternion") {
        return error!(ty, "`{text}` is written as a group";
            help "write `SU<2>`"; note "unit quaternions are the elements of SU(2)");
    }
    error!(ty, "`{text}` is no sphere"; help "write `Unit<Vector3>` for unit vectors")
}

fn no_symmetric(ty: &Type) -> Diagnostic {
    error!(ty, "`{}` is no space of symmetric matrices", spell_type(ty);
        help "write `Symmetric<Matrix3>` for symmetric matrices")
}

/// The rank of a projector, between 1 and n − 1.
fn rank_of(argument: &GenericArgument, n: usize, names: GroupNames) -> Result<usize, Diagnostic> {
    let rank = size_argument(argument, names.generics)?;
    if n == 1 {
        bail!(argument, "projectors of one dimension are 0 and 1"; help "write at least two dimensions, `Projector<Matrix2, 1>`");
    }
    if rank >= n {
        bail!(argument, "the rank {rank} is not below the dimension {n}";
            help "write a rank from 1 to {}", n - 1; note "projectors in {n} dimensions have ranks up to {n}, and only the identity has rank {n}");
    }
    Ok(rank)
}

fn no_projector(ty: &Type, shape: Option<Shape>) -> Diagnostic {
    let error = error!(ty, "`{}` is no space of projectors", spell_type(ty));
    let n = shape.map_or(4, |shape| shape.rows.max(2));
    let error = error.help(format!(
        "write `Projector<{}, {}>`, with the rank behind the matrix",
        spelled(Shape::square(n)),
        n / 2
    ));
    error.note("projectors are square, P² = P = Pᵀ, and their rank is the dimension of the subspace")
}

fn no_orthonormal(ty: &Type, shape: Option<Shape>) -> Diagnostic {
    let error = error!(ty, "`{}` is no space of orthonormal columns", spell_type(ty));
    match shape {
        Some(Shape { rows, columns: 1 }) if rows > 1 => {
            error.help(format!("write `Unit<Vector{rows}>` for unit vectors"))
        }
        Some(Shape { rows, columns }) if rows == columns && rows > 1 => {
            error.help(format!("write `SO<{rows}>` for rotations, which are square"))
        }
        Some(Shape { rows, columns }) if rows < columns && rows > 1 => error
            .help(format!("write `Orthonormal<Matrix{columns}x{rows}>`"))
            .note(format!("{columns} columns of {rows} numbers cannot be orthonormal")),
        _ => error.help("write `Orthonormal<Matrix3x2>` for two orthonormal columns of three numbers"),
    }
}

fn unknown_space(ty: &Type, name: &str, names: GroupNames) -> Diagnostic {
    let error = error!(ty, "unknown space `{}`", spell_type(ty));
    if matches!(name, "f32" | "f64") {
        return error.help("write `Vector1` for a single coordinate");
    }
    let sizes = last_segment(ty).map(arguments).unwrap_or_default();
    let sizes = sizes.iter().filter_map(|size| size_argument(size, names.generics).ok()).into_list();
    let named = space_names::written(name, &sizes).or_else(|| suggestion(name, names));
    let help = named.map(|written| format!("write `{written}`")).or_else(|| hint(name));
    error.help(
        help.as_deref()
            .unwrap_or("write a space of vectors (`Vector3`), of unit vectors (`Unit<Vector3>`) or a group (`SO<3>`)"),
    )
}
