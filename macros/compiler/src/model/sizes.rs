//! Sizes in types, and the limits within which the compiler is sure to come to an end.

use syn::{Expr, ExprLit, GenericArgument, GenericParam, Generics, Lit, LitInt, Type};

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
pub(super) const GROWS: &str = "the code of a step is written out at compile time and grows with the size";

/// The size that a generic argument stands for.
pub(super) fn size_argument(argument: &GenericArgument, generics: &Generics) -> Result<usize, Diagnostic> {
    match argument {
        GenericArgument::Const(expr) => size(expr, generics),
        GenericArgument::Type(ty) => Err(no_size(ty.into(), &spell_type(ty), generics)),
        other => bail!(other, "a size is a number"; help "write a number, as in `SO<3>`"),
    }
}

/// What to write instead of a large number of factors.
pub(crate) const IN_LOOPS: &str = "give a const generic for the number of equal sites, `struct Chain<const N: usize>` and `[SO<3>; N]`: then they are stepped in loops, however many they are";

/// The number that a literal is; `None` for what is no literal of a whole number.
fn number(expr: &Expr) -> Option<&LitInt> {
    match expr {
        Expr::Group(group) => number(&group.expr),
        Expr::Lit(ExprLit { lit: Lit::Int(number), .. }) => Some(number),
        _ => None,
    }
}

/// The length of a product `[…; N]`: a size, but that more sites than are written out have another way.
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
        return Diagnostic::later(place, format!("the const generic `{text}` as a size")).help("write a number");
    }
    error!(place, "the size `{text}` is not a number";
        help "write a number"; note "a macro sees the text of the declaration, not the values of constants")
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
