//! The door of the compiler: the derive macro `Clebsch`. Everything behind it is the library `clebsch-compiler`.

use proc_macro::TokenStream;

#[doc = include_str!("../reference.md")]
#[proc_macro_derive(Clebsch, attributes(clebsch))]
pub fn derive_clebsch(item: TokenStream) -> TokenStream {
    clebsch_compiler::expand(item.into()).into()
}
