//! How a step solves its equations, one after the other.

use clebsch_symbolic::{Group, IntoList, integer};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::Emitter;
use super::constants::tensor;
use super::scope::size;
use crate::derive::{Id, RotatingBody, Solution};
use crate::lower::{Solve, Step};

impl Emitter<'_, '_> {
    /// The chart coordinates of the group element whose momentum is μ, or the error of one of the equations.
    pub(super) fn solve(&self, step: &Step) -> TokenStream {
        if self.formulas.turns_whole() {
            let free_motion = self.trait_of_parts("FreeMotion", &[]);
            let kept = quote!(#free_motion::kept(self, c, mu));
            return quote!(#free_motion::follow(self, c, &#kept, mu).map(|(d, _)| d));
        }
        if let [solve] = &step.solves[..]
            && solve.dimension == self.dimension
            && !matches!(solve.solution, Solution::FreeRotation | Solution::Explicit)
            && self.formulas.weighted().is_empty()
        {
            return self.found(solve, None);
        }
        let (solutions, result) = self.solved(step, false);
        quote!(#solutions runtime::Ok(#result))
    }

    /// The solution of an equation, as a result if it can fail.
    fn found(&self, solve: &Solve, given: Option<TokenStream>) -> TokenStream {
        let name = self.equation_name(solve);
        let (equation, target) = self.equation_and_target(solve);
        match solve.solution {
            Solution::ClosedForm if solve.has_multipliers => quote!(#name::constrained_form(&#equation, #target)),
            Solution::ClosedForm => quote!(#name::closed_form(&#equation, #target)),
            Solution::Explicit => quote!(#name::explicit(&#equation, #target #given)),
            Solution::Rotation(RotatingBody::FourSpace) => quote!(runtime::solve_rotation_4d(&#equation, #target)),
            Solution::Rotation(_) if self.weight_of(solve).is_some() => {
                quote!(runtime::turn_of_body(&#equation, #target))
            }
            Solution::Rotation(_) => quote!(runtime::solve_rotation(&#equation, #target)),
            Solution::Linear => quote!(runtime::solve_linear_equation(&#equation, #target)),
            Solution::Newton if self.program.find(solve.id(Id::Residual)).is_some() => {
                quote!(runtime::solve_fixed_point(&#equation, #target))
            }
            // by construction: free rotations are no equations of a type
            Solution::Newton | Solution::FreeRotation => quote!(runtime::solve(&#equation, #target)),
        }
    }

    /// The solutions of a step, equation by equation, and the coordinates that they make; with `kept` those of motions that are known.
    pub(super) fn solved(&self, step: &Step, kept: bool) -> (TokenStream, TokenStream) {
        let entry = |component: &usize| {
            let position = |solve: &Solve| solve.components.iter().position(|other| other == component);
            let found = step.solves.iter().find_map(|solve| Some((solve.number, position(solve)?)));
            // a coordinate without an equation stays zero
            let Some((number, position)) = found else { return self.scope_of_step().number(&integer(0)) };
            let (solution, position) = (solution_name(number), size(position));
            quote!(#solution[#position])
        };
        let solutions = step.solves.iter().map(|solve| {
            if solve.solution == Solution::FreeRotation {
                return self.found_free_rotation(solve, kept);
            }
            let given = solve.given.iter().map(entry);
            let given = (!solve.given.is_empty()).then(|| quote!(, &runtime::vector([#(#given),*])));
            let solution = solution_name(solve.number);
            let found = match self.equation_of_body(solve).filter(|_| kept) {
                Some((equation, target)) => {
                    let index = self.place_among_kept(solve);
                    let name = if self.weight_of(solve).is_some() { "turn_of_motion" } else { "rotation_of_motion" };
                    let name = format_ident!("{name}");
                    quote!(runtime::#name(&#equation, kept[#index], #target))
                }
                None => self.found(solve, given),
            };
            let fails = (solve.solution != Solution::Explicit).then(|| quote!(?));
            match self.weight_of(solve).map(weight_name) {
                Some(weight) => quote!(let (#weight, #solution) = #found #fails;),
                None => quote!(let #solution = #found #fails;),
            }
        });
        let solutions = solutions.collect();
        let components: Vec<usize> = (0..self.dimension).into_list();
        let entries = components.iter().map(entry);
        let is_all = step.solves.first().is_some_and(|solve| solve.dimension == self.dimension);
        let x = if is_all { quote!(x1) } else { quote!(runtime::vector([#(#entries),*])) };
        let weights = (0..self.formulas.weighted().len()).map(weight_name);
        let result = if weights.len() == 0 { x } else { quote!((#x, [#(#weights),*])) };
        (solutions, result)
    }

    /// The coordinates of a factor that moves freely; `kept` are the motions of many steps.
    fn found_free_rotation(&self, solve: &Solve, kept: bool) -> TokenStream {
        let (rotation, solution) = (self.constant_of(solve), solution_name(solve.number));
        let (weight, target) = (self.weight_of(solve), self.momentum_of_free_rotation(solve));
        let index = self.place_among_kept(solve);
        let is_quaternion = self.model.factors[self.factor_of(solve)].group == Group::UnitQuaternions;
        let name = match weight {
            Some(_) if is_quaternion => "shorter_turn",
            Some(_) => "turn",
            None => "gibbs_vector",
        };
        let method = format_ident!("{name}{}", if kept { "_of" } else { "" });
        let motion = kept.then(|| quote!(&kept[#index],));
        let found = quote!(runtime::FreeRotation::#method(&c.#rotation, #motion #target)?);
        let turned_back = self.is_left(solve).then(|| quote!(let #solution = -#solution;));
        match weight.map(weight_name) {
            Some(weight) => quote!(let (#weight, #solution) = #found; #turned_back),
            None => quote!(let #solution = #found; #turned_back),
        }
    }

    /// The place of an equation among those whose constants stay the same along a motion.
    fn place_among_kept(&self, solve: &Solve) -> Literal {
        size(self.kept().take_while(|other| other.number != solve.number).count())
    }

    /// The equation of a rotating body, and its momentum.
    pub(super) fn equation_of_body(&self, solve: &Solve) -> Option<(TokenStream, TokenStream)> {
        tensor(solve.solution)?;
        Some(self.equation_and_target(solve))
    }

    /// An equation, and the components of the momentum that it holds.
    fn equation_and_target(&self, solve: &Solve) -> (TokenStream, TokenStream) {
        let name = self.equation_name(solve);
        let held = self.held_by_equation(solve).into_iter();
        let held = held.map(|(name, _)| format_ident!("{}", if name == "system" { "self" } else { name }));
        (quote!(#name(#(#held),*)), self.part_of_momentum(&solve.momenta))
    }

    /// The declared tolerance.
    pub(super) fn tolerance(&self) -> Option<Literal> {
        Some(Literal::f64_unsuffixed(self.model.dials.tolerance.as_ref()?.value))
    }

    /// The declared number of iterations.
    pub(super) fn iterations(&self) -> Option<Literal> {
        Some(Literal::u32_unsuffixed(self.model.dials.limit()?))
    }

    /// The number of the weight of the chart coordinates of an equation, where they are given up to a factor.
    fn weight_of(&self, solve: &Solve) -> Option<usize> {
        self.formulas.weighted().iter().position(|&factor| factor == self.factor_of(solve))
    }

    /// The momentum of a free rotation. Spatial momenta move as those of the body that turns back.
    pub(super) fn momentum_of_free_rotation(&self, solve: &Solve) -> TokenStream {
        let momentum = self.part_of_momentum(&solve.momenta);
        if self.is_left(solve) { quote!(&-#momentum) } else { momentum }
    }

    /// Some components of the momentum, by reference; all of them are the momentum itself.
    fn part_of_momentum(&self, components: &[usize]) -> TokenStream {
        if components.iter().copied().eq(0..self.dimension) {
            return quote!(mu);
        }
        let components = components.iter().copied().map(size);
        quote!(&runtime::vector([#(mu[#components]),*]))
    }
}

fn solution_name(number: usize) -> Ident {
    format_ident!("x{}", number + 1)
}

fn weight_name(number: usize) -> Ident {
    format_ident!("w{}", number + 1)
}
