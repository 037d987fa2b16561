//! What a stepper computes once: its type, and the checks and code that make it.

use clebsch_symbolic::Role;
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::{Emitter, SystemEmitter, code, docs, matrices};
use crate::derive::{Id, Solution};
use crate::lower::Solve;
use crate::model::{Promise, Side};

impl Emitter<'_, '_> {
    /// The struct of the constants.
    pub(super) fn constants_type(&self) -> TokenStream {
        let (private, scalar) = (&self.paths.private, &self.paths.scalar);
        let names = self.program.constant_names.iter().map(|name| format_ident!("{name}"));
        let orientations = self.implicit_solves().map(|(name, _)| name);
        let inverse = match self.has_uniform_inertia() {
            true => quote!(#scalar),
            false if self.program.form.keeps_matrices() => {
                let dimension = Literal::usize_unsuffixed(self.dimension());
                quote!(#private::InertiaInverse<#scalar, #dimension>)
            }
            false => self.paths.matrix(self.dimension(), self.dimension()),
        };
        let inverse = (!self.program.formulas.inertia_moves()).then(|| quote!(inertia_inverse: #inverse,));
        let kind = self.kind_of_free_rotation();
        let rotations = self.free_rotations().map(|(name, _)| quote!(#name: #private::#kind<#scalar>,));
        let step_size = self.needs_step_size().then(|| quote!(step_size: #scalar,));
        let (name, (generics, _)) = (&self.names.constants, self.constants_generics());
        let documentation = docs::lines(&["What no step changes: made once per stepper.".to_string()]);
        quote! {
            #documentation
            #[derive(::core::clone::Clone, ::core::fmt::Debug)]
            pub struct #name #generics {
                #(#names: #scalar,)*
                #(#orientations: #private::Orientation,)*
                #(#rotations)*
                #step_size
                #inverse
            }
        }
    }

    /// Whether Σ is kept as the number κ of κI.
    pub(super) fn has_uniform_inertia(&self) -> bool {
        self.program.formulas.uniform_inertia.is_some()
    }

    /// Σ as an expression, or κ of κI.
    pub(super) fn inertia(&self, scope: &code::Scope<'_, '_>) -> TokenStream {
        let kernel = self.program.kernel(Id::Inertia);
        if !self.program.form.keeps_matrices() || self.has_uniform_inertia() {
            let (locals, (shape, entries)) = (code::locals(scope, kernel), &kernel.outputs[0]);
            return match self.has_uniform_inertia() {
                true => {
                    let kappa = scope.code(&entries[0], false);
                    quote!(#locals #kappa)
                }
                false => {
                    let inertia = code::grid(scope, *shape, entries, false);
                    quote!(#locals #inertia)
                }
            };
        }
        let (locals, inertia) = matrices::matrix_of(scope, kernel, 0, "x", |role| matches!(role, Role::Algebra(_)));
        quote!(#locals #inertia)
    }

    /// Whether the size of a step is a constant by itself.
    fn needs_step_size(&self) -> bool {
        let formulas = &self.program.formulas;
        formulas.splitting.is_some() || formulas.collocation.is_some() || self.program.form.keeps_matrices()
    }

    /// Whether the orientation of an equation is a constant, made of Σ.
    pub(super) fn has_orientation(&self, solve: &Solve) -> bool {
        let iterates = matches!(solve.solution, Solution::Newton | Solution::Linear);
        iterates && !self.program.formulas.inertia_moves()
    }

    /// For each equation whose orientation is a constant: the name of its orientation, and the equation.
    pub(super) fn implicit_solves(&self) -> impl Iterator<Item = (proc_macro2::Ident, &Solve)> {
        let solves = self.program.steps.iter().enumerate().flat_map(|(index, step)| {
            let suffix = self.program.suffix(index);
            step.solves.iter().enumerate().map(move |(number, solve)| (suffix, number, solve))
        });
        let implicit = solves.filter(|(_, _, solve)| self.has_orientation(solve));
        implicit.map(|(suffix, number, solve)| (format_ident!("orientation{suffix}_{}", number + 1), solve))
    }

    /// The name of the constants of a free rotation.
    pub(super) fn free_rotation(&self, suffix: &str, number: usize) -> proc_macro2::Ident {
        format_ident!("free_rotation{suffix}_{}", number + 1)
    }

    /// The equations that are solved by the free rotation of a body, with the names of its constants.
    pub(super) fn free_rotations(&self) -> impl Iterator<Item = (proc_macro2::Ident, &Solve)> {
        let steps = self.program.steps.iter().enumerate();
        steps.flat_map(move |(index, step)| {
            let free = step.solves.iter().enumerate().filter(|(_, solve)| solve.solution == Solution::FreeRotation);
            free.map(move |(number, solve)| (self.free_rotation(self.program.suffix(index), number), solve))
        })
    }

    /// The part of `inertia` that belongs to a free rotation.
    pub(super) fn block_of_inertia(&self, solve: &Solve) -> TokenStream {
        let private = &self.paths.private;
        if self.has_uniform_inertia() {
            let dimension = solve.components.len();
            let matrix = self.paths.matrix(dimension, dimension);
            return quote!(<#matrix>::from_diagonal_element(inertia));
        }
        if self.dimension() == solve.components.len() {
            return quote!(inertia);
        }
        let start = Literal::usize_unsuffixed(solve.components[0]);
        quote!(#private::Blocks::block::<3, 3>(&inertia, #start, #start))
    }

    /// Whether the factor of an equation acts from the left.
    pub(super) fn is_left(&self, solve: &Solve) -> bool {
        let block = self.program.formulas.symbols.blocks_of(&solve.components)[0];
        self.model.factors[self.program.formulas.symbols.blocks[block].factor].side == Side::Left
    }

    /// The sign of det Σ/h for some components: of Dρ at the identity for short steps, but for positive factors.
    fn orientation_of_inertia(&self, components: &[usize]) -> TokenStream {
        let private = &self.paths.private;
        let count = components.len();
        if self.has_uniform_inertia() {
            let count = Literal::usize_unsuffixed(count);
            return quote!(#private::orientation_of_uniform(inertia / h, #count)?);
        }
        let first = components.first().copied().unwrap_or(0);
        if components.iter().copied().eq(first..first + count) {
            let part = match count == self.dimension() {
                true => quote!(inertia),
                false => {
                    let [count, first] = [count, first].map(Literal::usize_unsuffixed);
                    quote!(#private::Blocks::block::<#count, #count>(&inertia, #first, #first))
                }
            };
            return quote!(#private::orientation_of_inertia(&#part, h)?);
        }
        let rows = components.iter().map(|&i| {
            let row = components.iter().map(|&j| {
                let (i, j) = (Literal::usize_unsuffixed(i), Literal::usize_unsuffixed(j));
                quote!(inertia[(#i, #j)])
            });
            quote!([#(#row),*])
        });
        quote!(#private::orientation_of_inertia(&#private::matrix([#(#rows),*]), h)?)
    }

    /// The method `constants`.
    pub(super) fn constants(&self) -> TokenStream {
        let (private, scalar) = (&self.paths.private, &self.paths.scalar);
        let scope = self.scope_of_system();
        let (constants, checks) = (&self.names.constants, self.checks());
        let moves = self.program.formulas.inertia_moves();
        let inertia = (!moves).then(|| {
            let inertia = self.inertia(&scope);
            let invert = match (self.has_uniform_inertia(), self.program.form.keeps_matrices()) {
                (true, _) => quote!(invert_uniform),
                (false, true) => quote!(InertiaInverse::new),
                (false, false) => quote!(invert),
            };
            quote! {
                let inertia = { #inertia };
                let inertia_inverse = #private::#invert(&inertia)?;
            }
        });
        let inverse = (!moves).then(|| quote!(inertia_inverse,));
        let locals = code::locals(&scope, self.program.kernel(Id::Constants));
        let fields = self.program.constant_names.iter().zip(&self.program.kernel(Id::Constants).outputs).map(
            |(name, (_, entries))| {
                let (name, value) = (format_ident!("{name}"), scope.code(&entries[0], false));
                quote!(#name: #value,)
            },
        );
        let orientations = self.implicit_solves().map(|(name, solve)| {
            let whole = self.orientation_of_inertia(&[solve.components.as_slice(), &solve.coupled].concat());
            // det Σ is the product of those of what was put in and of what that leaves
            let coupled = (!solve.coupled.is_empty()).then(|| self.orientation_of_inertia(&solve.coupled));
            let coupled = coupled.map(|coupled| quote!(* #coupled));
            quote!(#name: #whole #coupled,)
        });
        let rotations = self.free_rotations().map(|(name, solve)| {
            let inertia = self.block_of_inertia(solve);
            let kind = self.kind_of_free_rotation();
            match &self.model.dials.tolerance {
                Some(tolerance) => {
                    let part = Literal::f64_unsuffixed(tolerance.value);
                    quote!(#name: #private::#kind::to_tolerance(&#inertia, h, #part)?,)
                }
                None => quote!(#name: #private::#kind::new(&#inertia, h)?,),
            }
        });
        let step_size = self.needs_step_size().then(|| quote!(step_size: h,));
        let documentation = docs::formulas(
            "Checks the parameters and computes what no step changes.",
            &[],
            Some(self.program.kernel(Id::Constants)),
        );
        let receiver = self.receiver_parameter();
        let body = quote! {
            #inertia
            #locals
            #private::Ok(#constants {
                #(#fields)*
                #(#orientations)*
                #(#rotations)*
                #step_size
                #inverse
            })
        };
        quote! {
            #documentation
            fn constants(#receiver, h: #scalar) -> #private::Result<Self::Constants, #private::Error> {
                #checks
                #body
            }
        }
    }
}

impl SystemEmitter<'_, '_> {
    /// Checks of every field that a closure reads: finite, and what the user promises.
    pub(super) fn checks(&self) -> TokenStream {
        let (private, system) = (&self.paths.private, self.receiver());
        let checks = self.model.parameters.iter().map(|parameter| {
            let (field, name) = (&parameter.field, &parameter.name);
            let promises = parameter
                .promise
                .into_iter()
                .flat_map(|promise| parameter.leaves.iter().map(move |leaf| (promise, code::accessor(&leaf.accessor))));
            let promises = promises.map(|(promise, access)| match promise {
                Promise::Symmetric => quote!(#private::check_symmetric(#name, &#system.#field #access)?;),
                Promise::Diagonal => quote!(#private::check_diagonal(#name, &#system.#field #access)?;),
                Promise::Unit => quote!(#private::check_unit(#name, &#system.#field #access)?;),
            });
            quote! {
                #private::check_finite(#name, &#system.#field)?;
                #(#promises)*
            }
        });
        quote!(#(#checks)*)
    }
}
