//! Steps of order 16: Hamilton's equations at all stages, found by sweeps over them.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::code::{self, Nesting};
use super::{Emitter, docs};
use crate::derive::Id;

impl Emitter<'_, '_> {
    /// The implementation of `HamiltonEquations`: the slope of (q, p), the covector of a momentum, and a guess.
    pub(super) fn hamilton_equations(&self) -> TokenStream {
        let numbers = self.numbers_of_pair();
        let (dials, size) = (self.dials_of_sweeps(), self.size_of_step());
        let (slope, covector, guess) = (self.slope(), self.covector(), self.guess());
        let momentum = self.momentum_of_step();
        let pair = self.pair();
        self.implementation(
            "HamiltonEquations",
            &[&numbers],
            quote!(#dials #size #slope #covector #momentum #guess #pair),
        )
    }

    /// Where sweeps end, and whether J is affine in q.
    fn dials_of_sweeps(&self) -> TokenStream {
        let tolerance = self.model.dials.tolerance.as_ref().map(|tolerance| {
            let part = Literal::f64_unsuffixed(tolerance.value);
            quote!(const TOLERANCE: ::core::primitive::f64 = #part;)
        });
        let most = self.model.dials.iterations.as_ref().map(|iterations| {
            let most = Literal::u32_unsuffixed(iterations.value);
            quote!(const SWEEPS: ::core::primitive::u32 = #most;)
        });
        let is_affine = self.program.formulas.collocation.as_ref().is_some_and(|collocation| collocation.is_affine);
        let affine = is_affine.then(|| {
            quote!(
                const IS_AFFINE: ::core::primitive::bool = true;
            )
        });
        quote!(#tolerance #most #affine)
    }

    /// (q′, p′), in the order of their entries.
    fn slope(&self) -> TokenStream {
        let (scalar, numbers, constants) = (&self.paths.scalar, self.pair_type(), self.constants_of_step());
        let formulas = self.program.formulas.titled(Id::HamiltonEquations);
        let kernel = self.program.kernel(Id::HamiltonEquations);
        let documentation = docs::formulas(
            "Hamilton's equations: (q′, p′) at y = (q, p), all entries of q and then those of p, rows first.",
            formulas,
            Some(kernel),
        );
        let equations = self.trait_of_parts("HamiltonEquations", &[&self.numbers_of_pair()]);
        let scope = self.scope_of_step();
        let locals = code::locals(&scope, kernel);
        let entries = kernel.outputs.iter().flat_map(|(_, entries)| entries);
        let entries = entries.map(|entry| scope.code(entry, false));
        quote! {
            #documentation
            #[inline(always)]
            fn slope(&self, c: &#constants, t: #scalar, y: &#numbers) -> #numbers {
                let (q, p) = <Self as #equations>::parted(y);
                #locals
                [#(#entries),*]
            }
        }
    }

    fn covector(&self) -> TokenStream {
        let constants = self.constants_of_step();
        let (configuration, momentum) = (self.configuration_type(), self.momentum_type());
        let signature = quote!(covector(&self, c: &#constants, q: &#configuration, mu: &#momentum) -> #configuration);
        self.part(
            "A covector p at q with the momentum J(q, p) = μ.",
            &[],
            signature,
            self.program.kernel(Id::Covector),
            Some(Nesting::Configuration),
        )
    }

    fn momentum_of_step(&self) -> Option<TokenStream> {
        let (configuration, momentum) = (self.configuration_type(), self.momentum_type());
        let signature = quote!(momentum(&self, q: &#configuration, p: &#configuration) -> #momentum);
        let kernel = self.program.find(Id::MomentumOfStep)?;
        Some(self.part("J(q, p), entry by entry.", &[], signature, kernel, None))
    }

    /// Where the motion with the velocity of the start leads.
    fn guess(&self) -> TokenStream {
        let (private, scalar, constants) = (&self.paths.private, &self.paths.scalar, self.constants_of_step());
        let (configuration, momentum) = (self.configuration_type(), self.momentum_type());
        let coordinates = self.coordinates_type();
        let guess = self.part(
            "The chart coordinates x of the motion by the velocity ξ = Σ⁻¹(μ − A) for the time h, to first order in h.",
            &[],
            quote!(guess(&self, c: &#constants, t: #scalar, q: &#configuration, mu: &#momentum) -> #momentum),
            self.program.kernel(Id::Guess),
            None,
        );
        let x = match self.program.formulas.weighted().len() {
            0 => quote!(*x * part),
            count => {
                let count = Literal::usize_unsuffixed(count);
                quote!((*x * part, [<#scalar as #private::One>::one(); #count]))
            }
        };
        quote! {
            #guess
            #[inline]
            fn part(x: &#momentum, part: #scalar) -> #coordinates {
                #x
            }
        }
    }

    /// (q, p) as an array of their entries, and back.
    fn pair(&self) -> TokenStream {
        let (configuration, numbers) = (self.configuration_type(), self.pair_type());
        let (joined, q, p) = (self.flat(), self.built("y", 0), self.built("y", self.entries().count()));
        quote! {
            #[inline]
            fn joined(q: &#configuration, p: &#configuration) -> #numbers {
                #joined
            }
            #[inline]
            fn parted(y: &#numbers) -> (#configuration, #configuration) {
                (#q, #p)
            }
        }
    }

    /// The entries of a configuration, leaf by leaf and rows first: how each is reached.
    fn entries(&self) -> impl Iterator<Item = (TokenStream, TokenStream)> {
        self.model.configurations.iter().flat_map(|leaf| {
            leaf.shape.positions().map(move |(i, j)| {
                let (row, column) = (Literal::usize_unsuffixed(i), Literal::usize_unsuffixed(j));
                let index = if leaf.shape.columns == 1 { quote!([#row]) } else { quote!([(#row, #column)]) };
                (code::accessor(&leaf.accessor), index)
            })
        })
    }

    /// The entries of q and then those of p, in one array.
    fn flat(&self) -> TokenStream {
        let read = |name: &str| -> Vec<TokenStream> {
            let name = format_ident!("{name}");
            self.entries().map(|(access, index)| quote!(#name #access #index)).collect()
        };
        let (q, p) = (read("q"), read("p"));
        quote!([#(#q,)* #(#p),*])
    }

    /// The configuration whose entries stand in an array from `start` on.
    fn built(&self, array: &str, start: usize) -> TokenStream {
        let (private, array) = (&self.paths.private, format_ident!("{array}"));
        let offsets = self.model.configurations.iter().scan(start, |next, leaf| {
            let offset = *next;
            *next += leaf.shape.len();
            Some(offset)
        });
        let offsets: Vec<usize> = offsets.collect();
        code::nested(&self.model.configuration, &mut |leaf| {
            let (configuration, offset) = (&self.model.configurations[leaf], offsets[leaf]);
            let entries: Vec<TokenStream> = (offset..offset + configuration.shape.len())
                .map(|position| {
                    let position = Literal::usize_unsuffixed(position);
                    quote!(#array[#position])
                })
                .collect();
            let rows = entries.chunks(configuration.shape.columns).map(|row| quote!([#(#row),*]));
            match configuration.shape.columns {
                _ if configuration.is_quaternion => quote!(#private::quaternion([#(#entries),*])),
                1 => quote!(#private::vector([#(#entries),*])),
                _ => quote!(#private::matrix([#(#rows),*])),
            }
        })
    }

    /// The type of all entries of q and p.
    fn pair_type(&self) -> TokenStream {
        let (scalar, count) = (&self.paths.scalar, self.numbers_of_pair());
        quote!([#scalar; #count])
    }

    /// How many entries q and p have.
    pub(super) fn numbers_of_pair(&self) -> Literal {
        Literal::usize_unsuffixed(2 * self.entries().count())
    }
}
