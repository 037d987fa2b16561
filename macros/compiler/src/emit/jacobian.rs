//! How linear systems with the Jacobian of an equation are solved.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::equation::EquationType;
use super::scope::{index, size};
use crate::derive::{Solution, Structure};

impl EquationType<'_, '_, '_> {
    /// The solution of linear systems with the Jacobian, where it is symmetric or block triangular.
    pub(super) fn correct(&self) -> Option<TokenStream> {
        let (private, vector) = (&self.emitter.paths.private, &self.vector);
        let matrix = self.emitter.paths.matrix(self.solve.dimension, self.solve.dimension);
        let (title, body) = match &self.solve.structure {
            Structure::Dense | Structure::Sylvester(_) => return None,
            _ if !matches!(self.solve.solution, Solution::Newton | Solution::Linear) => return None,
            Structure::Symmetric => {
                ("Dρ is symmetric: LDLᵀ where it is definite.", quote!(#private::solve_symmetric(a, b)))
            }
            Structure::Triangular(blocks) => {
                ("Dρ is block triangular: one small system for each block.", self.by_blocks(blocks))
            }
        };
        Some(quote! {
            #[doc = #title]
            #[inline]
            fn correct(a: &#matrix, b: &#vector) -> #private::Option<(#vector, #private::Orientation)> {
                #body
            }
        })
    }

    /// One small system for each block, with the unknowns of those before it put in.
    fn by_blocks(&self, blocks: &[Vec<usize>]) -> TokenStream {
        let private = &self.emitter.paths.private;
        let systems = blocks.iter().enumerate().map(|(number, block)| {
            let known = blocks[..number].concat();
            let rows = block.iter().map(|&i| {
                let entries = block.iter().map(|&j| index(false, (i, j)));
                quote!([#(a #entries),*])
            });
            let right = block.iter().map(|&i| {
                let known = known.iter().filter(|&&j| !self.emitter.program.is_zero(self.solve, i, j));
                let terms = known.map(|&j| {
                    let (a, x) = (index(false, (i, j)), format_ident!("x{j}"));
                    quote!(- a #a * #x)
                });
                let i = size(i);
                quote!(b[#i] #(#terms)*)
            });
            let (x, sign) = (format_ident!("solution{number}"), format_ident!("sign{number}"));
            let names = block.iter().map(|i| format_ident!("x{i}"));
            let positions = (0..block.len()).map(size);
            quote! {
                let (#x, #sign) = #private::solve_dense(
                    &#private::matrix([#(#rows),*]),
                    &#private::vector([#(#right),*]),
                )?;
                let [#(#names),*] = [#(#x[#positions]),*];
            }
        });
        let names = (0..self.solve.dimension).map(|i| format_ident!("x{i}"));
        let signs = (1..blocks.len()).map(|number| format_ident!("sign{number}"));
        let sign = signs.fold(quote!(sign0), |product, sign| quote!(#product * #sign));
        quote! {
            #(#systems)*
            #private::Some((#private::vector([#(#names),*]), #sign))
        }
    }
}
