//! The parts of a step: one method for each, as the schemes of the runtime call them.

use clebsch_symbolic::Group;
use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};

use super::code::Nesting;
use super::{Emitter, code, docs};
use crate::derive::{Formula, Id, Solution};
use crate::lower::{Kernel, Solve, Step};
use crate::model::{Layout, LeafSpace};

/// The most operations of a step, apart from those of iterations, that is inlined wherever it is called.
const SHORT_STEP: usize = 192;

/// What moves q and N.
#[derive(Copy, Clone, PartialEq, Eq)]
enum Motion {
    /// D = F − I.
    Increment,
    /// The chart coordinates x.
    Coordinates,
    /// q moves by x, N by D.
    Both,
}

impl Emitter<'_, '_> {
    /// The implementations of `Parts`, of `Substep` for each substep, and of what the scheme calls beside them.
    pub(super) fn parts(&self) -> TokenStream {
        let shared = self.shared_parts();
        let substeps = self.program.steps.iter().enumerate().map(|(index, step)| self.substep(index, step));
        let of_scheme = self.parts_of_scheme();
        quote!(#shared #(#substeps)* #of_scheme)
    }

    /// An implementation of a hidden trait of the runtime.
    pub(super) fn implementation(&self, name: &str, sizes: &[&Literal], items: TokenStream) -> TokenStream {
        let super::Generics { parameters, arguments, predicates } = &self.generics;
        let (ident, of) = (&self.model.item.ident, self.trait_of_parts(name, sizes));
        quote! {
            impl<#parameters> #of for #ident<#arguments> #predicates {
                #items
            }
        }
    }

    /// A part that is one kernel.
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

    /// A part that other declarations do not have.
    fn optional(
        &self,
        title: &str,
        formulas: &[Formula<'_>],
        (name, arguments): (&str, TokenStream),
        kernel: &Kernel,
        nesting: Option<Nesting>,
    ) -> TokenStream {
        let (private, constants, name) = (&self.paths.private, self.constants_of_step(), format_ident!("{name}"));
        let result = if nesting.is_some() { self.configuration_type() } else { self.momentum_type() };
        let documentation = docs::formulas(title, formulas, Some(kernel));
        let scope = self.scope_of_step();
        let (locals, value) = (code::locals(&scope, kernel), code::value(&scope, kernel, nesting));
        quote! {
            #documentation
            #[inline]
            fn #name(&self, c: &#constants, #arguments) -> #private::Option<#result> {
                #locals
                #private::Some(#value)
            }
        }
    }

    /// The struct of the constants, with its arguments.
    pub(super) fn constants_of_step(&self) -> TokenStream {
        let (name, (_, arguments)) = (&self.names.constants, self.constants_generics());
        quote!(#name #arguments)
    }

    fn motion(&self) -> Motion {
        let program = self.program;
        let updates = (0..program.formulas.stepped).any(|index| program.find(Id::MomentumAfter(index)).is_some());
        match (program.find(Id::Displacement), updates) {
            (None, _) => Motion::Increment,
            (Some(_), false) => Motion::Coordinates,
            (Some(_), true) => Motion::Both,
        }
    }

    /// The chart coordinates of all factors, with the weights of those that are given up to a factor; F − I where a motion gives that at once.
    pub(super) fn coordinates_type(&self) -> TokenStream {
        if self.program.formulas.turns_whole() {
            return self.element_type();
        }
        let (momentum, scalar) = (self.momentum_type(), &self.paths.scalar);
        match self.program.formulas.weighted().len() {
            0 => momentum,
            count => {
                let count = Literal::usize_unsuffixed(count);
                quote!((#momentum, [#scalar; #count]))
            }
        }
    }

    fn motion_type(&self) -> TokenStream {
        let (coordinates, element) = (self.coordinates_type(), self.element_type());
        match self.motion() {
            Motion::Increment => element,
            Motion::Coordinates => coordinates,
            Motion::Both => quote!((#coordinates, #element)),
        }
    }

    /// Whether the steps of a single substep are so short that they are inlined wherever they are called.
    fn is_short(&self) -> bool {
        let is_single = self.program.formulas.stepped == 1
            && self.program.formulas.stages().is_none()
            && self.program.formulas.collocation.is_none();
        is_single && self.program.cost_of_moves(0).total() <= SHORT_STEP
    }

    /// Increment, advance and lift, which all substeps share.
    fn shared_parts(&self) -> TokenStream {
        let private = &self.paths.private;
        let sums = if self.is_compensated() { quote!(Compensated) } else { quote!(Plain) };
        let coordinates = self.coordinates_type();
        let moves = match self.motion() {
            Motion::Increment => quote!(ByIncrement),
            Motion::Coordinates => quote!(ByCoordinates),
            Motion::Both => quote!(ByBoth),
        };
        let is_short = self.is_short().then(|| {
            quote!(
                const IS_SHORT: ::core::primitive::bool = true;
            )
        });
        let has_covectors = self.model.has_covectors();
        let no_covectors = (!has_covectors).then(|| {
            quote!(
                const HAS_COVECTORS: ::core::primitive::bool = false;
            )
        });
        let (increment, element) = (self.increment(), self.element_of_increment());
        // points on large spheres are turned in (q, w)
        let advance = self.advance();
        let lift = has_covectors.then(|| self.lift());
        let on_space = self.on_space();
        self.implementation(
            "Parts",
            &[],
            quote! {
                type Sums = #private::#sums;
                type Coordinates = #coordinates;
                type Moves = #private::#moves;
                #is_short
                #no_covectors

                #increment
                #element
                #advance
                #lift
                #on_space
            },
        )
    }

    fn increment(&self) -> TokenStream {
        let (element, coordinates) = (self.element_type(), self.coordinates_type());
        if self.program.formulas.turns_whole() {
            return quote! {
                #[inline]
                fn increment(&self, d: &#element) -> #element {
                    *d
                }
            };
        }
        let pattern = if self.program.formulas.weighted().is_empty() { quote!(x) } else { quote!((x, w)) };
        self.part(
            "D = F − I of the group element with chart coordinates x (for translations F itself), without cancellation.",
            self.program.formulas.titled(Id::Increment),
            quote!(increment(&self, #pattern: &#coordinates) -> #element),
            self.program.kernel(Id::Increment),
            Some(Nesting::Element),
        )
    }

    /// F = I + D for each factor.
    fn element_of_increment(&self) -> TokenStream {
        let (private, element) = (&self.paths.private, self.element_type());
        let sum = code::nested(&self.model.element, &mut |k| {
            let access = code::accessor(&self.model.factors[k].accessor);
            match self.model.factors[k].group {
                Group::Translation(_) if access.is_empty() => quote!(*d),
                Group::Translation(_) => quote!(d #access),
                Group::UnitQuaternions => quote!(#private::quaternion_from_increment(&d #access)),
                _ => quote!(#private::from_increment(&d #access)),
            }
        });
        quote! {
            fn element(d: &#element) -> #element {
                #sum
            }
        }
    }

    fn advance(&self) -> TokenStream {
        let (configuration, motion) = (self.configuration_type(), self.motion_type());
        let motion_kind = self.motion();
        let id = if motion_kind == Motion::Increment { Id::Advance } else { Id::Displacement };
        let (formulas, kernel) = (self.program.formulas.titled(id), self.program.kernel(id));
        let (title, pattern) = match motion_kind {
            kind @ (Motion::Coordinates | Motion::Both) => (
                if self.is_compensated() {
                    "q⁺ − q = α ξ_Q(q) + β ξ_Q(ξ_Q(q)) at ξ = x where F = I + α x^ + β (x^)², without the matrix."
                } else {
                    "q⁺ = q + α ξ_Q(q) + β ξ_Q(ξ_Q(q)) at ξ = x where F = I + α x^ + β (x^)², without the matrix."
                },
                if kind == Motion::Both { quote!((x, _)) } else { quote!(x) },
            ),
            Motion::Increment => (
                if self.is_compensated() {
                    "Φ_F(q) − q of F = I + D, in which q has cancelled."
                } else {
                    "The configuration that F = I + D moves q to."
                },
                quote!(d),
            ),
        };
        let signature = quote!(advance(&self, q: &#configuration, #pattern: &#motion) -> #configuration);
        self.part(title, formulas, signature, kernel, Some(Nesting::Configuration))
    }

    fn lift(&self) -> TokenStream {
        let (configuration, element) = (self.configuration_type(), self.element_type());
        self.part(
            "The covector p carried along by F = I + D, at q⁺.",
            self.program.formulas.titled(Id::Lift),
            quote!(lift(&self, q: &#configuration, p: &#configuration, d: &#element) -> #configuration),
            self.program.kernel(Id::Lift),
            Some(Nesting::Configuration),
        )
    }

    /// Takes the rounding of many moves off rotations, unit vectors and unit quaternions.
    fn on_space(&self) -> Option<TokenStream> {
        let private = &self.paths.private;
        let mended = |function: &str, access: &TokenStream| {
            let with_rest = format_ident!("{function}_with_rest");
            let function = format_ident!("{function}");
            if self.is_compensated() {
                quote!((q #access, rest #access) = #private::#with_rest(q #access, rest #access);)
            } else {
                quote!(q #access = #private::#function(q #access);)
            }
        };
        let leaves = self.model.configurations.iter().filter_map(|leaf| {
            let access = code::accessor(&leaf.accessor);
            match leaf.space {
                LeafSpace::Group(Group::UnitQuaternions) => Some(mended("of_length_one", &quote!(#access.coords))),
                LeafSpace::Group(group) if group.is_orthogonal() => Some(mended("orthogonal", &access)),
                LeafSpace::Unit => Some(mended("of_length_one", &access)),
                LeafSpace::Vectors | LeafSpace::Group(_) => None,
            }
        });
        let leaves: Vec<TokenStream> = leaves.collect();
        if leaves.is_empty() || self.follows_great_circles() {
            return None;
        }
        let configuration = self.configuration_type();
        if let ([leaf], Layout::Leaf(_)) = (&self.model.configurations[..], &self.model.configuration)
            && !(leaf.is_quaternion || self.is_compensated())
        {
            let function = if leaf.space == LeafSpace::Unit { quote!(of_length_one) } else { quote!(orthogonal) };
            return Some(quote! {
                #[inline]
                fn on_space(q: #configuration, rest: ()) -> (#configuration, ()) {
                    (#private::#function(q), rest)
                }
            });
        }
        let (pattern, rest) =
            if self.is_compensated() { (quote!(mut rest), configuration.clone()) } else { (quote!(rest), quote!(())) };
        Some(quote! {
            #[inline]
            fn on_space(mut q: #configuration, #pattern: #rest) -> (#configuration, #rest) {
                #(#leaves)*
                (q, rest)
            }
        })
    }

    /// The parts of one substep: kicks, forces, solve, update.
    fn substep(&self, index: usize, step: &Step) -> TokenStream {
        let number = Literal::usize_unsuffixed(index);
        let kicks = self.kicks(index, step);
        let forces = self.forces_of_step(index);
        let gradients = self.model.has_covectors().then(|| self.gradients(index, step));
        let (solve, update) = (self.solve(index, step), self.update(index));
        let ends_as_it_starts = self.ends_as_it_starts(index, step).then(|| {
            quote!(
                const ENDS_AS_IT_STARTS: ::core::primitive::bool = true;
            )
        });
        self.implementation("Substep", &[&number], quote!(#ends_as_it_starts #kicks #forces #gradients #solve #update))
    }

    /// Whether a step ends with a kick of its own.
    fn ends_with_kick(&self) -> bool {
        let formulas = &self.program.formulas;
        formulas.splitting.is_none() && formulas.collocation.is_none() && !self.follows_great_circles()
    }

    fn kicks(&self, index: usize, step: &Step) -> TokenStream {
        let formulas = &self.program.formulas;
        let (scalar, configuration) = (&self.paths.scalar, self.configuration_type());
        let at = || quote!(t: #scalar, q: &#configuration);
        let kick = |name: &str, title: &str, id: Id| {
            let kernel = self.program.find(id)?;
            Some(self.optional(title, formulas.titled(id), (name, at()), kernel, None))
        };
        let start = kick("start_kick", "The kick at the start of a step.", Id::StartKick(index));
        let end = match self.same_kick(index, step).filter(|_| self.ends_with_kick()) {
            Some(first) if first == index && self.ends_as_it_starts(index, step) => None,
            Some(first) => Some(self.kick_of_start(index, first)),
            None if !self.ends_with_kick() => None,
            None => kick("end_kick", "The kick at the end of a step.", Id::EndKick(index)),
        };
        let has_rest = self.model.has_covectors() || self.is_compensated();
        let title = "What the cost gives at F = I, with the other sign.";
        let rest = has_rest.then(|| kick("rest", title, Id::RestKick(index)));
        quote!(#start #end #rest)
    }

    /// The substep whose kick at the start is that at the end.
    fn same_kick(&self, index: usize, step: &Step) -> Option<usize> {
        let is_last = index + 1 == self.program.formulas.stepped;
        // where time matters, the kick at the end of a step is the one that knows its time
        match self.program.find(Id::EndKick(index)) {
            Some(_) if step.end_is_start => Some(index),
            Some(_) if is_last && self.shares_impulse() && !self.is_timed() => Some(0),
            _ => None,
        }
    }

    /// Whether all that acts at the end of a substep is what acts at its start.
    fn ends_as_it_starts(&self, index: usize, step: &Step) -> bool {
        let has = |id: Id| self.program.find(id).is_some();
        let has_gradients =
            self.model.has_covectors() && (has(Id::StartGradient(index)) || has(Id::EndGradient(index)));
        self.ends_with_kick() && self.same_kick(index, step) == Some(index) && (step.end_is_start || !has_gradients)
    }

    /// A kick at the end that is the one at the start of another substep.
    fn kick_of_start(&self, index: usize, first: usize) -> TokenStream {
        let (private, scalar, constants) = (&self.paths.private, &self.paths.scalar, self.constants_of_step());
        let [configuration, _, momentum] = self.names_of_types();
        let first = Literal::usize_unsuffixed(first);
        let title = "The kick at the end of a step is that at the start of the next.";
        let documentation = docs::formulas(title, self.program.formulas.titled(Id::EndKick(index)), None);
        let substep = self.call_of_parts("Substep", &[&first]);
        quote! {
            #documentation
            #[inline]
            fn end_kick(&self, c: &#constants, t: #scalar, q: &#configuration) -> #private::Option<#momentum> {
                #substep::start_kick(self, c, t, q)
            }
        }
    }

    fn forces_of_step(&self, index: usize) -> TokenStream {
        let (scalar, configuration, input) = (&self.paths.scalar, self.configuration_type(), self.input_type());
        let coordinates = self.coordinates_type();
        let force = |name: &str, title: &str, id: Id, at: TokenStream| {
            let formulas = self.program.formulas.titled(Id::Force);
            let arguments = quote!(t: #scalar, q: &#configuration, #at u: &#input);
            self.program.find(id).map(|kernel| self.optional(title, formulas, (name, arguments), kernel, None))
        };
        let along = || quote!(x: &#coordinates,);
        let title = "The impulse of the force at the start of a step.";
        let start = force("start_force", title, Id::StartForce(index), quote!());
        let title = "The part of the impulse at the start of a step that depends on the velocity.";
        let moving = force("moving_force", title, Id::MovingForce(index), along());
        let title = "The impulse of the force at the end of a step.";
        let end = force("end_force", title, Id::EndForce(index), along());
        quote!(#start #moving #end)
    }

    fn gradients(&self, index: usize, step: &Step) -> TokenStream {
        if self.program.formulas.splitting.is_some() || self.program.formulas.collocation.is_some() {
            return TokenStream::new();
        }
        let scalar = &self.paths.scalar;
        let (configuration, element) = (self.configuration_type(), self.element_type());
        let gradient = |name: &str, title: &str, id: Id, at: TokenStream| {
            let kernel = self.program.find(id)?;
            let arguments = quote!(t: #scalar, q: &#configuration, #at);
            let formulas = self.program.formulas.titled(id);
            Some(self.optional(title, formulas, (name, arguments), kernel, Some(Nesting::Configuration)))
        };
        let title = "∂U₀(q), the kick of the covector at the start of a step.";
        let start = gradient("start_gradient", title, Id::StartGradient(index), quote!());
        let title = "∂U₁(q), the kick of the covector at the end of a step.";
        let end = (!self.ends_as_it_starts(index, step))
            .then(|| gradient("end_gradient", title, Id::EndGradient(index), quote!()));
        let title = "∂_q K(q, F), the kick of the covector by a cost that couples, F = I + D.";
        let coupled = gradient("coupled_gradient", title, Id::CoupledGradient(index), quote!(d: &#element));
        quote!(#start #end #coupled)
    }

    /// The momentum after the move.
    fn update(&self, index: usize) -> Option<TokenStream> {
        let kernel = self.program.find(Id::MomentumAfter(index))?;
        let (scalar, configuration) = (&self.paths.scalar, self.configuration_type());
        let (momentum, motion) = (self.momentum_type(), self.motion_type());
        let d = if self.motion() == Motion::Both { quote!((_, d)) } else { quote!(d) };
        let title = if self.is_compensated() {
            "What the move, F = I + D, adds to the momentum: M⁺ − μ, in which μ has cancelled."
        } else {
            "The momentum after the move, F = I + D."
        };
        let arguments = quote!(t: #scalar, q: &#configuration, mu: &#momentum, #d: &#motion);
        let formulas = self.program.formulas.titled(Id::MomentumAfter(index));
        Some(self.optional(title, formulas, ("update", arguments), kernel, None))
    }

    /// The chart coordinates of the group element whose momentum is μ.
    fn solve(&self, index: usize, step: &Step) -> TokenStream {
        let (private, scalar, constants) = (&self.paths.private, &self.paths.scalar, self.constants_of_step());
        let (configuration, momentum, input) = (self.configuration_type(), self.momentum_type(), self.input_type());
        let coordinates = self.coordinates_type();
        let body = if self.program.formulas.turns_whole() {
            let free_motion = self.call_of_parts("FreeMotion", &[]);
            let kept = quote!(#free_motion::kept(self, c, mu));
            quote!(#free_motion::follow(self, c, &#kept, mu).map(|(d, _)| d))
        } else {
            self.coordinates_of(index, step)
        };
        // what a call returns lies in memory in pieces, and reading it as vectors waits for them: a tenth of a short step
        let inline = if self.is_short() { quote!(#[inline(always)]) } else { quote!(#[inline]) };
        quote! {
            #inline
            fn solve(&self, c: &#constants, t: #scalar, q: &#configuration, mu: &#momentum, u: &#input) -> #private::Solved<#coordinates> {
                #body
            }
        }
    }

    /// The coordinates that the equations of a step give, or the error of one of them.
    fn coordinates_of(&self, index: usize, step: &Step) -> TokenStream {
        let private = &self.paths.private;
        if let [solve] = &step.solves[..]
            && !matches!(solve.solution, Solution::FreeRotation | Solution::Explicit)
        {
            return self.found(index, 0, solve, None);
        }
        let (solutions, result) = self.solved(index, step, false);
        quote!(#solutions #private::Ok(#result))
    }

    /// What solves an equation, as a result where it can fail.
    fn found(&self, index: usize, number: usize, solve: &Solve, given: Option<TokenStream>) -> TokenStream {
        let (private, name) = (&self.paths.private, self.names.equation(self.program.suffix(index), number));
        let held = self.held_by_equation(solve).into_iter().map(|held| match held {
            "system" => quote!(self),
            held => format_ident!("{held}").to_token_stream(),
        });
        let (equation, target) = (quote!(#name(#(#held),*)), self.part_of("mu", &solve.momenta));
        match solve.solution {
            Solution::ClosedForm => quote!(#name::closed_form(&#equation, #target)),
            Solution::Explicit => quote!(#name::explicit(&#equation, #target #given)),
            Solution::Linear => quote!(#private::solve_linear_equation(&#equation, #target)),
            Solution::Newton if self.program.find(solve.id(Id::Residual)).is_some() => {
                quote!(#private::solve_fixed_point(&#equation, #target))
            }
            // by construction: free rotations are no equations of a type
            Solution::Newton | Solution::FreeRotation => quote!(#private::solve(&#equation, #target)),
        }
    }

    /// The solutions of a step, equation by equation, and the coordinates that they make; with `kept` those of motions that are known.
    pub(super) fn solved(&self, index: usize, step: &Step, kept: bool) -> (TokenStream, TokenStream) {
        let private = &self.paths.private;
        let entry = |component: &usize| {
            let position = |solve: &Solve| solve.components.iter().position(|other| other == component);
            let found = step.solves.iter().enumerate().find_map(|(number, solve)| Some((number, position(solve)?)));
            // by construction: every component belongs to one equation
            let (number, position) = found.unwrap_or((0, 0));
            let (solution, position) = (format_ident!("x{}", number + 1), Literal::usize_unsuffixed(position));
            quote!(#solution[#position])
        };
        let solutions = step.solves.iter().enumerate().map(|(number, solve)| {
            let solution = format_ident!("x{}", number + 1);
            if solve.solution == Solution::FreeRotation {
                let target = self.part_of("mu", &solve.momenta);
                return self.found_free_rotation(index, number, solve, &target, kept);
            }
            let given = solve.given.iter().map(entry);
            let given = (!solve.given.is_empty()).then(|| quote!(, &#private::vector([#(#given),*])));
            let found = self.found(index, number, solve, given);
            let fails = (solve.solution != Solution::Explicit).then(|| quote!(?));
            quote!(let #solution = #found #fails;)
        });
        let solutions = quote!(#(#solutions)*);
        let components: Vec<usize> = (0..self.dimension()).collect();
        let entries = components.iter().map(entry);
        let x = if step.solves.len() == 1 { quote!(x1) } else { quote!(#private::vector([#(#entries),*])) };
        let weights = (1..=self.program.formulas.weighted().len()).map(|number| format_ident!("w{number}"));
        let result = if self.program.formulas.weighted().is_empty() { x } else { quote!((#x, [#(#weights),*])) };
        (solutions, result)
    }

    /// Some components of a flat vector, by reference; all of them are the vector itself.
    pub(super) fn part_of(&self, vector: &str, components: &[usize]) -> TokenStream {
        let (private, vector) = (&self.paths.private, format_ident!("{vector}"));
        if components.iter().copied().eq(0..self.dimension()) {
            return quote!(#vector);
        }
        let entries = components.iter().map(|&component| {
            let component = Literal::usize_unsuffixed(component);
            quote!(#vector[#component])
        });
        quote!(&#private::vector([#(#entries),*]))
    }
}
