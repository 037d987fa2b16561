//! The types of vectors and matrices, recognised by their last path segment: `Vector3`, `Matrix2x3<f64>`, `SMatrix<f64, 2, 8>`.

use clebsch_symbolic::Shape;
use syn::{GenericArgument, Generics, PathArguments, PathSegment, Type};

use super::sizes::size_argument;
use crate::diagnostic::{Diagnostic, Location};
use crate::parse::spell_type;

/// The largest n for which `VectorN` and `MatrixN` have names.
const NAMED: usize = 6;

/// A vector or matrix type.
pub(super) struct Vectors<'t> {
    pub shape: Shape,
    /// The scalar, if it is written.
    pub scalar: Option<&'t Type>,
}

/// How a name gives a shape.
enum Alias {
    /// `Vector3`: the name says it all, the scalar may follow.
    Named(Shape),
    /// `SVector`: one size follows.
    Vector,
    /// `SMatrix`: two sizes follow.
    Matrix,
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
    let alias = match name.as_str() {
        "SVector" => Alias::Vector,
        "SMatrix" => Alias::Matrix,
        _ => Alias::Named(named_shape(&name)?),
    };
    Some(read(ty, segment, alias, generics))
}

fn read<'t>(ty: &Type, segment: &'t PathSegment, alias: Alias, generics: &Generics) -> Result<Vectors<'t>, Diagnostic> {
    let sizes = match alias {
        Alias::Named(_) => 0,
        Alias::Vector => 1,
        Alias::Matrix => 2,
    };
    let all = arguments(segment);
    let (scalar, rest) = match all.as_slice() {
        [GenericArgument::Type(scalar), rest @ ..] if rest.len() == sizes => (Some(scalar), rest),
        rest if rest.len() == sizes => (None, rest),
        _ => return Err(wrong_arguments(ty, segment, alias)),
    };
    let size = |position: usize| size_argument(rest[position], generics);
    let shape = match alias {
        Alias::Named(shape) => shape,
        Alias::Vector => Shape::vector(size(0)?),
        Alias::Matrix => Shape::new(size(0)?, size(1)?),
    };
    Ok(Vectors { shape, scalar })
}

fn wrong_arguments(ty: &Type, segment: &PathSegment, alias: Alias) -> Diagnostic {
    let name = &segment.ident;
    let example = match alias {
        Alias::Named(_) => format!("{name}` or `{name}<f64>"),
        Alias::Vector => format!("{name}<f64, 8>"),
        Alias::Matrix => format!("{name}<f64, 2, 3>"),
    };
    Diagnostic::new(Location::of(ty), format!("`{}` has not the arguments of `{name}`", spell_type(ty)))
        .help(format!("write `{example}`"))
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
