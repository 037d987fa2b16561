//! The type `Step`, a method for each part of a step, and the equations that it solves.

use clebsch_symbolic::Group;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::code::Nesting;
use super::names::Names;
use super::{Emitter, Generics, code, docs};
use crate::derive::{Formula, Id, Solution};
use crate::lower::{Kernel, Solve, StepKernels};

/// The most operations of a step, apart from those of iterations, that is inlined wherever it is called.
const SHORT_STEP: usize = 192;

impl Emitter<'_, '_> {
    /// The struct `Step` and its methods.
    pub(super) fn step_type(&self) -> TokenStream {
        let Generics { parameters, arguments, predicates } = &self.generics;
        let (ident, (_, constants)) = (&self.model.item.ident, self.constants_generics());
        let Names { lifetime, constants: constants_name, .. } = &self.names;
        let parts = self.program.steps.iter().enumerate().map(|(index, step)| self.parts(index, step));
        let (shared, whole, edges) = (self.shared_parts(), self.whole_steps(), self.edges());
        let step = &self.names.step;
        let documentation =
            docs::lines(
                &["A system with the constants of a stepper: the parts of a step are its methods.".to_string()],
            );
        quote! {
            #documentation
            struct #step<#lifetime, #parameters> #predicates {
                system: &#lifetime #ident<#arguments>,
                constants: &#lifetime #constants_name #constants,
            }

            impl<#lifetime, #parameters> #step<#lifetime, #arguments> #predicates {
                #whole
                #(#parts)*
                #shared
                #edges
            }
        }
    }

    pub(super) fn part(
        &self,
        title: &str,
        formulas: &[Formula<'_>],
        signature: TokenStream,
        kernel: &Kernel,
        nesting: Option<Nesting>,
    ) -> TokenStream {
        let documentation = docs::formulas(title, formulas, Some(kernel));
        let body = code::body(&self.scope_of_step(), kernel, nesting);
        quote! {
            #documentation
            #[inline]
            fn #signature {
                #body
            }
        }
    }

    /// The methods of one substep: kicks, solve, increment, update.
    fn parts(&self, index: usize, step: &StepKernels) -> TokenStream {
        let suffix = self.program.suffix(index);
        let name = |name: &str| format_ident!("{name}{suffix}");
        let (configuration, momentum, time) = (self.configuration_type(), self.momentum_type(), self.time_parameter());
        let formulas = &self.program.formulas;
        let kick = |name: Ident, title: &str, kernel: &Kernel, id: Id| {
            self.part(
                title,
                formulas.titled(id),
                quote!(#name(&self, #time q: &#configuration) -> #momentum),
                kernel,
                None,
            )
        };
        let start = step
            .start
            .as_ref()
            .map(|kernel| kick(name("start_kick"), "The kick at the start of a step.", kernel, Id::StartKick(index)));
        let end = step.end.as_ref().filter(|_| !step.end_is_start);
        let end =
            end.map(|kernel| kick(name("end_kick"), "The kick at the end of a step.", kernel, Id::EndKick(index)));
        let input = self.input_parameter();
        let element = self.element_type();
        let force = |name: Ident, title: &str, at: TokenStream, kernel: &Kernel| {
            let formulas = self.program.formulas.titled(Id::Force);
            let signature = quote!(#name(&self, #time q: &#configuration, #at #input) -> #momentum);
            self.part(title, formulas, signature, kernel, None)
        };
        let start_force = step.start_force.as_ref();
        let start_force = start_force.map(|kernel| {
            force(name("start_force"), "The impulse of the force at the start of a step.", quote!(), kernel)
        });
        let end_force = step.end_force.as_ref().map(|kernel| {
            force(name("end_force"), "The impulse of the force at the end of a step.", quote!(x: &#momentum,), kernel)
        });
        let moving_force = step.start_moving.as_ref().map(|kernel| {
            let title = "The part of the impulse at the start of a step that depends on the velocity.";
            force(name("moving_force"), title, quote!(x: &#momentum,), kernel)
        });
        let gradient = |name: Ident, title: &str, kernel: &Kernel, id: Id| {
            let signature = quote!(#name(&self, #time q: &#configuration) -> #configuration);
            self.part(title, formulas.titled(id), signature, kernel, Some(Nesting::Configuration))
        };
        let start_gradient = step.start_gradient.as_ref();
        let start_gradient = start_gradient.map(|kernel| {
            gradient(
                name("start_gradient"),
                "∂U₀(q), the kick of the covector at the start of a step.",
                kernel,
                Id::StartGradient(index),
            )
        });
        let end_gradient = step.end_gradient.as_ref().filter(|_| !(step.end_is_start && self.follows_great_circles()));
        let end_gradient = end_gradient.map(|kernel| {
            gradient(
                name("end_gradient"),
                "∂U₁(q), the kick of the covector at the end of a step.",
                kernel,
                Id::EndGradient(index),
            )
        });
        let rest = step.rest.as_ref().map(|kernel| {
            kick(name("rest_kick"), "What the cost gives at F = I, with the other sign.", kernel, Id::RestKick(index))
        });
        let coupled_gradient = step.coupled_gradient.as_ref().map(|kernel| {
            let name = name("coupled_gradient");
            let signature = quote!(#name(&self, #time q: &#configuration, d: &#element) -> #configuration);
            let title = "∂_q K(q, F), the kick of the covector by a cost that couples, F = I + D.";
            let formulas = formulas.titled(Id::CoupledGradient(index));
            self.part(title, formulas, signature, kernel, Some(Nesting::Configuration))
        });
        let update = step.update.as_ref().map(|kernel| {
            let (signature, formulas) = (name("update"), self.program.formulas.titled(Id::MomentumAfter(index)));
            let from = if step.couples { quote!(#time q: &#configuration) } else { quote!(mu: &#momentum) };
            let signature = quote!(#signature(&self, #from, d: &#element) -> #momentum);
            let title = match self.is_compensated() {
                true => "What the move, F = I + D, adds to the momentum: M⁺ − μ, in which μ has cancelled.",
                false => "The momentum after the move, F = I + D.",
            };
            self.part(title, formulas, signature, kernel, None)
        });
        let solve_kept = self.keeps_motions().then(|| self.solve(name("solve_kept"), suffix, step, true));
        let (solve, solve_kept) = match self.program.formulas.turns_whole() {
            true => (self.turns(), None),
            false => (self.solve(name("solve"), suffix, step, false), solve_kept),
        };
        quote!(#solve_kept #start #rest #end #start_force #moving_force #end_force #start_gradient #end_gradient #coupled_gradient #solve #update)
    }

    /// The chart coordinates of all factors, equation by equation.
    fn solve(&self, name: Ident, suffix: &str, step: &StepKernels, kept: bool) -> TokenStream {
        let (private, krate, momentum) = (&self.paths.private, &self.paths.krate, self.momentum_type());
        let (place, input) = (self.time_argument(), self.input_argument());
        let parameters = self.place_parameters(step);
        let solved = |component: &usize| {
            let position = |solve: &Solve| solve.components.iter().position(|other| other == component);
            let found = step.solves.iter().enumerate().find_map(|(number, solve)| Some((number, position(solve)?)));
            // by construction: every component belongs to one equation
            let (number, position) = found.unwrap_or((0, 0));
            let (solution, position) = (format_ident!("x{}", number + 1), Literal::usize_unsuffixed(position));
            quote!(#solution[#position])
        };
        let solutions = step.solves.iter().enumerate().map(|(number, solve)| {
            let (name, solution) = (self.names.equation(suffix, number), format_ident!("x{}", number + 1));
            let target = self.part_of("mu", &solve.momenta);
            let input = solve.reads_input.then_some(&input);
            let place = if solve.moves { quote!(, #place q, #input) } else { quote!() };
            let equation = quote!(#name { system: self.system, constants: self.constants #place });
            let given = solve.given.iter().map(solved);
            let given = (!solve.given.is_empty()).then(|| quote!(, &#private::vector([#(#given),*])));
            match solve.solution {
                Solution::ClosedForm => quote!(let #solution = #name::closed_form(&#equation, &#target)?;),
                Solution::Explicit => quote!(let #solution = #name::explicit(&#equation, &#target #given);),
                Solution::FreeRotation => self.found_free_rotation((suffix, number, solve), &solution, &target, kept),
                Solution::Linear => quote!(let #solution = #private::solve_linear_equation(&#equation, &#target)?;),
                Solution::Newton => {
                    let solver =
                        format_ident!("{}", if solve.residual.is_some() { "solve_fixed_point" } else { "solve" });
                    quote!(let #solution = #private::#solver(&#equation, &#target)?;)
                }
            }
        });
        let components: Vec<usize> = (0..self.dimension()).collect();
        let entries = components.iter().map(solved);
        let documentation =
            docs::lines(&["The chart coordinates x of the group element whose momentum is μ.".to_string()]);
        let kept = kept.then(|| {
            let kept = self.kept_type();
            quote!(kept: &#kept,)
        });
        let result = if step.solves.len() == 1 { quote!(x1) } else { quote!(#private::vector([#(#entries),*])) };
        let (coordinates, weights) = (self.coordinates_type(), self.program.formulas.weighted().len());
        let weights = (1..=weights).map(|number| format_ident!("w{number}"));
        let result = match self.program.formulas.weighted().is_empty() {
            true => result,
            false => quote!((#result, [#(#weights),*])),
        };
        quote! {
            #documentation
            #[inline]
            fn #name(&self, #kept #parameters mu: &#momentum) -> ::core::result::Result<#coordinates, #krate::Error> {
                #(#solutions)*
                ::core::result::Result::Ok(#result)
            }
        }
    }

    /// The time and the configuration as parameters of a solve that depends on them.
    fn place_parameters(&self, step: &StepKernels) -> TokenStream {
        let (time, configuration) = (self.time_parameter(), self.configuration_type());
        let input = step.solves.iter().any(|solve| solve.reads_input).then(|| self.input_parameter());
        let moves = step.solves.iter().any(|solve| solve.moves);
        if moves { quote!(#time q: &#configuration, #input) } else { quote!() }
    }

    /// The time and the configuration as they are handed to such a solve.
    pub(super) fn place_arguments(&self, step: &StepKernels) -> TokenStream {
        let time = self.time_argument();
        let input = step.solves.iter().any(|solve| solve.reads_input).then(|| self.input_argument());
        if step.solves.iter().any(|solve| solve.moves) { quote!(#time &q, #input) } else { quote!() }
    }

    /// Some components of a flat vector; all of them are the vector itself.
    pub(super) fn part_of(&self, vector: &str, components: &[usize]) -> TokenStream {
        let (private, vector) = (&self.paths.private, format_ident!("{vector}"));
        if components.iter().copied().eq(0..self.dimension()) {
            return quote!(*#vector);
        }
        let entries = components.iter().map(|&component| {
            let component = Literal::usize_unsuffixed(component);
            quote!(#vector[#component])
        });
        quote!(#private::vector([#(#entries),*]))
    }

    /// Increment, advance and lift, which all substeps share.
    fn shared_parts(&self) -> TokenStream {
        let (configuration, element, momentum) = (self.configuration_type(), self.element_type(), self.momentum_type());
        let step = &self.program.steps[0];
        let increment = (!self.program.formulas.turns_whole()).then(|| self.part(
            "The increment D = F − I of the group element with chart coordinates x (for translations F itself), without cancellation.",
            self.program.formulas.titled(Id::Increment),
            match self.program.formulas.weighted().is_empty() {
                true => quote!(increment(&self, x: &#momentum) -> #element),
                false => {
                    let coordinates = self.coordinates_type();
                    quote!(increment(&self, (x, w): &#coordinates) -> #element)
                }
            },
            &step.increment,
            Some(Nesting::Element),
        ));
        // points on large spheres are turned in (q, w)
        if self.follows_great_circles() {
            return quote!(#increment);
        }
        let advance = match &step.displace {
            Some(displace) => self.part(
                match self.is_compensated() {
                    true => "What F, with chart coordinates x, adds to q: α ξ_Q(q) + β ξ_Q(ξ_Q(q)) at ξ = x where F = I + α x^ + β (x^)², without the matrix.",
                    false => "The configuration that F, with chart coordinates x, moves q to: q + α ξ_Q(q) + β ξ_Q(ξ_Q(q)) at ξ = x where F = I + α x^ + β (x^)², without the matrix.",
                },
                self.program.formulas.titled(Id::Displacement),
                quote!(displace(&self, q: &#configuration, x: &#momentum) -> #configuration),
                displace,
                Some(Nesting::Configuration),
            ),
            None => self.part(
                match self.is_compensated() {
                    true => "What F = I + D adds to q: Φ_F(q) − q, in which q has cancelled.",
                    false => "The configuration that F = I + D moves q to.",
                },
                self.program.formulas.titled(Id::Advance),
                quote!(advance(&self, q: &#configuration, d: &#element) -> #configuration),
                &step.advance,
                Some(Nesting::Configuration),
            ),
        };
        let lift = self.part(
            "The covector p carried along by F = I + D, at q⁺.",
            self.program.formulas.titled(Id::Lift),
            quote!(lift(&self, q: &#configuration, p: &#configuration, d: &#element) -> #configuration),
            &self.program.cotangent_lift,
            Some(Nesting::Configuration),
        );
        quote!(#increment #advance #lift)
    }

    /// The steps themselves, which only call their parts.
    fn whole_steps(&self) -> TokenStream {
        let krate = &self.paths.krate;
        let (configuration, element, momentum) = (self.configuration_type(), self.element_type(), self.momentum_type());
        let stepped = self.stepped_whole();
        // the declared Lagrangian itself stands last, behind the halves of a composed step
        let whole = self.program.steps.len() - 1;
        let (inverse, first) = (self.inverse_legendre(), self.program.suffix(whole));
        let (solve, kicked) = (format_ident!("solve{first}"), self.kicked_plainly(whole, &self.program.steps[whole]));
        let (time, place) = (self.time_parameter(), self.place_arguments(&self.program.steps[whole]));
        let found = self.found_increment(quote!(self.#solve(#place &mu)?));
        quote! {
            #stepped
            /// F with momentum μ at q.
            fn inverse_legendre(&self, #time q: &#configuration, mu: &#momentum) -> ::core::result::Result<#element, #krate::Error> {
                let mu = *mu;
                let q = *q;
                #kicked
                #found
                #inverse
            }
        }
    }

    /// The steps in both representations, or the drift of a splitting.
    fn stepped_whole(&self) -> TokenStream {
        if let Some(splitting) = &self.program.splitting {
            return self.splitting(splitting);
        }
        if let Some(collocation) = &self.program.collocation {
            return self.collocated(collocation);
        }
        if self.follows_great_circles() {
            return self.along_great_circles();
        }
        let (krate, configuration, momentum, impulse) =
            (&self.paths.krate, self.configuration_type(), self.momentum_type(), self.left_type());
        let (time, input, inline) = (self.time_parameter(), self.input_parameter(), self.inline_of_steps());
        let euler_poincare = self.stepped().map(|(index, step)| self.euler_poincare(index, step));
        let (next_impulse, symmetric, kept) = (self.next_impulse(), self.symmetric(), self.kept_steps());
        let (rests, left) = (self.rests_taken(&format_ident!("impulse")), self.with_rests(quote!(impulse)));
        let kept_on_spaces = self.kept_on_spaces();
        quote! {
            #kept
            /// (q, N) ↦ (q⁺, N⁺): kick, solve for the group element, move, kick.
            #inline
            fn euler_poincare(
                &self,
                #time
                q: &#configuration,
                mu: &#momentum,
                impulse: &#impulse,
                #input
            ) -> ::core::result::Result<(#configuration, #momentum, #impulse), #krate::Error> {
                let (q, mu) = (*q, *mu);
                #rests
                #(#euler_poincare)*
                #next_impulse
                #kept_on_spaces
                ::core::result::Result::Ok((q, mu, #left))
            }
            #symmetric
        }
    }

    /// How a step is inlined: a short one always, as a call hands states through memory. What iterates is a call.
    pub(super) fn inline_of_steps(&self) -> TokenStream {
        let is_single = self.program.formulas.parts == 1
            && self.program.formulas.stages().is_none()
            && self.program.collocation.is_none();
        match self.program.steps.first().map(StepKernels::cost_of_moves) {
            Some(cost) if is_single && cost.total() <= SHORT_STEP => quote!(#[inline(always)]),
            _ => quote!(#[inline]),
        }
    }

    /// The substeps that make a step.
    fn stepped(&self) -> impl Iterator<Item = (usize, &StepKernels)> {
        self.program.steps.iter().enumerate().take(self.program.formulas.parts)
    }

    /// The kick at the start of a substep; that of the first is the impulse that the last step has left.
    fn kicked(&self, index: usize, step: &StepKernels) -> TokenStream {
        match step.start {
            Some(_) if index == 0 && self.shares_impulse() => self.pushed_by_impulse(),
            Some(_) => self.pushed_by(self.start_kick(index)),
            None => quote!(),
        }
    }

    /// What the cost gives at F = I, where it is no part of the kick.
    fn rest_apart(&self, index: usize, step: &StepKernels) -> Option<TokenStream> {
        let (rest, time) = (format_ident!("rest_kick{}", self.program.suffix(index)), self.time_argument());
        step.rest.as_ref().filter(|_| self.is_compensated()).map(|_| quote!(self.#rest(#time &q)))
    }

    /// The same from a configuration alone, where no rests are kept.
    pub(super) fn kicked_plainly(&self, index: usize, step: &StepKernels) -> TokenStream {
        let kick = step.start.as_ref().map(|_| self.start_kick(index));
        let kicks = kick.into_iter().chain(self.rest_apart(index, step));
        quote!(#(let mu = mu + #kicks;)*)
    }

    fn start_kick(&self, index: usize) -> TokenStream {
        let (start, time) = (format_ident!("start_kick{}", self.program.suffix(index)), self.time_argument());
        quote!(self.#start(#time &q))
    }

    /// The impulse of the force at the start of a substep.
    pub(super) fn start_force(&self, index: usize, step: &StepKernels) -> Option<TokenStream> {
        let start_force = format_ident!("start_force{}", self.program.suffix(index));
        let (time, input) = (self.time_argument(), self.input_argument());
        step.start_force.as_ref().map(|_| quote!(self.#start_force(#time &q, #input)))
    }

    fn euler_poincare(&self, index: usize, step: &StepKernels) -> TokenStream {
        let suffix = self.program.suffix(index);
        let (solve, update) = (format_ident!("solve{suffix}"), format_ident!("update{suffix}"));
        let kicked = self.kicked(index, step);
        let (time, place) = (self.time_argument(), self.place_arguments(step));
        let updated = step.update.as_ref().map(|_| match step.couples {
            true => self.updated(quote!(self.#update(#time &from, &d))),
            false => self.updated(quote!(self.#update(&mu, &d))),
        });
        let from = step.couples.then(|| quote!(let from = q;));
        let input = self.input_argument();
        let start_force = self.start_force(index, step).map(|force| self.pushed_by(force));
        let end_force = step.end_force.as_ref().map(|_| {
            let end_force = format_ident!("end_force{suffix}");
            self.pushed_by(quote!(self.#end_force(#time &q, &x, #input)))
        });
        let moving_force = step.start_moving.as_ref().map(|_| {
            let moving_force = format_ident!("moving_force{suffix}");
            self.pushed_by(quote!(self.#moving_force(#time &q, &x, #input)))
        });
        let last = index + 1 == self.program.formulas.parts;
        let end = match (&step.end, last && self.shares_impulse()) {
            (None, _) | (Some(_), true) => quote!(),
            (Some(_), false) => {
                let end = format_ident!("{}{suffix}", if step.end_is_start { "start_kick" } else { "end_kick" });
                self.pushed_by(quote!(self.#end(#time &q)))
            }
        };
        // where the step moves by the coordinates alone, it makes no matrix
        let increment = step.makes_increments().then(|| quote!(let d = self.increment(&x);));
        let found = match self.keeps_motions() {
            true => {
                let found = self.found_by_kept(step);
                quote!(let kept = impulse; #found)
            }
            false => {
                // what is solved for is M − r(I), and what the move carries is M
                let mu = self.rest_apart(index, step).map_or(quote!(mu), |rest| quote!((mu + #rest)));
                quote!(let x = self.#solve(#place &#mu)?; #increment)
            }
        };
        let advanced = self.advanced(step);
        quote! {
            #kicked
            #start_force
            #found
            #moving_force
            #from
            #advanced
            #updated
            #end_force
            #end
        }
    }

    /// The last kick, kept for the next step where it is the same.
    fn next_impulse(&self) -> TokenStream {
        // where time matters, the kick at the end of the last substep is the one that knows its time
        let last = self.program.formulas.parts - 1;
        let kick = match self.is_timed() {
            true => format_ident!("end_kick{}", self.program.suffix(last)),
            false => format_ident!("start_kick{}", self.program.suffix(0)),
        };
        let time = self.time_argument();
        match self.shares_impulse() {
            true => {
                let pushed = self.pushed_by(quote!(impulse));
                quote!(let impulse = self.#kick(#time &q); #pushed)
            }
            false if self.keeps_motions() => quote!(let impulse = *impulse;),
            false => quote!(let impulse = ();),
        }
    }

    /// F − I from the solution of the equation, or at once.
    fn found_increment(&self, solution: TokenStream) -> TokenStream {
        match self.program.formulas.turns_whole() {
            true => quote!(let (d, _) = self.turn_kept(&self.kept_motions(&mu), &mu)?;),
            false => quote! {
                let x = #solution;
                let d = self.increment(&x);
            },
        }
    }

    fn symmetric(&self) -> TokenStream {
        if !self.model.has_covectors() {
            return TokenStream::new();
        }
        let (krate, configuration, time) = (&self.paths.krate, self.configuration_type(), self.time_parameter());
        let substeps = self.stepped().map(|(index, step)| {
            let suffix = self.program.suffix(index);
            let solve = format_ident!("solve{suffix}");
            let (time, place) = (self.time_argument(), self.place_arguments(step));
            let kick = |name: &str, increment: TokenStream| {
                let name = format_ident!("{name}{suffix}");
                let sum = code::combined(self.model, &quote!(p), quote!(+), &quote!(gradient), &self.paths);
                quote! {
                    let gradient = self.#name(#time &q #increment);
                    let p = #sum;
                }
            };
            let start = step.start_gradient.as_ref().map(|_| kick("start_gradient", quote!()));
            let end = step.end_gradient.as_ref().map(|_| kick("end_gradient", quote!()));
            let coupled = step.coupled_gradient.as_ref().map(|_| kick("coupled_gradient", quote!(, &d)));
            let rest = step.rest.as_ref().map(|_| {
                let name = format_ident!("rest_kick{suffix}");
                quote!(let mu = mu + self.#name(#time &q);)
            });
            let advanced = self.advanced_plainly(step);
            let found = self.found_increment(quote!(self.#solve(#place &mu)?));
            quote! {
                #start
                let mu = #krate::Clebsch::momentum_map(self.system, &q, &p);
                #rest
                #found
                #coupled
                #advanced
                let p = self.lift(&q, &p, &d);
                #end
            }
        });
        quote! {
            /// (q, p) ↦ (q⁺, p⁺), with the momentum J(q, p).
            fn symmetric(
                &self,
                #time
                q: &#configuration,
                p: &#configuration,
            ) -> ::core::result::Result<(#configuration, #configuration), #krate::Error> {
                let (q, p) = (*q, *p);
                #(#substeps)*
                ::core::result::Result::Ok((q, p))
            }
        }
    }

    /// F = I + D for each factor.
    fn inverse_legendre(&self) -> TokenStream {
        let private = &self.paths.private;
        let element = code::nested(&self.model.element, &mut |k| {
            let access = code::accessor(&self.model.factors[k].accessor);
            match self.model.factors[k].group {
                Group::Translation(_) => quote!(d #access),
                Group::UnitQuaternions => quote!(#private::quaternion_from_increment(&d #access)),
                _ => quote!(#private::from_increment(&d #access)),
            }
        });
        quote!(::core::result::Result::Ok(#element))
    }
}
