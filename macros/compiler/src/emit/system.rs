//! The implementation of the trait `Clebsch` for the user's struct.

use clebsch_symbolic::Group;
use proc_macro2::TokenStream;
use quote::quote;

use super::{Emitter, Generics, code, docs};
use crate::derive::Formula;
use crate::lower::Kernel;
use crate::model::{Order, Space, Structure};

impl Emitter<'_, '_> {
    /// The impl block.
    pub(super) fn system(&self) -> TokenStream {
        let (krate, scalar) = (&self.paths.krate, &self.paths.scalar);
        let Generics { parameters, arguments, predicates } = &self.generics;
        let (ident, name) = (&self.model.item.ident, self.model.item.ident.to_string());
        let (configuration, element, momentum) = (self.configuration_type(), self.element_type(), self.momentum_type());
        let (impulse, (_, constants_arguments)) = (self.impulse_type(), self.constants_generics());
        let constants_name = &self.names.constants;
        let order: u32 = if self.model.order == Order::First { 1 } else { 2 };
        let derivation = super::derivation(self.program);
        let (constants, formulas, dynamics, checks) =
            (self.constants(), self.formulas(), self.dynamics(), self.space_checks());
        quote! {
            #[automatically_derived]
            impl<#parameters> #krate::Clebsch for #ident<#arguments> #predicates {
                type Scalar = #scalar;
                type Configuration = #configuration;
                type Element = #element;
                type Momentum = #momentum;
                type MomentumMatrix = #element;
                type Impulse = #impulse;
                type Constants = #constants_name #constants_arguments;

                const NAME: &'static ::core::primitive::str = #name;
                const ORDER: ::core::primitive::u32 = #order;
                const DERIVATION: &'static ::core::primitive::str = #derivation;

                #constants
                #formulas
                #dynamics
                #checks
            }
        }
    }

    /// A method that is one kernel.
    fn method(
        &self,
        documentation: (&str, &[Formula]),
        signature: TokenStream,
        kernel: &Kernel,
        structure: Option<&Structure>,
    ) -> TokenStream {
        let documentation = docs::formulas(documentation.0, documentation.1, Some(kernel));
        let body = code::body(&self.scope_of_system(), kernel, structure);
        quote! {
            #documentation
            fn #signature {
                #body
            }
        }
    }

    fn formulas(&self) -> TokenStream {
        let (program, formulas, scalar) = (self.program, &self.program.formulas, &self.paths.scalar);
        let methods = [
            self.method(
                ("The action.", &formulas.titled("action")),
                quote!(act(&self, f: &Self::Element, q: &Self::Configuration) -> Self::Configuration),
                &program.act,
                Some(&self.model.configuration),
            ),
            self.method(
                (
                    "The momentum map of the cotangent lift, ⟨A, E⟩ standing for the components tr(AᵀE_i).",
                    &formulas.titled("momentum map"),
                ),
                quote!(momentum_map(&self, q: &Self::Configuration, p: &Self::Configuration) -> Self::Momentum),
                &program.momentum_map,
                None,
            ),
            self.method(
                ("The coadjoint action.", &formulas.titled("coadjoint action")),
                quote!(coadjoint(&self, f: &Self::Element, mu: &Self::Momentum) -> Self::Momentum),
                &program.coadjoint,
                None,
            ),
            self.method(
                (
                    "The discrete Legendre transform: the momentum N before the step that moves q by F.",
                    &formulas.titled("Legendre transform"),
                ),
                quote!(legendre(&self, h: #scalar, q: &Self::Configuration, f: &Self::Element) -> Self::Momentum),
                &program.legendre,
                None,
            ),
            self.method(
                (
                    "The discrete Legendre transform: the momentum N⁺ after the step that moves q by F.",
                    &formulas.titled("next Legendre transform"),
                ),
                quote!(legendre_next(&self, h: #scalar, q: &Self::Configuration, f: &Self::Element) -> Self::Momentum),
                &program.legendre_next,
                None,
            ),
            self.method(
                ("The representing matrices M = Σ G^{ij} μ_j E_i of a momentum.", &[]),
                quote!(momentum_matrix(mu: &Self::Momentum) -> Self::MomentumMatrix),
                &program.momentum_matrix,
                Some(&self.model.element),
            ),
            self.method(
                ("The components μ_i = tr(MᵀE_i) of a momentum.", &[]),
                quote!(momentum_components(m: &Self::MomentumMatrix) -> Self::Momentum),
                &program.momentum_components,
                None,
            ),
        ];
        let potential = self.potential();
        quote!(#(#methods)* #potential)
    }

    fn potential(&self) -> TokenStream {
        let (scalar, private) = (&self.paths.scalar, &self.paths.private);
        let formulas = &self.program.formulas;
        let scope = self.scope_of_system();
        let locals = code::locals(&scope, &self.program.potential);
        let value = scope.code(&self.program.potential.outputs[0].1[0], false);
        let potential =
            docs::formulas("The potential energy.", &[formulas.formula_of_potential()], Some(&self.program.potential));
        let kinetic = docs::formulas("The kinetic energy.", &[formulas.formula_of_hamiltonian()], None);
        quote! {
            #potential
            fn potential(&self, q: &Self::Configuration) -> #scalar {
                #locals
                #value
            }
            #kinetic
            fn kinetic_energy(&self, constants: &Self::Constants, mu: &Self::Momentum) -> #scalar {
                #private::kinetic_energy(&constants.inertia_inverse, mu)
            }
        }
    }

    /// Steps, handed to the type `Step`.
    fn dynamics(&self) -> TokenStream {
        let (krate, step) = (&self.paths.krate, &self.names.step);
        let impulse = match self.shares_impulse() {
            true => quote!(#step::start_kick(&#step { system: self, constants }, q)),
            false => quote!(()),
        };
        let impulse = match (self.program.formulas.parts(), self.shares_impulse()) {
            (2, true) => quote!(#step::start_kick_first(&#step { system: self, constants }, q)),
            _ => impulse,
        };
        quote! {
            /// The group element that is connected to the identity and has this momentum.
            fn inverse_legendre(
                &self,
                constants: &Self::Constants,
                q: &Self::Configuration,
                mu: &Self::Momentum,
            ) -> ::core::result::Result<Self::Element, #krate::Error> {
                #step::inverse_legendre(&#step { system: self, constants }, q, mu)
            }
            /// The kick that the end of a step and the start of the next share.
            #[inline]
            fn impulse(&self, constants: &Self::Constants, q: &Self::Configuration) -> Self::Impulse {
                #impulse
            }
            /// One step of the discrete Euler–Poincaré representation.
            #[inline]
            fn step(
                &self,
                constants: &Self::Constants,
                q: &Self::Configuration,
                mu: &Self::Momentum,
                impulse: &Self::Impulse,
            ) -> ::core::result::Result<(Self::Configuration, Self::Momentum, Self::Impulse), #krate::Error> {
                #step::euler_poincare(&#step { system: self, constants }, q, mu, impulse)
            }
            /// One step of the discrete symmetric representation.
            fn step_symmetric(
                &self,
                constants: &Self::Constants,
                q: &Self::Configuration,
                p: &Self::Configuration,
            ) -> ::core::result::Result<(Self::Configuration, Self::Configuration), #krate::Error> {
                #step::symmetric(&#step { system: self, constants }, q, p)
            }
        }
    }

    /// `orbit_defect` and `isotropy_defect`.
    fn space_checks(&self) -> TokenStream {
        let (private, scalar) = (&self.paths.private, &self.paths.scalar);
        let defects = self.model.configurations.iter().filter_map(|leaf| {
            let access = code::accessor(&leaf.accessor);
            match leaf.space {
                Space::Group(Group::SpecialOrthogonal(_)) => Some(quote!(#private::orthogonality_defect(&q #access))),
                Space::Unit => Some(quote!(#private::length_defect(&q #access))),
                Space::Vectors | Space::Group(Group::Translation(_)) => None,
            }
        });
        let defects: Vec<_> = defects.collect();
        let isotropy = match &self.program.generator {
            None => quote!(<#scalar as #private::Zero>::zero()),
            Some(kernel) => {
                let scope = self.scope_of_system();
                let (locals, (shape, entries)) = (code::locals(&scope, kernel), &kernel.outputs[0]);
                let entries: Vec<_> = entries.iter().map(|entry| scope.code(entry, false)).collect();
                let rows = entries.chunks(shape.columns).map(|row| quote!([#(#row),*]));
                quote! {
                    #locals
                    #private::annihilator_defect(&[#(#rows),*], mu)
                }
            }
        };
        quote! {
            /// By how much q violates what the declaration promises.
            fn orbit_defect(q: &Self::Configuration) -> #scalar {
                #private::largest([#(#defects),*])
            }
            /// The size of the component of μ that no motion of q can have.
            fn isotropy_defect(q: &Self::Configuration, mu: &Self::Momentum) -> #scalar {
                #isotropy
            }
        }
    }
}
