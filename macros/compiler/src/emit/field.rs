//! The implementations of `FieldSite` and `Field`: the energies of the edges between sites, and the forces on sites.

use clebsch_symbolic::IntoList;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::function::{Body, no_words};
use super::functions::{CONNECTION, FIELD, FIELD_SITE, MIDPOINT};
use super::scope::{Scope, size};
use super::system::matrix_of_kernel;
use super::{Emitter, flag};
use crate::derive::{Id, Solution};
use crate::lower::{Solve, Step};
use crate::model::LeafSpace;

impl Emitter<'_, '_> {
    /// The implementations of `FieldSite` and of `Field`, where there are edges.
    pub(super) fn field(&self) -> TokenStream {
        let Some(field) = &self.formulas.field else { return TokenStream::new() };
        let count = field.edges.len();
        let directions = size(count);
        let words = |word: &str| match word {
            "Index" => Some(quote!(::core::primitive::usize)),
            "Spacings" => Some(quote!([T; #directions])),
            "Neighbours" => Some(quote!([&Q; #directions])),
            _ => None,
        };
        let scope = self.scope_of_system();
        let ends = quote!(let (q0, q1) = (q, next););
        // the group element of an edge, and its coordinates
        let element = self.program.find(Id::EdgeElement).map(|kernel| {
            let (locals, element) = (scope.locals(kernel), scope.element(kernel, 0));
            let coordinates = self.program.find(Id::EdgeCoordinates).map(|kernel| {
                let coordinates = scope.body(kernel);
                quote!(let x: &Mu = &{ #coordinates };)
            });
            let logarithm = self.program.find(Id::EdgeLogarithm).map(|kernel| {
                let coordinates = scope.body(kernel);
                quote!(let y: &Mu = &{ #coordinates };)
            });
            quote!(let f: &F = &{ #locals #element }; #coordinates #logarithm)
        });
        // one arm for each direction
        let of_edges = |id: fn(usize) -> Id, value: &dyn Fn(usize) -> TokenStream| {
            let arms = (0..count).map(|direction| {
                let kernel = self.program.kernel(id(direction));
                let element = element.as_ref().filter(|_| !field.edges[direction].element.is_empty());
                let (locals, value) = (scope.locals(kernel), value(direction));
                quote!(#element #locals #value)
            });
            let mut arms = arms.into_list();
            let last = arms.pop();
            let numbers = (0..arms.len()).map(size);
            if arms.is_empty() {
                quote!(#ends #last)
            } else {
                quote!(#ends match direction { #(#numbers => { #arms })* _ => { #last } })
            }
        };
        let scope_of_forces = &scope;
        let both = |id: fn(usize) -> Id| {
            move |direction| {
                let kernel = self.program.kernel(id(direction));
                let [own, next] = [0, 1].map(|output| scope_of_forces.output(kernel, output));
                quote!((#own, #next))
            }
        };
        let functions = self.functions(FIELD, (0, 0), &words, |function, kernel| {
            Some(match function.name {
                "edge_energy" => Body::from(of_edges(Id::EdgeEnergy, &|direction| {
                    scope.scalar(self.program.kernel(Id::EdgeEnergy(direction)), 0)
                })),
                "edge_forces" => Body::from(of_edges(Id::EdgeForces, &both(Id::EdgeForces))),
                "edge_forces_along" => Body::from(of_edges(Id::EdgeForcesAlong, &both(Id::EdgeForcesAlong))),
                "force_inside" => {
                    let places = (0..count).map(|direction| {
                        let (after, before) =
                            (format_ident!("q{}", 1 + 2 * direction), format_ident!("q{}", 2 + 2 * direction));
                        let direction = size(direction);
                        quote!(let (#after, #before) = (after[#direction], before[#direction]);)
                    });
                    function.computes(&scope, kernel?).after(Some(quote!(let q0 = q; #(#places)*)))
                }
                _ => function.computes(&scope, kernel?),
            })
        });
        let (order, gathers) = (self.model.declared_order().number(), flag("GATHERS", self.program.gathers_edges()));
        let has_potential = flag("HAS_POTENTIAL", !field.force_of_site.is_empty());
        let (system, parts) = (self.target.of_type(), self.trait_of_parts("Parts", &[]));
        let words = |word: &str| (word == "PartsOf").then(|| quote!(<#system as #parts>));
        let of_site = self.written(FIELD_SITE, &scope, &words);
        let order = quote!(const ORDER_OF_FIELD: ::core::primitive::u32 = #order;);
        let drifted = self.drifted();
        let site =
            self.target.derived(Some(quote!(runtime::FieldSite)), quote!(#has_potential #order #of_site #drifted));
        let edges = self.target.derived(Some(quote!(runtime::Field<#directions>)), quote!(#gathers #functions));
        let marker = if field.is_static { quote!(runtime::StaticField) } else { quote!(runtime::MovingField) };
        let marker = self.target.derived(Some(marker), TokenStream::new());
        let connection = self.model.emit.connection.then(|| {
            let element = self.functions(CONNECTION, (0, 0), &words, |function, kernel| {
                Some(function.computes(&scope, kernel?).after(Some(ends.clone())))
            });
            self.target.derived(Some(quote!(runtime::ConnectedField)), element)
        });
        let midpoint = field.midpoint.is_some().then(|| self.midpoint(&scope));
        quote!(#site #edges #marker #connection #midpoint)
    }

    /// The implementation of `MidpointSite`.
    fn midpoint(&self, scope: &Scope<'_, '_>) -> TokenStream {
        // an equation reads G, and the Cayley coordinates or the logarithm of G²
        let read = |id: Id, name: &str| {
            let (name, coordinates) = (format_ident!("{name}"), scope.body(self.program.find(id)?));
            Some(quote!(let #name: &Mu = &{ #coordinates };))
        };
        let doubled = [read(Id::HalfStepDoubled, "x"), read(Id::HalfStepLogarithm, "y")];
        let doubled: TokenStream = doubled.into_iter().flatten().collect();
        let functions = self.functions(MIDPOINT, (0, 0), &no_words, |function, kernel| {
            function.written(scope, kernel, &|word| match word {
                "Doubled" => Some(doubled.clone()),
                _ => matrix_of_kernel(scope, kernel?, word),
            })
        });
        let dimension = size(self.dimension);
        self.target.derived(Some(quote!(runtime::MidpointSite<#dimension>)), functions)
    }

    /// The momentum equation of a field whose drift moves q alone, by a formula of the momentum alone.
    pub(super) fn drifts_alone(&self) -> Option<&Solve> {
        let is_field = self.formulas.field.as_ref().is_some_and(|field| !field.is_static);
        let [Step { solves, .. }] = &self.program.steps[..] else { return None };
        let [solve] = &solves[..] else { return None };
        let is_formula = matches!(solve.solution, Solution::ClosedForm | Solution::Explicit);
        let are_all = |some: &[usize]| some.iter().copied().eq(0..self.dimension);
        let is_alone = is_formula && are_all(&solve.components) && are_all(&solve.momenta) && !solve.moves;
        let others = [
            Id::StartKick(0),
            Id::EndKick(0),
            Id::RestKick(0),
            Id::StartForce(0),
            Id::MovingForce(0),
            Id::EndForce(0),
            Id::MomentumAfter(0),
        ];
        let moves_alone = !others.into_iter().any(|id| self.program.find(id).is_some());
        (is_field && is_alone && moves_alone && !solve.reads_input && self.is_short()).then_some(solve)
    }

    /// The drift of such a site.
    fn drifted(&self) -> Option<TokenStream> {
        let solve = self.drifts_alone()?;
        let (equation, configuration) = (self.equation_name(solve), quote!(runtime::Option<Q>));
        let method = match solve.solution {
            Solution::Explicit => quote!(explicit),
            _ => quote!(closed_form_or_nan),
        };
        let is_unit = matches!(&self.model.configurations[..], [leaf] if leaf.space == LeafSpace::Unit && leaf.accessor.is_whole());
        let mended = if is_unit {
            Some(quote!(runtime::near_length_one(q)))
        } else {
            self.on_space().map(|on_space| {
                quote! {
                    let (q, rest) = (q, ());
                    let (q, ()) = #on_space;
                    (q, runtime::is_finite(&q))
                }
            })
        };
        let mended = mended.map(|mended| {
            let mends = flag("MENDS", true);
            quote! {
                #mends
                #[inline(always)]
                fn mended(q: Q) -> (Q, ::core::primitive::bool) { #mended }
            }
        });
        Some(quote! {
            #[inline(always)]
            fn drifted(&self, c: &C, q: &Q, mu: &Mu) -> #configuration {
                runtime::Some(runtime::drifted(self, q, &#equation::#method(&#equation(self, c), mu)))
            }
            #mended
        })
    }
}
