//! The parts of a step: one function for each, as the schemes of the runtime call them.

use clebsch_symbolic::{Group, both};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::function::{Body, Function};
use super::functions::{PARTS, SUBSTEP};
use super::scope::{nested, size};
use super::{Emitter, flag};
use crate::derive::{Id, RotatingBody, Solution};
use crate::lower::{Kernel, Solve};
use crate::model::LeafSpace;

/// The most operations of a step, apart from those of iterations, that is inlined wherever it is called.
const SHORT_STEP: usize = 192;

impl Emitter<'_, '_> {
    /// The implementations of `Parts`, of `Substep` for each substep, of the other traits that the scheme calls, and of `Reacting`.
    pub(super) fn parts(&self) -> TokenStream {
        let (shared, of_scheme) = (self.shared_parts(), self.parts_of_scheme());
        let substeps = (0..self.program.steps.len()).map(|index| self.substep(index));
        let reacting = self.reacting();
        quote!(#shared #(#substeps)* #of_scheme #reacting)
    }

    /// The types and the names of the data that moves q and N, in signatures, and how it is made. It is D = F − I, the chart coordinates x,
    /// both, or D and c of F − I = c·D.
    pub(super) fn word_of_step(&self, word: &str) -> Option<TokenStream> {
        let is_displaced = || self.program.find(Id::Displacement).is_some();
        let updates = |index| self.program.find(Id::MomentumAfter(index)).is_some();
        let is_updated = || (0..self.formulas.stepped).any(updates);
        Some(match word {
            "X" => self.coordinates()[0].clone(),
            "Coordinates" => self.coordinates()[1].clone(),
            "Motion" | "Moved" | "Increment" | "Made" => {
                let [coordinates, x] = self.coordinates();
                let turns = self.formulas.turns_momenta();
                let turned = if turns { x.clone() } else { quote!(_) };
                let both = || [quote!((#coordinates, F)), quote!((*x, increment()))];
                let scaled = size(self.formulas.scaled().len());
                let names = match (is_displaced(), is_updated()) {
                    _ if self.program.find(Id::ScaledIncrement).is_some() => {
                        [[quote!((F, [T; #scaled])), quote!()], [quote!((d, scale)), quote!((d, scale))]]
                    }
                    (true, true) => [both(), [quote!((#x, _)), quote!((#turned, d))]],
                    (true, false) => [[coordinates, quote!(*x)], [x, quote!(d)]],
                    (false, true) if turns => [both(), [quote!((_, d)), quote!((#turned, d))]],
                    (false, _) => [[quote!(F), quote!(increment())], [quote!(d), quote!(d)]],
                };
                let [[motion, made], [moved, increment]] = names;
                match word {
                    "Motion" => motion,
                    "Made" => made,
                    "Moved" => moved,
                    _ => increment,
                }
            }
            "Rest" if self.formulas.is_compensated() => quote!(Q),
            "Rest" => quote!(()),
            _ => return None,
        })
    }

    /// The type of the chart coordinates of all factors, and their pattern; F − I where a motion gives that at once. Weights stand with
    /// coordinates that are given up to a factor.
    fn coordinates(&self) -> [TokenStream; 2] {
        let count = size(self.formulas.weighted().len());
        if self.formulas.turns_whole() {
            [quote!(F), quote!(d)]
        } else if self.formulas.weighted().is_empty() {
            [quote!(Mu), quote!(x)]
        } else {
            [quote!((Mu, [T; #count])), quote!((x, w))]
        }
    }

    /// Whether the steps of a single substep are so short that they are inlined wherever they are called.
    pub(super) fn is_short(&self) -> bool {
        let formulas = &self.formulas;
        let is_composed = formulas.stages().is_some() || formulas.monitor.is_some() || formulas.collocation.is_some();
        let is_single = formulas.stepped == 1 && !is_composed;
        is_single && self.program.cost_of_moves(0).total() <= SHORT_STEP
    }

    /// A part of a step that takes no iteration stands in the step, however long it is: a call hands vectors through memory.
    fn within_step<'k>(&self, body: Body<'k>) -> Body<'k> {
        let is_explicit = |solve: &Solve| matches!(solve.solution, Solution::ClosedForm | Solution::Explicit);
        let mut solves = self.program.steps.iter().flat_map(|step| &step.solves);
        let is_single = self.formulas.stepped == 1 && self.formulas.stages().is_none();
        let stands = is_single && (self.program.turns_in_plane() || !self.keeps_matrices && solves.all(is_explicit));
        if stands && body.inline.is_none() { body.inlined(quote!(#[inline(always)])) } else { body }
    }

    /// Increment, advance and lift, which all substeps share.
    fn shared_parts(&self) -> TokenStream {
        let sums = if self.formulas.is_compensated() { quote!(Compensated) } else { quote!(Plain) };
        let is_short = self.is_short().then(|| flag("IS_SHORT", true));
        let no_covectors = (!self.model.has_covectors()).then(|| flag("HAS_COVECTORS", false));
        let [coordinates, motion] = both(["X", "Motion"], |word| self.word_of_step(word));
        let words = |word: &str| self.word_of_step(word);
        let functions = self.functions(PARTS, (0, 0), &words, |function, kernel| {
            self.shared_part(function, kernel).map(|body| self.within_step(body))
        });
        let items = quote! {
            type Sums = runtime::#sums;
            type Coordinates = #coordinates;
            type Motion = #motion;
            #is_short
            #no_covectors
            #functions
        };
        self.implementation("Parts", &[], items)
    }

    fn shared_part<'k>(&'k self, function: &Function, kernel: Option<&'k Kernel>) -> Option<Body<'k>> {
        let computed = || Some(function.computes(&self.scope_of_step(), kernel?));
        let titled =
            |title| computed().map(|body| if self.formulas.is_compensated() { body.titled(title) } else { body });
        match function.name {
            "increment" if self.formulas.turns_whole() => Some(Body::from(quote!(*d)).titled("")),
            "motion" if function.kernel == Id::ScaledIncrement => {
                let (scope, kernel) = (self.scope_of_step(), kernel?);
                let (locals, element) = (scope.locals(kernel), scope.element(kernel, 0));
                let scales = (self.model.factors.len()..kernel.outputs.len()).map(|place| scope.scalar(kernel, place));
                Some(Body::new(kernel, quote!(#locals (#element, [#(#scales),*]))))
            }
            "motion" if self.program.find(Id::ScaledIncrement).is_some() => None,
            "motion" => Some(Body::from(self.word_of_step("Made")?).inlined(quote!(#[inline(always)]))),
            "element" => Some(Body::from(self.element_of_increment()).inlined(quote!())),
            "advance" if function.kernel == Id::Displacement => {
                titled("q⁺ − q = α ξ_Q(q) + β ξ_Q(ξ_Q(q)) at ξ = x where F = I + α x^ + β (x^)², without the matrix.")
            }
            "advance" if function.kernel == Id::ScaledAdvance => {
                titled("Φ_F(q) − q of F = I + c·D, in which q has cancelled.")
            }
            "advance" if [Id::Displacement, Id::ScaledAdvance].iter().any(|id| self.program.find(*id).is_some()) => {
                None
            }
            "advance" => titled("Φ_F(q) − q of F = I + D, in which q has cancelled."),
            "lift" if !self.model.has_covectors() => None,
            "on_space" => Some(Body::from(self.on_space()?)),
            _ => computed(),
        }
    }

    /// F = I + D for each factor.
    fn element_of_increment(&self) -> TokenStream {
        nested(&self.model.element, &mut |k| {
            let access = &self.model.factors[k].accessor;
            match self.model.factors[k].group {
                Group::Translation(_) if access.is_whole() => quote!(*d),
                Group::Translation(_) => quote!(d #access),
                Group::UnitQuaternions => quote!(runtime::quaternion_from_increment(&d #access)),
                _ => quote!(runtime::from_increment(&d #access)),
            }
        })
    }

    /// Takes the rounding of many moves off rotations, unit vectors and unit quaternions.
    pub(super) fn on_space(&self) -> Option<TokenStream> {
        if self.program.turns_in_plane() {
            return None;
        }
        let mut mended = TokenStream::new();
        for leaf in &self.model.configurations {
            let access = &leaf.accessor;
            let (function, access) = match leaf.space {
                LeafSpace::Group(Group::UnitQuaternions) => ("of_length_one", quote!(#access.coords)),
                LeafSpace::Group(group) if group.is_orthogonal() => ("orthogonal", quote!(#access)),
                LeafSpace::Unit => ("of_length_one", quote!(#access)),
                LeafSpace::Symmetric => ("symmetric", quote!(#access)),
                LeafSpace::Orthonormal => ("orthogonal", quote!(#access)),
                LeafSpace::Projector(_) => ("projector", quote!(#access)),
                LeafSpace::Vectors | LeafSpace::Group(_) => continue,
            };
            let with_rest = format_ident!("{function}_with_rest");
            let function = format_ident!("{function}");
            mended.extend(if self.formulas.is_compensated() {
                quote!((q #access, rest #access) = runtime::#with_rest(q #access, rest #access);)
            } else if access.is_empty() {
                return Some(quote!((runtime::#function(q), rest)));
            } else {
                quote!(q #access = runtime::#function(q #access);)
            });
        }
        (!mended.is_empty()).then(|| quote!(let (mut q, mut rest) = (q, rest); #mended (q, rest)))
    }

    /// The parts of one substep: kicks, forces, solve, update.
    fn substep(&self, index: usize) -> TokenStream {
        let ends_as_it_starts = self.ends_as_it_starts(index).then(|| flag("ENDS_AS_IT_STARTS", true));
        let words = |word: &str| self.word_of_step(word);
        let functions = self.functions(SUBSTEP, (index, 0), &words, |function, kernel| {
            self.part_of_substep(index, function, kernel).map(|body| self.within_step(body))
        });
        self.implementation("Substep", &[size(index)], quote!(#ends_as_it_starts #functions))
    }

    fn part_of_substep<'k>(
        &'k self,
        index: usize,
        function: &Function,
        kernel: Option<&'k Kernel>,
    ) -> Option<Body<'k>> {
        let computed = || Some(function.computes(&self.scope_of_step(), kernel?));
        let steps_otherwise = self.formulas.has_own_schedule();
        let has_covectors = self.model.has_covectors();
        match function.name {
            "end_kick" if !self.ends_with_kick() || self.ends_as_it_starts(index) => None,
            "end_kick" => {
                let Some(first) = self.same_kick(index) else { return computed() };
                let substep = self.trait_of_parts("Substep", &[size(first)]);
                let body = Body::from(quote!(#substep::start_kick(self, c, t, q)));
                Some(body.titled("The kick at the end of a step is that at the start of the next."))
            }
            "rest" if !has_covectors && !self.formulas.is_compensated() => None,
            "end_gradient" if self.ends_as_it_starts(index) => None,
            "start_gradient" | "end_gradient" | "coupled_gradient" if !has_covectors || steps_otherwise => None,
            "solve" => {
                let body = Body::from(self.solve(&self.program.steps[index]));
                // the result of a call lies in memory in pieces, and reading it as vectors waits for them: a tenth of a
                // short step
                let turns = |solve: &Solve| matches!(solve.solution, Solution::Rotation(RotatingBody::FourSpace));
                let is_inlined = self.is_short() || self.program.steps[index].solves.iter().any(turns);
                Some(if is_inlined { body.inlined(quote!(#[inline(always)])) } else { body })
            }
            "update" if self.formulas.is_compensated() => {
                let title = match self.program.find(Id::ScaledIncrement) {
                    Some(_) => {
                        "The increment of the momentum by the move, F = I + c·D: M⁺ − μ, in which μ has cancelled."
                    }
                    None => "The increment of the momentum by the move, F = I + D: M⁺ − μ, in which μ has cancelled.",
                };
                Some(computed()?.titled(title))
            }
            "update" if self.program.find(Id::ScaledIncrement).is_some() => {
                Some(computed()?.titled("The momentum after the move, F = I + c·D."))
            }
            "update" if self.formulas.turns_momenta() => {
                Some(computed()?.titled("The momentum after the move by the element with chart coordinates x, or x/w."))
            }
            _ => computed(),
        }
    }

    /// Whether a step ends with a kick of its own.
    fn ends_with_kick(&self) -> bool {
        !self.formulas.has_own_schedule() && !self.program.turns_in_plane()
    }

    /// The substep whose kick at the start is that at the end.
    fn same_kick(&self, index: usize) -> Option<usize> {
        self.program.find(Id::EndKick(index))?;
        let is_last = index + 1 == self.formulas.stepped;
        // where time matters, the kick at the end of a step is the one that knows its time
        let is_first = is_last && self.shares_impulse() && !self.formulas.is_timed();
        if self.program.steps[index].end_is_start { Some(index) } else { is_first.then_some(0) }
    }

    /// Whether the kicks at the end of a substep are those at its start.
    fn ends_as_it_starts(&self, index: usize) -> bool {
        let has = |id: Id| self.program.find(id).is_some();
        let has_gradients =
            self.model.has_covectors() && (has(Id::StartGradient(index)) || has(Id::EndGradient(index)));
        let is_same = self.ends_with_kick() && self.same_kick(index) == Some(index);
        is_same && (self.program.steps[index].end_is_start || !has_gradients)
    }
}
