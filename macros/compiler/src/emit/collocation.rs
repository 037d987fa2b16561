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
        let (private, scalar, numbers) = (&self.paths.private, &self.paths.scalar, self.numbers_of_pair());
        let words = [("Numbers", quote!([#scalar; #numbers])), ("X", self.coordinates_type())];
        let functions = self.functions(HAMILTON_EQUATIONS, (0, 0), &words, |function, kernel| {
            let scope = self.scope_of_step();
            let code = match function.name {
                "step_size" => quote!(c.step_size),
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
                        quote!((*x * part, [<#scalar as #private::One>::one(); #count]))
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
                _ => return Some(function.computes(&scope, kernel?)),
            };
            Some(Body::from(code))
        });
        let (dials, collocation) = (self.dials_of_sweeps(), self.formulas.collocation.as_ref());
        let affine = collocation.filter(|collocation| collocation.is_affine).map(|_| flag("IS_AFFINE", true));
        self.implementation("HamiltonEquations", &[numbers], quote!(#dials #affine #functions))
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
        let (private, leaves) = (&self.paths.private, &self.model.configurations);
        nested(&self.model.configuration, &mut |leaf| {
            let offset = start + leaves[..leaf].iter().map(|leaf| leaf.shape.len()).sum::<usize>();
            let positions = (offset..offset + leaves[leaf].shape.len()).map(size);
            let entries: Vec<TokenStream> = positions.map(|position| quote!(y[#position])).collect();
            let rows = entries.chunks(leaves[leaf].shape.columns).map(|row| quote!([#(#row),*]));
            match leaves[leaf].shape.columns {
                _ if leaves[leaf].is_quaternion => quote!(#private::quaternion([#(#entries),*])),
                1 => quote!(#private::vector([#(#entries),*])),
                _ => quote!(#private::matrix([#(#rows),*])),
            }
        })
    }

    /// How many entries q and p have.
    pub(super) fn numbers_of_pair(&self) -> Literal {
        size(2 * self.model.configurations.iter().map(|leaf| leaf.shape.len()).sum::<usize>())
    }
}
