//! Steps of order 16: Hamilton's equations at all stages, found by sweeps over them.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::function::Body;
use super::functions::HAMILTON_EQUATIONS;
use super::scope::{index, nested, size};
use super::{Emitter, flag};

impl Emitter<'_, '_> {
    /// The implementation of `HamiltonEquations`: the slope of (q, p), the covector of a momentum, and a guess.
    pub(super) fn hamilton_equations(&self) -> TokenStream {
        let numbers = self.numbers_of_pair();
        let words = |word: &str| match word {
            "Numbers" => Some(quote!([T; #numbers])),
            _ => self.word_of_step(word),
        };
        let functions = self.functions(HAMILTON_EQUATIONS, (0, 0), &words, |function, kernel| {
            let scope = self.scope_of_step();
            let code = match function.name {
                "slope" => {
                    let (kernel, equations) =
                        (kernel?, self.trait_of_parts("HamiltonEquations", &[self.numbers_of_pair()]));
                    let (locals, entries) =
                        (scope.locals(kernel), kernel.outputs.iter().flat_map(|(_, entries)| entries));
                    let entries = entries.map(|entry| scope.code(entry, false));
                    let code = quote!(let (q, p) = <Self as #equations>::parted(y); #locals [#(#entries),*]);
                    return Some(Body::new(kernel, code).inlined(quote!(#[inline(always)])));
                }
                "part" => match self.formulas.weighted().len() {
                    0 => quote!(*x * part),
                    count => {
                        let count = size(count);
                        quote!((*x * part, [<T as runtime::One>::one(); #count]))
                    }
                },
                // all entries of q and then those of p
                "joined" => {
                    let [q, p] = [quote!(q), quote!(p)].map(|name| self.entries(&name));
                    quote!([#(#q,)* #(#p),*])
                }
                "parted" => {
                    let (q, p) = (self.built(0), self.built(self.entries(&quote!(q)).len()));
                    quote!((#q, #p))
                }
                _ => return function.written(&scope, kernel, &words),
            };
            Some(Body::from(code))
        });
        let tolerance = self.tolerance().map(|part| quote!(const TOLERANCE: ::core::primitive::f64 = #part;));
        let most = self.iterations().map(|most| quote!(const SWEEPS: ::core::primitive::u32 = #most;));
        let collocation = self.formulas.collocation.as_ref();
        let affine = collocation.filter(|collocation| collocation.is_affine).map(|_| flag("IS_AFFINE", true));
        self.implementation("HamiltonEquations", &[numbers], quote!(#tolerance #most #affine #functions))
    }

    /// The entries of a configuration, leaf by leaf and rows first.
    fn entries(&self, name: &TokenStream) -> Vec<TokenStream> {
        let leaves = self.model.configurations.iter();
        let entries = leaves.flat_map(|leaf| leaf.shape.positions().map(move |position| (leaf, position)));
        let entries = entries.map(|(leaf, position)| {
            let (access, index) = (&leaf.accessor, index(leaf.shape.columns == 1, position));
            quote!(#name #access #index)
        });
        entries.collect()
    }

    /// The configuration whose entries stand in the array `y` from `start` on.
    fn built(&self, start: usize) -> TokenStream {
        let leaves = &self.model.configurations;
        nested(&self.model.configuration, &mut |leaf| {
            let offset = start + leaves[..leaf].iter().map(|leaf| leaf.shape.len()).sum::<usize>();
            let positions = (offset..offset + leaves[leaf].shape.len()).map(size);
            let entries: Vec<TokenStream> = positions.map(|position| quote!(y[#position])).collect();
            let rows = entries.chunks(leaves[leaf].shape.columns).map(|row| quote!([#(#row),*]));
            match leaves[leaf].shape.columns {
                _ if leaves[leaf].is_quaternion => quote!(runtime::quaternion([#(#entries),*])),
                1 => quote!(runtime::vector([#(#entries),*])),
                _ => quote!(runtime::matrix([#(#rows),*])),
            }
        })
    }

    /// How many entries q and p have.
    pub(super) fn numbers_of_pair(&self) -> Literal {
        size(2 * self.model.configurations.iter().map(|leaf| leaf.shape.len()).sum::<usize>())
    }
}
