//! Steps of order 16: Hamilton's equations at all stages, found by sweeps over them.

use clebsch_symbolic::{IntoList, both};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::functions::HAMILTON_EQUATIONS;
use super::scope::{index, nested, size};
use super::{Emitter, flag};
use crate::derive::Id;

impl Emitter<'_, '_> {
    /// The implementation of `HamiltonEquations`: the slope of (q, p), the covector of a momentum, and a guess.
    pub(super) fn hamilton_equations(&self) -> TokenStream {
        let (numbers, times) = (self.numbers_of_pair(), self.terms_of_time());
        let (scope, count) = (self.scope_of_step(), size(self.formulas.weighted().len()));
        let words = |word: &str| {
            let [q, p] = both([quote!(q), quote!(p)], |name| self.entries(&name));
            Some(match word {
                "Numbers" => quote!([T; #numbers]),
                "Times" => quote!([T; #times]),
                "Equations" => self.trait_of_parts("HamiltonEquations", &[numbers.clone(), times.clone()]),
                "Slopes" | "Found" => {
                    let id = if word == "Slopes" { Id::HamiltonEquations } else { Id::TermsOfTime };
                    let outputs = self.program.kernel(id).outputs.iter();
                    let entries = outputs.flat_map(|(_, entries)| entries).map(|entry| scope.code(entry, false));
                    quote!([#(#entries),*])
                }
                "Weights" => quote!([<T as runtime::One>::one(); #count]),
                // all entries of q and then those of p
                "Joined" => quote!([#(#q,)* #(#p),*]),
                "Parted" => {
                    let (q, p) = (self.built(0), self.built(q.len()));
                    quote!((#q, #p))
                }
                _ => return self.word_of_step(word),
            })
        };
        let functions = self.functions(HAMILTON_EQUATIONS, (0, 0), &words, |function, kernel| {
            let is_weighted = !self.formulas.weighted().is_empty();
            match function.name {
                "part" if function.code.contains("Weights") != is_weighted => None,
                "slope" => Some(function.written(&scope, kernel, &words)?.inlined(quote!(#[inline(always)]))),
                _ => function.written(&scope, kernel, &words),
            }
        });
        let tolerance = self.tolerance().map(|part| quote!(const TOLERANCE: ::core::primitive::f64 = #part;));
        let most = self.iterations().map(|most| quote!(const SWEEPS: ::core::primitive::u32 = #most;));
        let collocation = self.formulas.collocation.as_ref();
        let affine = collocation.filter(|collocation| collocation.is_affine).map(|_| flag("IS_AFFINE", true));
        self.implementation("HamiltonEquations", &[numbers, times], quote!(#tolerance #most #affine #functions))
    }

    /// The entries of a configuration, leaf by leaf and rows first.
    fn entries(&self, name: &TokenStream) -> Vec<TokenStream> {
        let leaves = self.model.configurations.iter();
        let entries = leaves.flat_map(|leaf| leaf.shape.positions().map(move |position| (leaf, position)));
        let entries = entries.map(|(leaf, position)| {
            let (access, index) = (&leaf.accessor, index(leaf.shape.columns == 1, position));
            quote!(#name #access #index)
        });
        entries.into_list()
    }

    /// The configuration whose entries stand in the array `y` from `start` on.
    fn built(&self, start: usize) -> TokenStream {
        let leaves = &self.model.configurations;
        nested(&self.model.configuration, &mut |leaf| {
            let offset = start + leaves[..leaf].iter().map(|leaf| leaf.shape.len()).sum::<usize>();
            let positions = (offset..offset + leaves[leaf].shape.len()).map(size);
            let entries: Vec<TokenStream> = positions.map(|position| quote!(y[#position])).into_list();
            let rows = entries.chunks(leaves[leaf].shape.columns).map(|row| quote!([#(#row),*]));
            match leaves[leaf].shape.columns {
                _ if leaves[leaf].is_quaternion => quote!(runtime::quaternion([#(#entries),*])),
                1 => quote!(runtime::vector([#(#entries),*])),
                _ => quote!(runtime::matrix([#(#rows),*])),
            }
        })
    }

    /// How many numbers slopes take of the time alone.
    pub(super) fn terms_of_time(&self) -> Literal {
        size(self.program.find(Id::TermsOfTime).map_or(0, |kernel| kernel.outputs.len()))
    }

    /// How many entries q and p have.
    pub(super) fn numbers_of_pair(&self) -> Literal {
        size(2 * self.model.configurations.iter().map(|leaf| leaf.shape.len()).sum::<usize>())
    }
}
