//! The first stage: from tokens to a [`Declaration`], closures and types as they were written.

mod attribute;
mod bounds;
mod closure;
mod combinations;
mod control;
mod declaration;
pub(crate) mod dials;
mod expected;
mod field;
mod groups;
mod keys;
mod methods;
mod opaque;
mod spelling;
mod values;

pub(crate) use attribute::is_named;
pub use closure::{Argument, Closure, Pattern};
pub use control::Choice;
pub use declaration::{Declaration, Kinetic, Potential};
pub use dials::*;
pub use field::Field;
pub(crate) use field::{declared_mass, is_mass, mass, member_name, promises_as_markdown};
pub use groups::{DeclaredGroup, Definition};
pub use keys::Located;
pub(crate) use keys::{dials_of_method, has_words, keys_as_markdown, keys_as_rust};
pub use methods::DeclaredMethod;
pub use opaque::Opaque;
pub(crate) use spelling::{joined, listed, parenthesized, shortened, tail, tokens as spell_tokens};
pub use spelling::{spell, spell_type};

use clebsch_symbolic::IntoList;
use proc_macro2::TokenStream;
use syn::{Data, DeriveInput};

use crate::diagnostic::{Diagnostic, Diagnostics, Location, error};

/// Reads the item that carries `#[derive(Clebsch)]`.
///
/// # Errors
/// Everything that is wrong with its form, each error at its place.
pub fn parse(item: TokenStream) -> Result<Declaration, Diagnostics> {
    let (declaration, diagnostics) = read(item)?;
    // by construction: a declaration without errors is there
    declaration.filter(|_| diagnostics.is_empty()).ok_or(diagnostics)
}

/// As much of a declaration with errors as its types are read from.
pub(crate) fn parse_with_errors(item: TokenStream) -> Option<Declaration> {
    read(item).ok()?.0
}

/// The declaration, as far as it can be read, and its errors.
fn read(item: TokenStream) -> Result<(Option<Declaration>, Diagnostics), Diagnostics> {
    bounds::check(&item)?;
    let input: DeriveInput = syn::parse2(item).map_err(Diagnostic::from)?;
    let fields = match &input.data {
        Data::Struct(data) => &data.fields,
        Data::Enum(data) => return Err(no_struct(Location::from(data.enum_token.span), "an enum")),
        Data::Union(data) => return Err(no_struct(Location::from(data.union_token.span), "a union")),
    };
    let diagnostics = Diagnostics::new();
    let keys = attribute::read(&input, &diagnostics);
    let fields = fields.iter().enumerate();
    let fields = fields.map(|(position, field)| field::read(position, field, &diagnostics)).into_list();
    let declaration = declaration::assemble(&input, keys, fields);
    Ok((declaration, diagnostics))
}

fn no_struct(place: Location, what: &str) -> Diagnostics {
    error!(place, "`Clebsch` can only be derived for a struct, and this is {what}";
        note "the fields of the struct are the parameters of the system")
    .into()
}
