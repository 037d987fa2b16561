//! The implementation of the trait `Controlled`: what choosing the inputs needs.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::code::Nesting;
use super::{Generics, SystemEmitter, code, docs};
use crate::derive::Id;
use crate::lower::Kernel;

impl SystemEmitter<'_, '_> {
    /// The impl block, where something is chosen.
    pub(super) fn controlled(&self) -> TokenStream {
        let Some(control) = &self.model.control else { return TokenStream::new() };
        let (krate, scalar) = (&self.paths.krate, &self.paths.scalar);
        let Generics { parameters, arguments, predicates } = &self.generics;
        let (ident, name) = (&self.model.item.ident, self.model.item.ident.to_string());
        let [d, u, c, motions] = [self.place_dimension(), self.inputs(), control.bounds.len(), self.dimension()]
            .map(Literal::usize_unsuffixed);
        let texts = control.bounds.iter().map(|bound| bound.text.as_str());
        let motion = if self.is_steered() { self.steered() } else { self.forced() };
        let prices = self.prices();
        quote! {
            #[automatically_derived]
            impl<#parameters> #krate::Controlled<#d, #u, #c> for #ident<#arguments> #predicates {
                type Scalar = #scalar;

                const NAME: &'static ::core::primitive::str = #name;
                const BOUNDS: [&'static ::core::primitive::str; #c] = [#(#texts),*];
                const MOTIONS: ::core::primitive::usize = #motions;

                #motion
                #prices
            }
        }
    }

    /// The constant `DERIVATION` of a system that has no steps in time.
    pub(super) fn derivation_of_control(&self, text: &str) -> TokenStream {
        let Generics { parameters, arguments, predicates } = &self.generics;
        let ident = &self.model.item.ident;
        quote! {
            #[automatically_derived]
            impl<#parameters> #ident<#arguments> #predicates {
                /// The derivation of this struct in words and formulas.
                pub const DERIVATION: &'static ::core::primitive::str = #text;
            }
        }
    }

    /// The number of inputs.
    fn inputs(&self) -> usize {
        self.model.inputs.iter().map(|leaf| leaf.shape.len()).sum()
    }

    /// Whether inputs move the configuration by themselves, and are not those of forces.
    fn is_steered(&self) -> bool {
        self.kernels.find(Id::StepExpanded).is_some()
    }

    /// The dimension of what is steered: a configuration, or a state.
    fn place_dimension(&self) -> usize {
        if self.is_steered() { self.dimension() } else { 2 * self.dimension() }
    }

    /// The only output of a kernel, a scalar.
    fn scalar(&self, id: Id) -> TokenStream {
        let kernel = self.kernels.kernel(id);
        let scope = self.scope_of_system();
        let (locals, value) = (code::locals(&scope, kernel), scope.code(&kernel.outputs[0].1[0], false));
        quote!({ #locals #value })
    }

    /// The only output of a kernel, a matrix even where it has one entry.
    fn matrix(&self, id: Id) -> TokenStream {
        let kernel = self.kernels.kernel(id);
        let scope = self.scope_of_system();
        let (locals, (shape, entries)) = (code::locals(&scope, kernel), &kernel.outputs[0]);
        let value = code::grid(&scope, *shape, entries, false);
        quote!({ #locals #value })
    }

    /// All outputs of a kernel as matrices, in a tuple, but for those that are scalars by nature.
    fn tuple(&self, kernel: &Kernel, scalars: &[usize]) -> TokenStream {
        let scope = self.scope_of_system();
        let locals = code::locals(&scope, kernel);
        let outputs =
            kernel.outputs.iter().enumerate().map(|(index, (shape, entries))| match scalars.contains(&index) {
                true => scope.code(&entries[0], false),
                false => code::grid(&scope, *shape, entries, false),
            });
        quote!({ #locals (#(#outputs,)*) })
    }

    /// What inputs move by themselves.
    fn steered(&self) -> TokenStream {
        let (krate, private, scalar) = (&self.paths.krate, &self.paths.private, &self.paths.scalar);
        let (configuration, checks, defect) = (self.configuration_type(), self.checks(), self.orbit_defect());
        let (m, u) = (Literal::usize_unsuffixed(self.dimension()), Literal::usize_unsuffixed(self.inputs()));
        let scope = self.scope_of_system();
        let of_step = self.kernels.kernel(Id::Increment);
        let increment = code::body(&scope, of_step, Some(Nesting::Element));
        let advance = code::body(&scope, self.kernels.kernel(Id::Advance), Some(Nesting::Configuration));
        let moved = quote! {
            let (h, q) = (*constants, x);
            let d = { #increment };
            let next = { #advance };
        };
        let expand = self.tuple(self.kernels.kernel(Id::StepExpanded), &[2]);
        let of_time = self.matrix(Id::PriceOfTime);
        let (metric, approach) = (self.matrix(Id::OrbitMetric), self.matrix(Id::Approach));
        let documentation =
            docs::formulas("The step that an input makes.", self.rows.titled(Id::Controls), Some(of_step));
        let costate = quote!(#private::SVector<#scalar, #m>);
        let input = quote!(#private::SVector<#scalar, #u>);
        quote! {
            type Place = #configuration;
            type Constants = #scalar;

            fn prepare(&self, h: #scalar) -> ::core::result::Result<#scalar, #krate::Error> {
                #checks
                ::core::result::Result::Ok(h)
            }
            fn check_place(&self, q: &#configuration) -> ::core::result::Result<(), #krate::Error> {
                #private::check_on_orbit(q, { #defect })
            }
            #documentation
            #[inline]
            fn follow(&self, constants: &#scalar, t: #scalar, x: &#configuration, u: &#input) -> ::core::result::Result<#configuration, #krate::Error> {
                #moved
                #private::check_reached(next)
            }
            /// The step with its derivatives, and the second derivatives of ℓ + λ·η′.
            fn expand(
                &self,
                constants: &#scalar,
                t: #scalar,
                x: &#configuration,
                u: &#input,
                mu: &#costate,
            ) -> ::core::result::Result<#krate::Expansion<#configuration, #scalar, #m, #u>, #krate::Error> {
                #moved
                let next = #private::check_reached(next)?;
                let (by_place, by_input, price, price_by_place, price_by_input, place_curvature, mixed_curvature, input_curvature) = #expand;
                ::core::result::Result::Ok(#krate::Expansion {
                    next,
                    by_place,
                    by_input,
                    price,
                    price_by_place,
                    price_by_input,
                    place_curvature,
                    mixed_curvature,
                    input_curvature,
                })
            }
            /// d/dh (ℓ + λ·η′), the start of the step moving with h.
            fn price_of_time(
                &self,
                constants: &#scalar,
                t: #scalar,
                k: #scalar,
                x: &#configuration,
                u: &#input,
                mu: &#costate,
            ) -> ::core::result::Result<#scalar, #krate::Error> {
                #moved
                let slopes: #private::SVector<#scalar, 2> = #of_time;
                ::core::result::Result::Ok(slopes[0] + k * slopes[1])
            }
            /// Gᵀ(q* − q) and GᵀG.
            fn arrival(&self, x: &#configuration, target: &#configuration) -> #krate::Arrival<#scalar, #m> {
                let (q, next) = (x, target);
                #krate::Arrival { residual: #approach, slope: #metric }
            }
            /// The shortest motion that moves one configuration to another, to first order.
            fn displacement(&self, x: &#configuration, y: &#configuration) -> #costate {
                let (q, next) = (x, y);
                #private::displacement(&#metric, &#approach)
            }
        }
    }

    /// What the inputs of forces move.
    fn forced(&self) -> TokenStream {
        let (krate, private, scalar) = (&self.paths.krate, &self.paths.private, &self.paths.scalar);
        let configuration = self.configuration_type();
        let [m, u, d, w] =
            [self.dimension(), self.inputs(), 2 * self.dimension(), 2 * self.dimension() + self.inputs()]
                .map(Literal::usize_unsuffixed);
        let (constants_name, (_, constants_arguments)) = (&self.names.constants, self.constants_generics());
        let place = quote!((#configuration, #private::SVector<#scalar, #m>));
        let constants = quote!((#constants_name #constants_arguments, #scalar));
        let (costate, input) = (quote!(#private::SVector<#scalar, #d>), quote!(#private::SVector<#scalar, #u>));
        let by_input = self.tuple(self.kernels.kernel(Id::ByInput), &[]);
        let passed = quote! {
            let (constants, h) = (&constants.0, constants.1);
            let (q, n) = x;
            let d = &#krate::Variational::drift(self, constants, 0, t, q, n, u)?;
            let next = &#krate::Variational::advance(self, q, d);
            let edge = #krate::Variational::carried(self, constants, 0, t, q, d, next, u);
            let (before, after): (#private::SMatrix<#scalar, #m, #u>, #private::SMatrix<#scalar, #m, #u>) = #by_input;
            let link = #private::Link::new(&edge, &before, &after, costate).ok_or(#krate::Error::SingularTangent { step_size: #private::Scalar::to_f64(h) })?;
            let (mu, kappa) = (&link.costate, &link.multiplier);
        };
        let (curvature, bracket) = (self.matrix(Id::Bend), self.matrix(Id::Bracket));
        let of_time = self.matrix(Id::PriceOfTime);
        let price = self.tuple(self.kernels.kernel(Id::PriceExpanded), &[0]);
        quote! {
            type Place = #place;
            type Constants = #constants;

            fn prepare(&self, h: #scalar) -> ::core::result::Result<#constants, #krate::Error> {
                ::core::result::Result::Ok((#krate::Clebsch::constants(self, h)?, h))
            }
            fn check_place(&self, x: &#place) -> ::core::result::Result<(), #krate::Error> {
                #private::check_state(self, &x.0, &x.1)
            }
            /// The forced step.
            #[inline]
            fn follow(&self, constants: &#constants, t: #scalar, x: &#place, u: &#input) -> ::core::result::Result<#place, #krate::Error> {
                #private::forced_step(self, &constants.0, t, x, u)
            }
            /// The forced step with its derivatives, and the second derivatives of ℓ + λ·(η′, N⁺): with the multipliers κ of the momentum
            /// equation those of α·η′ + β·F⁺ℓd + κ·(F⁻ℓd − N), to which η′ contributes ± ½ α·[Ad η, ζ].
            fn expand(
                &self,
                constants: &#constants,
                t: #scalar,
                x: &#place,
                u: &#input,
                costate: &#costate,
            ) -> ::core::result::Result<#krate::Expansion<#place, #scalar, #d, #u>, #krate::Error> {
                #passed
                let curvature: #private::SMatrix<#scalar, #w, #w> = #curvature;
                let mu = &link.driving;
                let bracket: #private::SMatrix<#scalar, #m, #m> = #bracket;
                let (price, by_motion, by_input, motions, mixed, inputs) = #price;
                let price = #private::Price { price, by_motion, by_input, motions, mixed, inputs };
                let next = #private::check_reached((*next, edge.momentum))?;
                ::core::result::Result::Ok(link.expansion(next, &curvature, &bracket, &price))
            }
            /// d/dh (ℓ + λ·(η′, N⁺)), the start of the step moving with h.
            fn price_of_time(
                &self,
                constants: &#constants,
                t: #scalar,
                k: #scalar,
                x: &#place,
                u: &#input,
                costate: &#costate,
            ) -> ::core::result::Result<#scalar, #krate::Error> {
                #passed
                let slopes: #private::SVector<#scalar, 2> = #of_time;
                ::core::result::Result::Ok(slopes[0] + k * slopes[1])
            }
            /// (Gᵀ(q* − q), N* − N) and (GᵀG, I).
            fn arrival(&self, x: &#place, target: &#place) -> #krate::Arrival<#scalar, #d> {
                let metric = #krate::Variational::orbit_metric(self, &x.0);
                #private::arrival_of_state(&metric, &#krate::Variational::approach(self, &x.0, &target.0), &(target.1 - x.1))
            }
            /// The shortest motion that moves one configuration to another, to first order, and the change of the momentum.
            fn displacement(&self, x: &#place, y: &#place) -> #costate {
                let metric = #krate::Variational::orbit_metric(self, &x.0);
                let motion = #private::displacement(&metric, &#krate::Variational::approach(self, &x.0, &y.0));
                #private::pair(&motion, &(y.1 - x.1))
            }
        }
    }

    /// φ with its derivatives, at `q` and `t`.
    pub(super) fn endpoint_expanded(&self) -> Option<TokenStream> {
        let private = &self.paths.private;
        let tuple = self.tuple(self.kernels.find(Id::PriceOfEndExpanded)?, &[0, 1]);
        Some(quote! {
            let (price, by_time, slope, curvature) = #tuple;
            #private::endpoint(price, by_time, &slope, &curvature)
        })
    }

    /// Price, bounds and the price of the end.
    fn prices(&self) -> TokenStream {
        let (krate, private, scalar) = (&self.paths.krate, &self.paths.private, &self.paths.scalar);
        let [d, u, c] = [
            self.place_dimension(),
            self.inputs(),
            self.model.control.as_ref().map_or(0, |control| control.bounds.len()),
        ]
        .map(Literal::usize_unsuffixed);
        let (h, q) = match self.is_steered() {
            true => (quote!(*constants), quote!(x)),
            false => (quote!(constants.1), quote!(&x.0)),
        };
        let price = self.scalar(Id::Price);
        let (bounds, expanded) = (self.matrix(Id::Bounds), self.tuple(self.kernels.kernel(Id::BoundsExpanded), &[]));
        let endpoint = match self.kernels.find(Id::PriceOfEnd) {
            Some(_) => self.scalar(Id::PriceOfEnd),
            None => quote!(<#scalar as #private::Zero>::zero()),
        };
        let endpoint_expanded = self.endpoint_expanded().unwrap_or(quote!(#private::no_endpoint()));
        let documentation =
            docs::formulas("The price of a step.", self.rows.titled(Id::Price), self.kernels.find(Id::Price));
        let of_end = docs::formulas("The price of the end.", self.rows.titled(Id::PriceOfEnd), None);
        let of_bounds = docs::formulas("The bounds.", self.rows.titled(Id::Bounds), self.kernels.find(Id::Bounds));
        quote! {
            #documentation
            #[inline]
            fn price(&self, constants: &Self::Constants, t: #scalar, x: &Self::Place, u: &#private::SVector<#scalar, #u>) -> #scalar {
                let (h, q) = (#h, #q);
                #price
            }
            #of_bounds
            #[inline]
            fn bounds(&self, t: #scalar, x: &Self::Place, u: &#private::SVector<#scalar, #u>) -> #private::SVector<#scalar, #c> {
                let q = #q;
                #bounds
            }
            /// The bounds with their derivatives, and the second derivatives of z·a.
            fn bounds_expanded(
                &self,
                t: #scalar,
                x: &Self::Place,
                u: &#private::SVector<#scalar, #u>,
                z: &#private::SVector<#scalar, #c>,
            ) -> #krate::BoundsExpansion<#scalar, #d, #u, #c> {
                let q = #q;
                let (values, by_motion, by_input, motions, mixed, inputs) = #expanded;
                #private::bounds(values, &by_motion, by_input, &motions, &mixed, inputs)
            }
            #of_end
            fn endpoint(&self, t: #scalar, x: &Self::Place) -> #scalar {
                let q = #q;
                #endpoint
            }
            /// The price of the end with its derivatives.
            fn endpoint_expanded(&self, t: #scalar, x: &Self::Place) -> #krate::EndpointExpansion<#scalar, #d> {
                let q = #q;
                #endpoint_expanded
            }
        }
    }
}
