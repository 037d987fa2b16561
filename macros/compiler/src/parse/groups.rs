//! Groups of the user's own: `group NAME = |F: Matrix4| a == b` and `group NAME = basis([…])`.

use proc_macro2::Ident;
use syn::ext::IdentExt;
use syn::parse::ParseStream;
use syn::{Expr, ExprClosure, Token};

use super::keys::Keys;
use super::{Closure, values};
use crate::diagnostic::{Diagnostic, Diagnostics, Location};

/// A group of the user's own.
#[derive(Clone)]
pub struct DeclaredGroup {
    /// Its name.
    pub name: Ident,
    /// What it is.
    pub definition: Definition,
}

/// What a declared group is.
#[derive(Clone)]
pub enum Definition {
    /// All matrices that satisfy an equation.
    Equation(Box<Closure>),
    /// The group of a Lie algebra, whose basis this is, and where the list stands.
    Basis(Vec<Expr>, Location),
}

/// Reads what follows on the word `group`.
pub(super) fn read(
    word: &Ident,
    stream: ParseStream,
    keys: &mut Keys,
    diagnostics: &mut Diagnostics,
) -> Result<(), Diagnostic> {
    let name = stream.call(Ident::parse_any).map_err(|_| nameless(word))?;
    if keys.groups.iter().any(|group| group.name.unraw() == name.unraw()) {
        let error = Diagnostic::new(name.span(), format!("the group `{name}` is declared twice"));
        return Err(error.help("choose another name for one of the two"));
    }
    if stream.parse::<Token![=]>().is_err() {
        return Err(no_definition(&name, name.span().into()));
    }
    if stream.peek(Token![|]) || stream.peek(Token![||]) || stream.peek(Token![move]) {
        let closure: ExprClosure = stream.parse()?;
        if let Some(closure) = Closure::read(word, closure, diagnostics) {
            keys.groups.push(DeclaredGroup { name, definition: Definition::Equation(Box::new(closure)) });
        }
        return Ok(());
    }
    let place = Location::from(stream.span());
    let is_basis = stream.parse::<Ident>().is_ok_and(|word| word == "basis") && stream.peek(syn::token::Paren);
    if !is_basis {
        return Err(no_definition(&name, place));
    }
    let definition = read_basis(&name, stream)?;
    keys.groups.push(DeclaredGroup { name, definition });
    Ok(())
}

/// `([E1, E2])`.
fn read_basis(name: &Ident, stream: ParseStream) -> Result<Definition, Diagnostic> {
    let (arguments, span) = values::arguments(stream)?;
    match arguments.as_slice() {
        [Expr::Array(list)] => Ok(Definition::Basis(list.elems.iter().cloned().collect(), Location::of(list))),
        _ => {
            let error = Diagnostic::new(span.join(), format!("the basis of `{name}` is a list of matrices"));
            Err(error.help(format!("write `group {name} = basis([Matrix2::new(0, -1, 1, 0)])`")))
        }
    }
}

fn nameless(word: &Ident) -> Diagnostic {
    Diagnostic::new(word.span(), "a group of one's own has a name")
        .help("write `group Lorentz = |F: Matrix4| …`, and `F: Lorentz` in the action")
}

fn no_definition(name: &Ident, place: Location) -> Diagnostic {
    Diagnostic::new(place, format!("the group `{name}` is neither an equation nor a basis")).help(format!(
        "write `group {name} = |F: Matrix3| F.transpose() * F == I` or `group {name} = basis([Matrix2::new(0, -1, 1, 0)])`"
    ))
}
