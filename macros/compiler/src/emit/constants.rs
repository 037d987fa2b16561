//! The values that a stepper computes once: their type, the checks before, and their code.

use clebsch_symbolic::{IntoList, Role, both, integer};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::block::matrix;
use super::functions::takes_constants;
use super::scope::{Scope, index, size};
use super::{Emitter, SystemEmitter};
use crate::derive::{Id, RotatingBody, Solution};
use crate::lower::{Kernel, Solve};
use crate::model::{Access, Promise, Side};

impl Emitter<'_, '_> {
    pub(super) fn constants_type(&self) -> TokenStream {
        let name = self.names.free("Constants");
        let constants = self.constants_of_stepper().into_iter().map(|[name, ty, _]| quote!(#name: #ty,));
        let [declared, parameter] =
            both([quote!(<T: runtime::Scalar>), quote!(<T>)], |tokens| self.is_generic().then_some(tokens));
        quote! {
            /// The constants of all steps of one stepper.
            #[derive(::core::clone::Clone, ::core::fmt::Debug)]
            pub struct #name #declared { #(#constants)* }
            type C = #name #parameter;
        }
    }

    /// Each constant with its type and its value, that of the variable with its name where it says none.
    fn constants_of_stepper(&self) -> Vec<[TokenStream; 3]> {
        let (scope, kernel) = (self.scope_of_system(), self.program.kernel(Id::Constants));
        let numbers = self.kernels.constant_names.iter().enumerate().map(|(index, name)| {
            let (name, value) = (format_ident!("{name}"), scope.scalar(kernel, index));
            [quote!(#name), quote!(T), quote!(: #value)]
        });
        let orientations = self.solves().filter(|solve| self.has_orientation(solve)).map(|solve| {
            let name = self.constant_of(solve);
            let whole = self.orientation_of_inertia(&[solve.components.as_slice(), &solve.coupled].concat());
            // det Σ is the product of the determinant of the substituted block and of that of the others
            let coupled = (!solve.coupled.is_empty()).then(|| self.orientation_of_inertia(&solve.coupled));
            let coupled = coupled.map(|coupled| quote!(* #coupled));
            [quote!(#name), quote!(runtime::Orientation), quote!(: #whole #coupled)]
        });
        let rotations = self.free_rotations().map(|(name, solve)| {
            let (inertia, kind) = (self.block_of_inertia(solve), self.kind_of_free_rotation());
            let value = match self.tolerance() {
                Some(part) => quote!(: runtime::#kind::to_tolerance(&#inertia, h, #part)?),
                None => quote!(: runtime::#kind::new(&#inertia, h)?),
            };
            [quote!(#name), quote!(runtime::#kind<T>), value]
        });
        let bodies = self.solves().filter_map(|solve| {
            let (name, inertia, part) =
                (self.constant_of(solve), self.block_of_inertia(solve), self.part_of_step(solve));
            let (kind, parameters) = match tensor(solve.solution) {
                Some(tensor) => (quote!(RotatingBody), quote!(T, #tensor)),
                None if is_in_four_space(solve.solution) => (quote!(RotatingBody4), quote!(T)),
                None => return None,
            };
            Some([quote!(#name), quote!(runtime::#kind<#parameters>), quote!(: runtime::#kind::new(&#inertia, #part)?)])
        });
        let formulas = &self.formulas;
        let is_scheduled = formulas.has_own_schedule();
        let needs_step_size =
            is_scheduled || self.keeps_matrices || self.has_constrained_edges() || self.reads_step_size();
        let step_size = needs_step_size.then(|| [quote!(step_size), quote!(T), quote!(: h)]);
        let inverse = (!formulas.inertia_moves()).then(|| [quote!(inertia_inverse), self.inverse().0, quote!()]);
        numbers.chain(orientations).chain(rotations).chain(bodies).chain(step_size).chain(inverse).into_list()
    }

    /// Whether unrolled code of a step reads h: together with the time it is no constant, as in cos(t + h).
    fn reads_step_size(&self) -> bool {
        let reads = |kernel: &Kernel| kernel.inputs().iter().any(|(input, _)| input.role == Role::StepSize);
        self.kernels.all().any(|(id, kernel)| id != Id::Constants && takes_constants(id) && reads(kernel))
    }

    /// The type of Σ⁻¹, and the function that makes it.
    fn inverse(&self) -> (TokenStream, TokenStream) {
        let dimension = size(self.dimension);
        if self.has_uniform_inertia() {
            (quote!(T), quote!(invert_uniform))
        } else if self.keeps_matrices {
            (quote!(runtime::InertiaInverse<T, #dimension>), quote!(InertiaInverse::new))
        } else {
            (matrix(self.dimension, self.dimension), quote!(invert))
        }
    }

    /// Whether Σ is stored as the number κ of κI.
    pub(super) fn has_uniform_inertia(&self) -> bool {
        self.formulas.uniform_inertia.is_some()
    }

    /// Σ as an expression, or κ of κI.
    pub(super) fn inertia(&self, scope: &Scope<'_, '_>) -> TokenStream {
        let kernel = self.program.kernel(Id::Inertia);
        if self.has_uniform_inertia() {
            return scope.body_of_scalar(kernel);
        }
        if !self.keeps_matrices {
            return scope.body(kernel);
        }
        let (locals, inertia) = scope.matrix_of(kernel, 0, "x", |role| matches!(role, Role::Algebra(_)));
        quote!(#locals #inertia)
    }

    /// Whether the orientation of an equation is a constant, made of Σ.
    pub(super) fn has_orientation(&self, solve: &Solve) -> bool {
        let iterates = matches!(solve.solution, Solution::Newton | Solution::Linear);
        iterates && !self.formulas.inertia_moves()
    }

    fn solves(&self) -> impl Iterator<Item = &Solve> {
        self.program.steps.iter().flat_map(|step| &step.solves)
    }

    /// The name of the constant that belongs to an equation: its orientation, or those of a free rotation.
    pub(super) fn constant_of(&self, solve: &Solve) -> Ident {
        let kind = match solve.solution {
            Solution::FreeRotation => "free_rotation",
            Solution::Rotation(_) => "body",
            _ => "orientation",
        };
        format_ident!("{kind}{}_{}", self.program.suffix(solve.substep), solve.number + 1)
    }

    /// The equations that are solved by the free rotation of a body, with the names of its constants.
    pub(super) fn free_rotations(&self) -> impl Iterator<Item = (Ident, &Solve)> {
        let free = self.solves().filter(|solve| solve.solution == Solution::FreeRotation);
        free.map(|solve| (self.constant_of(solve), solve))
    }

    /// s·h, the time that the Gibbs vector of a rotating body is a velocity times.
    fn part_of_step(&self, solve: &Solve) -> TokenStream {
        let block = self.symbols.blocks_of(&solve.components)[0];
        let (numerator, denominator) = self.formulas.chart_slope(block);
        let divisor = self.formulas.substeps[solve.substep].divisor;
        let part = self.scope_of_system().number(&(integer(numerator) / integer(denominator * divisor)));
        quote!(#part * h)
    }

    /// The part of `inertia` that belongs to a free rotation.
    pub(super) fn block_of_inertia(&self, solve: &Solve) -> TokenStream {
        if !self.has_uniform_inertia() {
            return self.part_of_inertia(&solve.components);
        }
        let matrix = matrix(solve.components.len(), solve.components.len());
        quote!(<#matrix>::from_diagonal_element(inertia))
    }

    /// The rows and columns of `inertia` for some components.
    fn part_of_inertia(&self, components: &[usize]) -> TokenStream {
        let (first, count) = (components.first().copied().unwrap_or(0), components.len());
        if !components.iter().copied().eq(first..first + count) {
            let rows = components.iter().map(|&i| {
                let row = components.iter().map(|&j| index(false, (i, j)));
                quote!([#(inertia #row),*])
            });
            return quote!(runtime::matrix([#(#rows),*]));
        }
        if count == self.dimension {
            return quote!(inertia);
        }
        let [first, count] = both([first, count], size);
        quote!(runtime::Blocks::block::<#count, #count>(&inertia, #first, #first))
    }

    pub(super) fn is_left(&self, solve: &Solve) -> bool {
        self.model.factors[self.factor_of(solve)].side == Side::Left
    }

    /// The number of the factor that an equation is solved for.
    pub(super) fn factor_of(&self, solve: &Solve) -> usize {
        self.symbols.blocks[self.symbols.blocks_of(&solve.components)[0]].factor
    }

    /// The sign of det Σ/h for some components: of Dρ at the identity for short steps, but for positive factors.
    fn orientation_of_inertia(&self, components: &[usize]) -> TokenStream {
        if self.has_uniform_inertia() {
            let count = size(components.len());
            return quote!(runtime::orientation_of_uniform(inertia / h, #count)?);
        }
        let part = self.part_of_inertia(components);
        quote!(runtime::orientation_of_inertia(&#part, h)?)
    }

    /// The body of the function that makes the constants.
    pub(super) fn constants(&self, kernel: &Kernel) -> TokenStream {
        let (scope, name) = (self.scope_of_system(), self.names.free("Constants"));
        let (checks, symmetric) = (self.checks(), self.checks_of_symmetry());
        let inertia = (!self.formulas.inertia_moves()).then(|| {
            let (inertia, (_, invert)) = (self.inertia(&scope), self.inverse());
            let check =
                if self.has_uniform_inertia() { quote!(check_definite_uniform) } else { quote!(check_definite) };
            let check = self.formulas.is_definite().then(|| quote!(runtime::#check(&inertia)?;));
            quote!(let inertia = { #inertia }; let inertia_inverse = runtime::#invert(&inertia)?; #check)
        });
        let locals = scope.locals(kernel);
        let constants = self.constants_of_stepper().into_iter().map(|[name, _, value]| quote!(#name #value,));
        quote!(#checks #symmetric #inertia #locals runtime::Ok(#name { #(#constants)* }))
    }

    /// Checks of the matrices that have to be symmetric though nothing is promised of them.
    fn checks_of_symmetry(&self) -> TokenStream {
        let (system, required) = (self.receiver(), &self.formulas.symmetric.required);
        let leaves = self
            .model
            .parameters
            .iter()
            .flat_map(|parameter| parameter.leaves.iter().map(move |leaf| (parameter, leaf)));
        let leaves = leaves.filter(|(_, leaf)| required.contains(&leaf.symbol));
        let checks = leaves.map(|(parameter, leaf)| {
            let (field, access) = (&parameter.field, &leaf.accessor);
            self.check_of(Promise::Symmetric, &parameter.name, &quote!(#system.#field #access))
        });
        checks.collect()
    }
}

/// Whether an equation is that of a rotating body in four dimensions.
pub(super) fn is_in_four_space(solution: Solution) -> bool {
    solution == Solution::Rotation(RotatingBody::FourSpace)
}

/// The type of the inertia of a rotating body in space.
pub(super) fn tensor(solution: Solution) -> Option<TokenStream> {
    match solution {
        Solution::Rotation(RotatingBody::Space { is_principal: true, .. }) => Some(quote!(runtime::Diagonal<T>)),
        Solution::Rotation(RotatingBody::Space { .. }) => Some(quote!(runtime::Symmetric<T>)),
        _ => None,
    }
}

impl SystemEmitter<'_, '_> {
    /// Checks of every field that a closure reads: that it is finite, and the user's promises. A field that only bounds
    /// read may be infinite.
    pub(super) fn checks(&self) -> TokenStream {
        let system = self.receiver();
        let checks = self.model.parameters.iter().map(|parameter| {
            let (field, name) = (&parameter.field, &parameter.name);
            let of_leaf = |access: &Access| quote!(#system.#field #access);
            let promises = parameter.promise.iter().flat_map(|promise| {
                parameter.leaves.iter().map(move |leaf| self.check_of(*promise, name, &of_leaf(&leaf.accessor)))
            });
            let check = if parameter.is_limit { quote!(check_limit) } else { quote!(check_finite) };
            quote! {
                runtime::#check(#name, &#system.#field)?;
                #(#promises)*
            }
        });
        checks.collect()
    }

    /// The check of a promise of the user about a value.
    pub(super) fn check_of(&self, promise: Promise, name: &str, value: &TokenStream) -> TokenStream {
        let check = match promise {
            Promise::Symmetric => quote!(check_symmetric),
            Promise::Diagonal => quote!(check_diagonal),
            Promise::Unit => quote!(check_unit),
        };
        quote!(runtime::#check(#name, &#value)?;)
    }
}
