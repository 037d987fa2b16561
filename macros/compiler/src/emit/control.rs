//! The implementation of the trait `Controlled`: what choosing the inputs needs.

use proc_macro2::TokenStream;
use quote::quote;

use super::SystemEmitter;
use super::function::{Body, Function};
use super::functions::CONTROLLED;
use super::scope::size;
use crate::derive::Id;
use crate::lower::Kernel;

impl SystemEmitter<'_, '_> {
    /// The impl block, where something is chosen.
    pub(super) fn controlled(&self) -> TokenStream {
        let Some(control) = &self.model.control else { return TokenStream::new() };
        let (krate, scalar, name) = (&self.paths.krate, &self.paths.scalar, self.target.ident.to_string());
        let (configuration, constants) = (self.alias("Q"), self.alias("C"));
        let (dimension, motions) = (self.place_dimension(), size(self.model.dimension()));
        let [d, u, c] = [dimension, self.inputs(), control.bounds.len()].map(size);
        let [costates, input, bounds, momentum] =
            [dimension, self.inputs(), control.bounds.len(), self.model.dimension()]
                .map(|rows| self.paths.matrix(rows, 1));
        let (point, steps, [start, costate]) = if self.is_steered() {
            (configuration, scalar.clone(), [quote!(q), quote!(mu)])
        } else {
            (quote!((#configuration, #momentum)), quote!((#constants, #scalar)), [quote!(x), quote!(costate)])
        };
        let words = [
            ("Result", quote!(::core::result::Result)),
            ("Error", quote!(#krate::Error)),
            ("Expansion", quote!(#krate::Expansion<#point, #scalar, #d, #u>)),
            ("Arrival", quote!(#krate::Arrival<#scalar, #d>)),
            ("BoundsExpansion", quote!(#krate::BoundsExpansion<#scalar, #d, #u, #c>)),
            ("EndpointExpansion", quote!(#krate::EndpointExpansion<#scalar, #d>)),
            ("Point", point.clone()),
            ("Steps", steps.clone()),
            ("Start", start),
            ("Costate", costate),
            ("Costates", costates),
            ("Input", input),
            ("Bounds", bounds),
        ];
        let functions = self.functions(CONTROLLED, (0, 0), &words, |function, kernel| {
            self.price(function, kernel).or_else(|| {
                if self.is_steered() { self.steered(function, kernel) } else { Some(self.forced(function)) }
            })
        });
        let texts = control.bounds.iter().map(|bound| bound.text.as_str());
        self.target.derived(
            Some(quote!(#krate::Controlled<#d, #u, #c>)),
            quote! {
                type Scalar = #scalar;

                const NAME: &'static ::core::primitive::str = #name;
                const BOUNDS: [&'static ::core::primitive::str; #c] = [#(#texts),*];
                const MOTIONS: ::core::primitive::usize = #motions;

                type Place = #point;
                type Constants = #steps;

                #functions
            },
        )
    }

    fn inputs(&self) -> usize {
        self.model.inputs.iter().map(|leaf| leaf.shape.len()).sum()
    }

    /// Whether inputs move the configuration by themselves, and are not those of forces.
    fn is_steered(&self) -> bool {
        self.kernels.find(Id::StepExpanded).is_some()
    }

    /// The dimension of what is steered: a configuration, or a state.
    fn place_dimension(&self) -> usize {
        if self.is_steered() { self.model.dimension() } else { 2 * self.model.dimension() }
    }

    /// The only output of a kernel, a scalar.
    fn scalar(&self, kernel: &Kernel) -> TokenStream {
        let body = self.scope_of_system().body_of_scalar(kernel);
        quote!({ #body })
    }

    /// The only output of a kernel, a matrix even where it has one entry.
    fn matrix(&self, id: Id) -> TokenStream {
        let body = self.scope_of_system().body(self.kernels.kernel(id));
        quote!({ #body })
    }

    /// All outputs of a kernel as matrices, in a tuple, but for those that are scalars by nature.
    fn tuple(&self, kernel: &Kernel, scalars: &[usize]) -> TokenStream {
        let scope = self.scope_of_system();
        let locals = scope.locals(kernel);
        let outputs = (0..kernel.outputs.len()).map(|index| {
            if scalars.contains(&index) { scope.scalar(kernel, index) } else { scope.output(kernel, index) }
        });
        quote!({ #locals (#(#outputs,)*) })
    }

    /// The slope of price and step, from those along h and t.
    fn price_of_time(&self) -> TokenStream {
        let (private, scalar, slopes) = (&self.paths.private, &self.paths.scalar, self.matrix(Id::PriceOfTime));
        quote! {
            let slopes: #private::SVector<#scalar, 2> = #slopes;
            ::core::result::Result::Ok(slopes[0] + k * slopes[1])
        }
    }

    /// What inputs move by themselves.
    fn steered<'k>(&'k self, function: &Function, kernel: Option<&'k Kernel>) -> Option<Body<'k>> {
        let (krate, private, scope) = (&self.paths.krate, &self.paths.private, self.scope_of_system());
        let moved = || {
            let [increment, advance] = [Id::Increment, Id::Advance].map(|id| self.kernels.kernel(id));
            let [before, within] = [increment, advance].map(|kernel| scope.locals(kernel));
            let (increment, advance) = (scope.element(increment, 0), scope.configuration(advance));
            quote! {
                let (h, q) = (*constants, x);
                let d = { #before #increment };
                let next = { #within #advance };
            }
        };
        let code = match function.name {
            "prepare" => {
                let checks = self.checks();
                quote!(#checks ::core::result::Result::Ok(h))
            }
            "check_place" => {
                let defect = self.orbit_defect();
                quote!(#private::check_on_orbit(q, { #defect }))
            }
            "follow" => {
                let moved = moved();
                let code = quote!(#moved #private::check_reached(next));
                let increment = self.kernels.kernel(Id::Increment);
                return Some(Body::new(increment, code).inlined(quote!(#[inline])));
            }
            "expand" => {
                let (moved, expand) = (moved(), self.tuple(kernel?, &[2]));
                quote! {
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
            }
            "price_of_time" => {
                let (moved, of_time) = (moved(), self.price_of_time());
                quote!(#moved #of_time)
            }
            "arrival" => {
                let (metric, approach) = (self.matrix(Id::OrbitMetric), self.matrix(Id::Approach));
                quote!(let (q, next) = (x, target); #krate::Arrival { residual: #approach, slope: #metric })
            }
            _ => {
                let (metric, approach) = (self.matrix(Id::OrbitMetric), self.matrix(Id::Approach));
                quote!(let (q, next) = (x, y); #private::displacement(&#metric, &#approach))
            }
        };
        Some(Body::from(code))
    }

    /// What the inputs of forces move.
    fn forced(&self, function: &Function) -> Body<'_> {
        let (krate, private, scalar) = (&self.paths.krate, &self.paths.private, &self.paths.scalar);
        let [m, u, w] = [self.model.dimension(), self.inputs(), 2 * self.model.dimension() + self.inputs()].map(size);
        let passed = || {
            let by_input = self.tuple(self.kernels.kernel(Id::ByInput), &[]);
            quote! {
                let (constants, h) = (&constants.0, constants.1);
                let (q, n) = x;
                let d = &#krate::Variational::drift(self, constants, 0, t, q, n, u)?;
                let next = &#krate::Variational::advance(self, q, d);
                let edge = #krate::Variational::carried(self, constants, 0, t, q, d, next, u);
                let (before, after): (#private::SMatrix<#scalar, #m, #u>, #private::SMatrix<#scalar, #m, #u>) = #by_input;
                let link = #private::Link::new(&edge, &before, &after, costate).ok_or(#krate::Error::SingularTangent { step_size: #private::Scalar::to_f64(h) })?;
                let (mu, kappa) = (&link.costate, &link.multiplier);
            }
        };
        let (title, code) = match function.name {
            "prepare" => ("", quote!(::core::result::Result::Ok((#krate::Clebsch::constants(self, h)?, h)))),
            "check_place" => ("", quote!(#private::check_state(self, &x.0, &x.1))),
            "follow" => {
                let code = quote!(#private::forced_step(self, &constants.0, t, x, u));
                return Body::from(code).titled("The forced step.").inlined(quote!(#[inline]));
            }
            "expand" => {
                let (passed, curvature, bracket) = (passed(), self.matrix(Id::Bend), self.matrix(Id::Bracket));
                let price = self.tuple(self.kernels.kernel(Id::PriceExpanded), &[0]);
                let code = quote! {
                    #passed
                    let curvature: #private::SMatrix<#scalar, #w, #w> = #curvature;
                    let mu = &link.driving;
                    let bracket: #private::SMatrix<#scalar, #m, #m> = #bracket;
                    let (price, by_motion, by_input, motions, mixed, inputs) = #price;
                    let price = #private::Price { price, by_motion, by_input, motions, mixed, inputs };
                    let next = #private::check_reached((*next, edge.momentum))?;
                    ::core::result::Result::Ok(link.expansion(next, &curvature, &bracket, &price))
                };
                let title = "The forced step with its derivatives, and the second derivatives of ℓ + λ·(η′, N⁺): with the multipliers κ of the momentum\nequation those of α·η′ + β·F⁺ℓd + κ·(F⁻ℓd − N), to which η′ contributes ± ½ α·[Ad η, ζ].";
                (title, code)
            }
            "price_of_time" => {
                let (passed, of_time) = (passed(), self.price_of_time());
                ("d/dh (ℓ + λ·(η′, N⁺)), the start of the step moving with h.", quote!(#passed #of_time))
            }
            "arrival" => {
                let code = quote! {
                    let metric = #krate::Variational::orbit_metric(self, &x.0);
                    #private::arrival_of_state(&metric, &#krate::Variational::approach(self, &x.0, &target.0), &(target.1 - x.1))
                };
                ("(Gᵀ(q* − q), N* − N) and (GᵀG, I).", code)
            }
            _ => {
                let code = quote! {
                    let metric = #krate::Variational::orbit_metric(self, &x.0);
                    let motion = #private::displacement(&metric, &#krate::Variational::approach(self, &x.0, &y.0));
                    #private::pair(&motion, &(y.1 - x.1))
                };
                let title = "The shortest motion that moves one configuration to another, to first order, and the change of the momentum.";
                (title, code)
            }
        };
        Body::from(code).titled(title)
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
    fn price<'k>(&'k self, function: &Function, kernel: Option<&'k Kernel>) -> Option<Body<'k>> {
        let (private, scalar) = (&self.paths.private, &self.paths.scalar);
        let (h, q) =
            if self.is_steered() { (quote!(*constants), quote!(x)) } else { (quote!(constants.1), quote!(&x.0)) };
        let (cost, code) = match function.name {
            "price" => {
                let price = self.scalar(kernel?);
                (kernel, quote!(let (h, q) = (#h, #q); #price))
            }
            "bounds" => {
                let bounds = self.matrix(Id::Bounds);
                (kernel, quote!(let q = #q; #bounds))
            }
            "bounds_expanded" => {
                let expanded = self.tuple(kernel?, &[]);
                let code = quote! {
                    let q = #q;
                    let (values, by_motion, by_input, motions, mixed, inputs) = #expanded;
                    #private::bounds(values, &by_motion, by_input, &motions, &mixed, inputs)
                };
                (None, code)
            }
            "endpoint" => {
                let none = || quote!(<#scalar as #private::Zero>::zero());
                let price = kernel.map_or_else(none, |kernel| self.scalar(kernel));
                (None, quote!(let q = #q; #price))
            }
            "endpoint_expanded" => {
                let expanded = self.endpoint_expanded().unwrap_or(quote!(#private::no_endpoint()));
                (None, quote!(let q = #q; #expanded))
            }
            _ => return None,
        };
        let inline = cost.map(|_| quote!(#[inline]));
        Some(Body { inline, cost, ..Body::from(code) })
    }
}
