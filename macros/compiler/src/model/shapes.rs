//! Sizes and shapes in types: `Vector3`, `Matrix2x3<f64>`, `SMatrix<f64, 2, 8>`, recognised by their last path segment.
//! Also the limits within which the compiler surely ends.

use clebsch_symbolic::{IntoList, Shape};
use syn::{Expr, ExprLit, GenericArgument, GenericParam, Generics, Lit, LitInt, PathArguments, PathSegment, Type};

use crate::diagnostic::{Diagnostic, Location, bail, error};
use crate::parse::{spell, spell_type};

/// Rows or columns of one matrix, and the length of one array.
pub(super) const LARGEST: usize = 128;
/// Factors of a group, leaves of a configuration.
pub(super) const LEAVES: usize = 128;
/// Entries of all matrices in one field.
pub(super) const ENTRIES: usize = 16_384;
/// Terms of one range, and entries of an array that is repeated.
pub(super) const TERMS: usize = 4096;

/// Why sizes have limits.
pub(super) const GROWS: &str = "the code of a step is unrolled at compile time and grows with the size";

/// The size that a generic argument stands for.
pub(super) fn size_argument(argument: &GenericArgument, generics: &Generics) -> Result<usize, Diagnostic> {
    match argument {
        GenericArgument::Const(expr) => size(expr, generics),
        GenericArgument::Type(ty) => Err(no_size(ty.into(), &spell_type(ty), generics)),
        other => bail!(other, "a size is a number"; help "write a number, as in `SO<3>`"),
    }
}

/// The replacement of a large number of factors.
pub(crate) const IN_LOOPS: &str = "give a const generic for the number of equal sites, `struct Chain<const N: usize>` and `[SO<3>; N]`: then they are stepped in loops, however many they are";

/// The number of a literal; `None` unless it is a literal integer.
pub(super) fn number(expr: &Expr) -> Option<&LitInt> {
    match expr {
        Expr::Group(group) => number(&group.expr),
        Expr::Lit(ExprLit { lit: Lit::Int(number), .. }) => Some(number),
        _ => None,
    }
}

/// The length of a product `[…; N]`. It is a size, but for more sites than can be unrolled there is another way.
pub(super) fn length(expr: &Expr, generics: &Generics) -> Result<usize, Diagnostic> {
    let value = number(expr).and_then(|number| number.base10_parse::<usize>().ok());
    let in_loops = value.filter(|value| *value > LARGEST).map(|_| IN_LOOPS);
    size(expr, generics).map_err(|error| error.maybe_help(in_loops))
}

/// The size that an expression stands for: a number between one and the limit.
pub(super) fn size(expr: &Expr, generics: &Generics) -> Result<usize, Diagnostic> {
    let Some(number) = number(expr) else { return Err(no_size(expr.into(), &spell(expr), generics)) };
    match number.base10_parse() {
        Ok(0) => bail!(number, "a size of 0 leaves nothing"; help "write a number from 1 on"),
        Ok(value) if value <= LARGEST => Ok(value),
        _ => bail!(number, "the size {number} is more than {LARGEST}"; note "{GROWS}"),
    }
}

fn no_size(place: Location, text: &str, generics: &Generics) -> Diagnostic {
    if const_generic(text, generics).is_some() {
        return Diagnostic::later(place, format!("the const generic `{text}` as a size"), Some("write a number"));
    }
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let constant = text.split(|c| !is_word(c)).find_map(|word| const_generic(word, generics));
    let of_sites = constant.map(|n| format!(", or `[…; {n}]` for one value at each of {n} sites"));
    error!(place, "the size `{text}` is not a number";
        help "write a number{}", of_sites.unwrap_or_default(); note "a macro sees the text of the declaration, not the values of constants")
}

pub(super) fn const_generic<'p>(name: &str, generics: &'p Generics) -> Option<&'p syn::Ident> {
    generics.params.iter().find_map(|parameter| match parameter {
        GenericParam::Const(constant) if constant.ident == name => Some(&constant.ident),
        _ => None,
    })
}

/// Whether the type is a type parameter of the struct.
pub(super) fn type_parameter<'p>(ty: &Type, generics: &'p Generics) -> Option<&'p syn::Ident> {
    let Type::Path(path) = ty else { return None };
    let name = path.path.get_ident()?;
    generics.type_params().map(|parameter| &parameter.ident).find(|ident| *ident == name)
}

/// The largest n for which `VectorN` and `MatrixN` have names.
const NAMED: usize = 6;

/// The type of vectors or matrices of a shape.
pub(crate) fn spelled(shape: Shape) -> String {
    match (shape.columns, shape.rows) {
        (1, n @ 1..=NAMED) => format!("Vector{n}"),
        (1, n) => format!("SVector<{n}>"),
        (m, n @ 1..=NAMED) if m == n => format!("Matrix{n}"),
        (m @ 1..=NAMED, n @ 1..=NAMED) => format!("Matrix{n}x{m}"),
        (m, n) => format!("SMatrix<{n}, {m}>"),
    }
}

/// A type without parentheses around it.
pub(super) fn plain(ty: &Type) -> &Type {
    match ty {
        Type::Group(group) => plain(&group.elem),
        Type::Paren(paren) => plain(&paren.elem),
        _ => ty,
    }
}

pub(super) fn last_segment(ty: &Type) -> Option<&PathSegment> {
    let Type::Path(path) = plain(ty) else { return None };
    path.path.segments.last().filter(|_| path.qself.is_none())
}

/// The name of the last segment of a type's path; empty where there is none.
pub(super) fn last_name(ty: &Type) -> String {
    last_segment(ty).map(|segment| segment.ident.to_string()).unwrap_or_default()
}

pub(super) fn arguments(segment: &PathSegment) -> Vec<&GenericArgument> {
    let PathArguments::AngleBracketed(arguments) = &segment.arguments else { return Vec::new() };
    arguments.args.iter().into_list()
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

/// A shape, and the scalar if it is written.
type Vectors<'t> = (Shape, Option<&'t Type>);

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
        Ok((shape, scalar))
    };
    Some(read())
}

/// The advice for a name that looks like a vector or a matrix and is none.
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
        ("Complex", None) => Some("write `Vector2<f64>`, the real part before the imaginary part".into()),
        ("DMatrix", None) => Some("write a matrix of fixed size, like `Matrix3<f64>` or `SMatrix<f64, 2, 8>`".into()),
        _ => None,
    }
}
