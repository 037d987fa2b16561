//! Sizes in types, and the limits within which the compiler is sure to come to an end.

use syn::{Expr, GenericArgument, GenericParam, Generics, Lit, Type};

use crate::diagnostic::{Diagnostic, Location};
use crate::parse::{spell, spell_type};

/// Rows or columns of one matrix, and the length of one array.
pub(super) const LARGEST: usize = 128;
/// Factors of a group, leaves of a configuration.
pub(super) const LEAVES: usize = 128;
/// Entries of all matrices in one field.
pub(super) const ENTRIES: usize = 16_384;
/// Terms of one range, and entries of an array that is repeated.
pub(super) const TERMS: usize = 4096;

/// The size that a generic argument stands for.
pub(super) fn size_argument(argument: &GenericArgument, generics: &Generics) -> Result<usize, Diagnostic> {
    match argument {
        GenericArgument::Const(expr) => size(expr, generics),
        GenericArgument::Type(ty) => Err(no_size(Location::of(ty), &spell_type(ty), generics)),
        other => Err(Diagnostic::new(Location::of(other), "a size is a number").help("write a number, as in `SO<3>`")),
    }
}

/// What to write instead of a large number of factors.
pub(crate) const IN_LOOPS: &str = "give a const generic for the number of equal sites, `struct Chain<const N: usize>` and `[SO<3>; N]`: then they are stepped in loops, however many they are";

/// The length of a product `[…; N]`: a size, but that more sites than are written out have another way.
pub(super) fn length(expr: &Expr, generics: &Generics) -> Result<usize, Diagnostic> {
    size(expr, generics).map_err(|error| match expr {
        Expr::Lit(literal) if matches!(&literal.lit, Lit::Int(number) if number.base10_parse::<usize>().is_ok_and(|value| value > LARGEST)) => error
            .help(IN_LOOPS),
        _ => error,
    })
}

/// The size that an expression stands for: a number between one and the limit.
pub(super) fn size(expr: &Expr, generics: &Generics) -> Result<usize, Diagnostic> {
    match expr {
        Expr::Lit(literal) => match &literal.lit {
            Lit::Int(number) => match number.base10_parse::<usize>() {
                Ok(0) => {
                    Err(Diagnostic::new(number.span(), "a size of 0 leaves nothing").help("write a number from 1 on"))
                }
                Ok(value) if value <= LARGEST => Ok(value),
                _ => Err(Diagnostic::new(number.span(), format!("the size {number} is more than {LARGEST}"))
                    .note("the code of a step is written out at compile time and grows with the size")),
            },
            _ => Err(no_size(Location::of(expr), &spell(expr), generics)),
        },
        Expr::Group(group) => size(&group.expr, generics),
        _ => Err(no_size(Location::of(expr), &spell(expr), generics)),
    }
}

fn no_size(place: Location, text: &str, generics: &Generics) -> Diagnostic {
    if const_generic(text, generics).is_some() {
        return Diagnostic::later(place, format!("the const generic `{text}` as a size")).help("write a number");
    }
    Diagnostic::new(place, format!("the size `{text}` is not a number"))
        .help("write a number")
        .note("a macro sees the text of the declaration, not the values of constants")
}

/// The const generic with a name.
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
