//! Groups of the user's own: `group NAME = |F: Matrix4| a == b` and `group NAME = basis([…])`.

use clebsch_symbolic::IntoList;
use proc_macro2::Ident;
use syn::ext::IdentExt;
use syn::parse::ParseStream;
use syn::{Expr, Token, Type};

use super::keys::Keys;
use super::spell_type;
use super::{Closure, closure, values};
use crate::diagnostic::{Diagnostic, Location, bail};

/// A group of the user's own.
#[derive(Clone)]
pub struct DeclaredGroup {
    pub(crate) name: Ident,
    pub(crate) definition: Definition,
}

/// The definition of a declared group.
#[derive(Clone)]
pub enum Definition {
    /// All matrices that satisfy an equation.
    Equation(Box<Closure>),
    /// The group of a Lie algebra, whose basis this is, and where the list stands.
    Basis(Vec<Expr>, Location),
}

/// The type of `= SO<3>`, where a group that is built in was written as a value.
fn assigned_type(stream: ParseStream) -> Option<Type> {
    let fork = stream.fork();
    fork.parse::<Token![=]>().ok()?;
    fork.parse::<Type>().ok().filter(|ty| matches!(ty, Type::Path(_) | Type::Tuple(_) | Type::Array(_)))
}

/// Reads the tokens after the word `group`.
pub(super) fn read(word: &Ident, stream: ParseStream, keys: &mut Keys) -> Result<(), Diagnostic> {
    if let Some(ty) = assigned_type(stream) {
        bail!(&ty, "`group` declares a group of one's own, and `{}` is a type", spell_type(&ty);
            help "write it in the action, as in `action = |F: {}, q| …`", spell_type(&ty);
            note "the type of the first argument of the action is the group");
    }
    let Ok(name) = stream.call(Ident::parse_any) else {
        bail!(word, "a group of one's own has a name";
            help "write `group Lorentz = |F: Matrix4| …`, and `F: Lorentz` in the action");
    };
    if keys.groups.iter().any(|group| group.name.unraw() == name.unraw()) {
        bail!(&name, "the group `{name}` is declared twice"; help "choose another name for one of the two");
    }
    let is_defined = stream.parse::<Token![=]>().is_ok();
    if is_defined && values::is_closure(stream) {
        let closure = closure::parse(stream)?;
        if let Some(closure) = Closure::read(word, closure, keys.diagnostics) {
            keys.groups.push(DeclaredGroup { name, definition: Definition::Equation(Box::new(closure)) });
        }
        return Ok(());
    }
    let place = if is_defined { stream.span() } else { name.span() };
    let is_word = is_defined && stream.parse::<Ident>().is_ok_and(|word| word == "basis");
    if !is_word || !stream.peek(syn::token::Paren) {
        bail!(place, "the group `{name}` is neither an equation nor a basis";
            help "write `group {name} = |F: Matrix3| F.transpose() * F == I` or `group {name} = basis([Matrix2::new(0, -1, 1, 0)])`");
    }
    // `([E1, E2])`
    let (arguments, span) = values::arguments(stream)?;
    let [Expr::Array(list)] = arguments.as_slice() else {
        bail!(span.join(), "the basis of `{name}` is a list of matrices";
            help "write `group {name} = basis([Matrix2::new(0, -1, 1, 0)])`");
    };
    let definition = Definition::Basis(list.elems.iter().cloned().into_list(), Location::from(list));
    keys.groups.push(DeclaredGroup { name, definition });
    Ok(())
}
