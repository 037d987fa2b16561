//! The door of the compiler: the derive macro `Clebsch`. Everything behind it is the library `clebsch-compiler`.

use proc_macro::TokenStream;

/// Derives the integrator of a mechanical system from the closures in `#[clebsch(…)]`; see the crate `clebsch`.
#[proc_macro_derive(Clebsch, attributes(clebsch))]
pub fn derive_clebsch(item: TokenStream) -> TokenStream {
    clebsch_compiler::expand(item.into()).into()
}
