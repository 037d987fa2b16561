//! What is emitted beside an error, so that the user sees that error alone and the editor keeps working.

use proc_macro2::TokenStream;

/// Nothing yet.
pub fn stub(_item: TokenStream) -> TokenStream {
    TokenStream::new()
}
