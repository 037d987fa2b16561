//! The types of vectors and matrices, recognised by their last path segment: `Vector3`, `Matrix2x3<f64>`, `SMatrix<f64, 2, 8>`.

use clebsch_symbolic::Shape;
use syn::{GenericArgument, Generics, PathArguments, PathSegment, Type};

use super::sizes::size_argument;
use crate::diagnostic::{Diagnostic, bail};
use crate::parse::spell_type;

/// The largest n for which `VectorN` and `MatrixN` have names.
const NAMED: usize = 6;

pub(super) struct Vectors<'t> {
    pub shape: Shape,
    /// The scalar, if it is written.
    pub scalar: Option<&'t Type>,
}

/// The last segment of a type's path.
pub(super) fn last_segment(ty: &Type) -> Option<&PathSegment> {
    match ty {
        Type::Path(path) if path.qself.is_none() => path.path.segments.last(),
        Type::Group(group) => last_segment(&group.elem),
        Type::Paren(paren) => last_segment(&paren.elem),
        _ => None,
    }
}

/// The name of the last segment of a type's path; empty where there is none.
pub(super) fn last_name(ty: &Type) -> String {
    last_segment(ty).map(|segment| segment.ident.to_string()).unwrap_or_default()
}

/// The generic arguments of a segment.
pub(super) fn arguments(segment: &PathSegment) -> Vec<&GenericArgument> {
    match &segment.arguments {
        PathArguments::AngleBracketed(arguments) => arguments.args.iter().collect(),
        _ => Vec::new(),
    }
}

/// The shape that a name like `Matrix2x3` stands for.
pub(super) fn named_shape(name: &str) -> Option<Shape> {
    let number = |digits: &str| digits.parse::<usize>().ok().filter(|n| (1..=NAMED).contains(n) && digits.len() == 1);
    if let Some(digits) = name.strip_prefix("RowVector") {
        return number(digits).map(|n| Shape::new(1, n));
    }
    if let Some(digits) = name.strip_prefix("Vector") {
        return number(digits).map(Shape::vector);
    }
    let digits = name.strip_prefix("Matrix")?;
    match digits.split_once('x') {
        Some((rows, columns)) => Some(Shape::new(number(rows)?, number(columns)?)),
        None => number(digits).map(Shape::square),
    }
}

/// Reads a vector or matrix type; `None` if it is something else.
pub(super) fn vectors<'t>(ty: &'t Type, generics: &Generics) -> Option<Result<Vectors<'t>, Diagnostic>> {
    let segment = last_segment(ty)?;
    let name = segment.ident.to_string();
    // the shape, or how many sizes follow, and an example
    let (named, count, example) = match name.as_str() {
        "SVector" => (None, 1, "SVector<f64, 8>".into()),
        "SMatrix" => (None, 2, "SMatrix<f64, 2, 3>".into()),
        _ => (Some(named_shape(&name)?), 0, format!("{name}` or `{name}<f64>")),
    };
    let read = || {
        let (scalar, sizes) = match arguments(segment).as_slice() {
            [GenericArgument::Type(scalar), sizes @ ..] if sizes.len() == count => (Some(scalar), sizes.to_vec()),
            sizes if sizes.len() == count => (None, sizes.to_vec()),
            _ => {
                bail!(ty, "`{}` has not the arguments of `{name}`", spell_type(ty); help "write `{example}`")
            }
        };
        let size = |position: usize| size_argument(sizes[position], generics);
        let shape = match named {
            Some(shape) => shape,
            None if count == 1 => Shape::vector(size(0)?),
            None => Shape::new(size(0)?, size(1)?),
        };
        Ok(Vectors { shape, scalar })
    };
    Some(read())
}

/// What to write for a name that looks like a vector or a matrix and is none.
pub(super) fn hint(name: &str) -> Option<String> {
    let digits: String = name.chars().skip_while(|c| !c.is_ascii_digit()).collect();
    let n = digits.parse::<usize>().ok();
    match (name.trim_end_matches(|c: char| c.is_ascii_digit()), n) {
        ("Vector", Some(n)) if n > NAMED => Some(format!("write `SVector<f64, {n}>`")),
        ("Matrix", Some(n)) if n > NAMED => Some(format!("write `SMatrix<f64, {n}, {n}>`")),
        ("Rotation", Some(n)) => Some(format!("write `Matrix{n}`")),
        ("Point" | "Vec" | "DVec", Some(n)) => Some(format!("write `Vector{n}`")),
        ("Mat" | "DMat", Some(n)) => Some(format!("write `Matrix{n}`")),
        ("Vec" | "DVector", None) => {
            Some("write a vector of fixed size, like `Vector3<f64>` or `SVector<f64, 8>`".into())
        }
        ("DMatrix", None) => Some("write a matrix of fixed size, like `Matrix3<f64>` or `SMatrix<f64, 2, 8>`".into()),
        _ => None,
    }
}
