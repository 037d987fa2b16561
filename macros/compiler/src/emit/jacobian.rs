//! How linear systems with the Jacobian of an equation are solved, and the sign of its determinant.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::Emitter;
use crate::derive::Structure;
use crate::lower::Solve;

impl Emitter<'_, '_> {
    /// The sign of det Dρ at the identity, where it is a constant.
    pub(super) fn orientation(&self, index: usize, number: usize, solve: &Solve) -> Option<TokenStream> {
        let (private, suffix) = (&self.paths.private, self.program.suffix(index));
        self.has_orientation(solve).then(|| {
            let field = format_ident!("orientation{suffix}_{}", number + 1);
            quote! {
                #[inline]
                fn orientation(&self) -> #private::Option<#private::Orientation> {
                    #private::Some(self.1.#field)
                }
            }
        })
    }

    /// The solution of linear systems with the Jacobian, where it is symmetric or block triangular.
    pub(super) fn correct(&self, solve: &Solve) -> Option<TokenStream> {
        let private = &self.paths.private;
        let vector = self.vector_type(solve.dimension);
        let matrix = self.paths.matrix(solve.dimension, solve.dimension);
        let (title, body) = match &solve.structure {
            Structure::Dense | Structure::Sylvester(_) => return None,
            Structure::Symmetric => {
                ("Dρ is symmetric: LDLᵀ where it is definite.", quote!(#private::solve_symmetric(a, b)))
            }
            Structure::Triangular(blocks) => {
                ("Dρ is block triangular: one small system for each block.", self.by_blocks(solve, blocks))
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
    fn by_blocks(&self, solve: &Solve, blocks: &[Vec<usize>]) -> TokenStream {
        let private = &self.paths.private;
        let systems = blocks.iter().enumerate().map(|(number, block)| {
            let known = blocks[..number].concat();
            let rows = block.iter().map(|&i| {
                let entries = block.iter().map(|&j| entry(i, j));
                quote!([#(#entries),*])
            });
            let right = block.iter().map(|&i| {
                let terms = known.iter().filter(|&&j| !self.program.is_zero(solve, i, j)).map(|&j| {
                    let (a, x) = (entry(i, j), format_ident!("x{j}"));
                    quote!(- #a * #x)
                });
                let i = Literal::usize_unsuffixed(i);
                quote!(b[#i] #(#terms)*)
            });
            let (x, sign) = (format_ident!("solution{number}"), format_ident!("sign{number}"));
            let names = block.iter().map(|i| format_ident!("x{i}"));
            let positions = (0..block.len()).map(Literal::usize_unsuffixed);
            quote! {
                let (#x, #sign) = #private::solve_dense(
                    &#private::matrix([#(#rows),*]),
                    &#private::vector([#(#right),*]),
                )?;
                let [#(#names),*] = [#(#x[#positions]),*];
            }
        });
        let names = (0..solve.dimension).map(|i| format_ident!("x{i}"));
        let signs = (1..blocks.len()).map(|number| format_ident!("sign{number}"));
        let sign = signs.fold(quote!(sign0), |product, sign| quote!(#product * #sign));
        quote! {
            #(#systems)*
            #private::Some((#private::vector([#(#names),*]), #sign))
        }
    }
}

fn entry(i: usize, j: usize) -> TokenStream {
    let (i, j) = (Literal::usize_unsuffixed(i), Literal::usize_unsuffixed(j));
    quote!(a[(#i, #j)])
}
