//! Steps of order 16: Hamilton's equations at all stages, found by sweeps over them.

use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};

use super::code::{self, Nesting};
use super::{Emitter, docs};
use crate::derive::Id;
use crate::lower::CollocationKernels;

impl Emitter<'_, '_> {
    /// The slope of (q, p), the covector of a momentum, and the steps in both representations.
    pub(super) fn collocated(&self, kernels: &CollocationKernels) -> TokenStream {
        let (slope, guess, change, lift) =
            (self.slope(kernels), self.guess(kernels), self.change(), self.lifted(kernels));
        let (euler_poincare, symmetric) = (self.collocated_euler_poincare(), self.collocated_symmetric());
        quote!(#slope #lift #guess #change #euler_poincare #symmetric)
    }

    /// (q′, p′), in the order of their entries.
    fn slope(&self, kernels: &CollocationKernels) -> TokenStream {
        let (time, numbers) = (self.time_parameter(), self.pair_type());
        let formulas = self.program.formulas.titled(Id::HamiltonEquations);
        let documentation = docs::formulas(
            "Hamilton's equations: the slope (q′, p′) at y = (q, p), all entries of q and then those of p, rows first.",
            formulas,
            Some(&kernels.slope),
        );
        let (q, p) = (self.built("y", 0), self.built("y", self.entries().count()));
        let scope = self.scope_of_step();
        let locals = code::locals(&scope, &kernels.slope);
        let entries = kernels.slope.outputs.iter().flat_map(|(_, entries)| entries);
        let entries = entries.map(|entry| scope.code(entry, false));
        quote! {
            #documentation
            #[inline(always)]
            fn slope(&self, #time y: &#numbers) -> #numbers {
                let (q, p) = (#q, #p);
                #locals
                [#(#entries),*]
            }
        }
    }

    fn lifted(&self, kernels: &CollocationKernels) -> TokenStream {
        let (configuration, momentum) = (self.configuration_type(), self.momentum_type());
        let signature = quote!(covector(&self, q: &#configuration, mu: &#momentum) -> #configuration);
        self.part(
            "A covector p at q with the momentum J(q, p) = μ.",
            &[],
            signature,
            &kernels.lift,
            Some(Nesting::Configuration),
        )
    }

    /// Where the motion with the velocity of the start leads.
    fn guess(&self, kernels: &CollocationKernels) -> TokenStream {
        let (configuration, momentum, scalar) = (self.configuration_type(), self.momentum_type(), &self.paths.scalar);
        let (time, numbers, step) = (self.time_parameter(), self.pair_type(), &self.program.steps[0]);
        let whole = self.part(
            "The chart coordinates x of the motion by the velocity ξ = Σ⁻¹(μ − A) for the time h, to first order in h.",
            &[],
            quote!(whole_guess(&self, #time q: &#configuration, mu: &#momentum) -> #momentum),
            &kernels.guess,
            None,
        );
        let x = match self.program.formulas.weighted().len() {
            0 => quote!(*x * part),
            count => {
                let (private, count) = (&self.paths.private, Literal::usize_unsuffixed(count));
                quote!((*x * part, [<#scalar as #private::One>::one(); #count]))
            }
        };
        let (advanced, entries) = (self.advanced_plainly(step), self.flat());
        quote! {
            #whole
            /// (q, p) after a part of the step, moved along by the velocity of its start: on the orbit of q.
            #[inline]
            fn guess(&self, part: #scalar, q: &#configuration, p: &#configuration, x: &#momentum) -> #numbers {
                let (q, x) = (*q, #x);
                let d = self.increment(&x);
                #advanced
                let p = self.lift(&q, p, &d);
                #entries
            }
        }
    }

    /// (q⁺ − q, p⁺ − p).
    fn change(&self) -> TokenStream {
        let (private, krate, scalar) = (&self.paths.private, &self.paths.krate, &self.paths.scalar);
        let configuration = self.configuration_type();
        let (start_of_pair, count) = (self.flat(), self.entries().count());
        let (dq, dp) = (self.built("change", 0), self.built("change", count));
        let tolerance =
            Literal::f64_unsuffixed(self.model.dials.tolerance.as_ref().map_or(0.0, |tolerance| tolerance.value));
        let most = match &self.model.dials.iterations {
            Some(iterations) => Literal::u32_unsuffixed(iterations.value).into_token_stream(),
            None => quote!(#private::SWEEPS),
        };
        let time = if self.is_timed() { quote!(t) } else { quote!(_) };
        let (argument, start) = (
            self.time_argument(),
            match self.is_timed() {
                true => quote!(t),
                false => quote!(<#scalar as #private::Zero>::zero()),
            },
        );
        let (parameter, momentum) = (self.time_parameter(), self.momentum_type());
        quote! {
            /// (q⁺ − q, p⁺ − p), by collocation at eight nodes.
            #[inline]
            fn change(
                &self,
                #parameter
                q: &#configuration,
                p: &#configuration,
                mu: &#momentum,
            ) -> ::core::result::Result<(#configuration, #configuration), #krate::Error> {
                let x = self.whole_guess(#argument q, mu);
                let change = #private::collocate::<#scalar, _, 8, 4>(
                    &#private::GAUSS_16,
                    (#start, self.constants.step_size),
                    &#start_of_pair,
                    #tolerance,
                    #most,
                    |part| self.guess(part, q, p, &x),
                    |#time, y| self.slope(#argument y),
                )?;
                ::core::result::Result::Ok((#dq, #dp))
            }
        }
    }

    /// M⁺ = M + J(q⁺, p⁺) − J(q, p), where J is linear in p and affine in q.
    fn collocated_euler_poincare(&self) -> TokenStream {
        let (private, krate, scalar) = (&self.paths.private, &self.paths.krate, &self.paths.scalar);
        let (configuration, momentum, left) = (self.configuration_type(), self.momentum_type(), self.left_type());
        let (time, argument) = (self.time_parameter(), self.time_argument());
        let (rests, kept) = (self.rests_taken(&format_ident!("impulse")), self.with_rests(quote!(())));
        let of_origin =
            self.program.formulas.collocation.as_ref().filter(|collocation| collocation.is_affine).map(
                |_| quote!(- #krate::Clebsch::momentum_map(self.system, &#private::Space::<#scalar>::origin(), &p)),
            );
        let completed = code::combined(self.model, &quote!(p), quote!(+), &quote!(missing), &self.paths);
        let pushed = self.pushed_by(quote!(added));
        let moved = match self.is_compensated() {
            true => quote!(let (q, q_rest) = #private::accumulate::<#scalar, _>(&q, &q_rest, &dq);),
            false => {
                let sum = code::combined(self.model, &quote!(q), quote!(+), &quote!(dq), &self.paths);
                quote!(let q = #sum;)
            }
        };
        let on_spaces = self.kept_on_spaces();
        let unused = (!self.is_compensated()).then(|| quote!(let _ = impulse;));
        quote! {
            /// (q, N) ↦ (q⁺, N⁺), where N⁺ − N = J(q⁺, p⁺) − J(q, p) is made of the changes of q and p at the middle of the step.
            #[inline]
            fn euler_poincare(
                &self,
                #time
                q: &#configuration,
                mu: &#momentum,
                impulse: &#left,
            ) -> ::core::result::Result<(#configuration, #momentum, #left), #krate::Error> {
                let (q, mu) = (*q, *mu);
                #unused
                #rests
                let p = self.covector(&q, &mu);
                // where rounding has moved q off its orbit, J(q, p) misses μ by as much: added up, N would drift like the square of the steps
                let missing = self.covector(&q, &(mu - #krate::Clebsch::momentum_map(self.system, &q, &p)));
                let p = #completed;
                let (dq, dp) = self.change(#argument &q, &p, &mu)?;
                let half = <#scalar as #private::Scalar>::from_ratio(1, 2);
                let added = {
                    let q = #private::Space::<#scalar>::zip_map(&q, &dq, |q, dq| q + half * dq);
                    let p = #private::Space::<#scalar>::zip_map(&p, &dp, |p, dp| p + half * dp);
                    #krate::Clebsch::momentum_map(self.system, &dq, &p) #of_origin + #krate::Clebsch::momentum_map(self.system, &q, &dp)
                };
                #moved
                #on_spaces
                #pushed
                ::core::result::Result::Ok((q, mu, #kept))
            }
        }
    }

    fn collocated_symmetric(&self) -> TokenStream {
        let (krate, configuration) = (&self.paths.krate, self.configuration_type());
        let (time, argument) = (self.time_parameter(), self.time_argument());
        let [q, p] = [("q", "dq"), ("p", "dp")].map(|(from, by)| {
            let (from, by) = (format_ident!("{from}"), format_ident!("{by}"));
            code::combined(self.model, &quote!(#from), quote!(+), &quote!(#by), &self.paths)
        });
        quote! {
            /// (q, p) ↦ (q⁺, p⁺).
            fn symmetric(
                &self,
                #time
                q: &#configuration,
                p: &#configuration,
            ) -> ::core::result::Result<(#configuration, #configuration), #krate::Error> {
                let mu = #krate::Clebsch::momentum_map(self.system, q, p);
                let (dq, dp) = self.change(#argument q, p, &mu)?;
                ::core::result::Result::Ok((#q, #p))
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
        let (scalar, count) = (&self.paths.scalar, Literal::usize_unsuffixed(2 * self.entries().count()));
        quote!([#scalar; #count])
    }
}
