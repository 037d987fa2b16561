//! Powers: the site as a system of its own, and the implementation for all of them, a loop over sites for each method.

mod terms;

use clebsch_symbolic::{Group, Property};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::code::{accessor, locals, nested_type};
use super::{Emitter, Generics, docs};
use crate::derive::Id;
use crate::model::{LeafSpace, Order, Parameter, Power, Promise};

impl<'g> Emitter<'_, 'g> {
    /// The struct of a site and the implementation for all sites, where the declaration is a power.
    pub(super) fn power(&self) -> TokenStream {
        let Some(power) = &self.model.power else { return TokenStream::new() };
        let generics = Generics::of(&power.item, &self.paths);
        let (site, sites, whole) = (self.site(), self.sites(power, &generics), self.whole_power(power, &generics));
        let conserves = self.conserves_of_power(power, &generics);
        quote!(#site #sites #whole #conserves)
    }

    /// The struct of a site: the fields that it reads.
    fn site(&self) -> TokenStream {
        let Generics { parameters, predicates, .. } = &self.generics;
        let ident = &self.model.item.ident;
        let fields = self.model.parameters.iter().map(|parameter| {
            let (field, ty) = (&parameter.field, self.type_of(parameter));
            quote!(#field: #ty,)
        });
        let scalar = matches!(self.model.item.scalar, crate::model::ScalarType::Parameter(_)).then(|| {
            let scalar = &self.paths.scalar;
            quote!(scalar: ::core::marker::PhantomData<#scalar>,)
        });
        let documentation = docs::lines(&["One site: what moves it while the others do nothing to it.".to_string()]);
        quote! {
            #documentation
            #[derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug)]
            pub struct #ident<#parameters> #predicates { #(#fields)* #scalar }
        }
    }

    /// The type of a field, or of its entry for one site.
    fn type_of(&self, parameter: &Parameter<'g>) -> TokenStream {
        let scalar = &self.paths.scalar;
        nested_type(&parameter.structure, &|leaf| {
            // the nesting of a field counts its leaves from 0
            let leaf = &parameter.leaves[leaf];
            if leaf.is_scalar { quote!(#scalar) } else { self.paths.leaf(leaf.shape, false) }
        })
    }

    /// What ties sites together.
    fn sites(&self, power: &Power<'g>, generics: &Generics) -> TokenStream {
        let (krate, private, scalar) = (&self.paths.krate, &self.paths.private, &self.paths.scalar);
        let Generics { parameters, arguments, predicates } = generics;
        let (ident, length, site) = (&power.item.ident, &power.length, &self.model.item.ident);
        let site_type = self.item_type();
        let fields = self.model.parameters.iter().zip(&power.copied).map(|(parameter, field)| {
            let (name, index) = (&parameter.field, parameter.per_site.then(|| quote!([i])));
            quote!(#name: self.#field #index,)
        });
        let marker = matches!(self.model.item.scalar, crate::model::ScalarType::Parameter(_))
            .then(|| quote!(scalar: ::core::marker::PhantomData,));
        let is_uniform = power.is_uniform;
        let point = self.configuration_type();
        let potential = self.potential_of_power(power);
        let gathers = self.program.gathered.is_some();
        let is_orthogonal = |group: Group| group.element_property() == Property::Orthogonal;
        let is_bounded = self.model.configurations.iter().all(|leaf| match leaf.space {
            LeafSpace::Unit => true,
            LeafSpace::Group(group) => is_orthogonal(group),
            LeafSpace::Vectors => false,
        });
        let gradient = match &self.program.gathered {
            Some(stencil) => self.gathered_gradient(power, stencil, &point),
            None => self.added_gradient(power, &point),
        };
        let formulas = self.program.formulas.table().titled_all(|id| matches!(id, Id::Term(_)));
        let of_potential = docs::formulas("The potential energy, a sum over sites.", formulas, None);
        quote! {
            #[automatically_derived]
            impl<#parameters> #private::Power<#length> for #ident<#arguments> #predicates {
                type Site = #site_type;

                const IS_UNIFORM: ::core::primitive::bool = #is_uniform;
                const GATHERS: ::core::primitive::bool = #gathers;
                const IS_BOUNDED: ::core::primitive::bool = #is_bounded;

                /// The site with this index, which is below the number of sites.
                #[inline]
                fn site(&self, i: ::core::primitive::usize) -> Self::Site {
                    let _ = i;
                    #site { #(#fields)* #marker }
                }
                #[inline]
                fn constants_of_sites(constants: &<Self as #krate::Clebsch>::Constants) -> &<Self as #krate::Clebsch>::Constants {
                    constants
                }
                #of_potential
                fn potential_of_sites(&self, t: #scalar, q: &[#point; #length]) -> #scalar {
                    let _ = (t, q);
                    let mut sum = <#scalar as #private::Zero>::zero();
                    #potential
                    sum
                }
                #gradient
            }
        }
    }

    /// The implementation of the trait `Clebsch` for all sites together.
    fn whole_power(&self, power: &Power<'g>, generics: &Generics) -> TokenStream {
        let (krate, private, scalar) = (&self.paths.krate, &self.paths.private, &self.paths.scalar);
        let Generics { parameters, arguments, predicates } = generics;
        let (ident, name, length) = (&power.item.ident, power.item.ident.to_string(), &power.length);
        let (point, element, momentum) = (self.configuration_type(), self.element_type(), self.momentum_type());
        let is_second = self.model.order == Order::Second && !power.terms.is_empty();
        let is_timed = self.is_timed();
        let time = if is_timed { quote!(#private::Clock<#scalar>) } else { quote!(()) };
        let order = self.model.order.number();
        let derivation = self.program.derivation();
        let checks = self.checks_of_terms(power);
        let scheme = match (power.terms.is_empty(), is_second) {
            (true, _) => quote!(FreeSites),
            (false, true) => quote!(SitesOfSecondOrder),
            (false, false) => quote!(SitesOfFirstOrder),
        };
        let (start, end) = match (power.terms.is_empty(), is_second) {
            (true, _) => (quote!(0.0), quote!(0.0)),
            (false, true) => (quote!(-0.5), quote!(-0.5)),
            (false, false) => (quote!(0.0), quote!(-1.0)),
        };
        quote! {
            #[automatically_derived]
            impl<#parameters> #krate::Clebsch for #ident<#arguments> #predicates {
                type Scalar = #scalar;
                type Configuration = [#point; #length];
                type Element = [#element; #length];
                type Momentum = [#momentum; #length];
                type MomentumMatrix = [#element; #length];
                type Input = ();
                type Time = #time;
                type Constants = #private::SiteConstants<Self, #length>;
                type Scheme = #private::#scheme<#length>;

                const NAME: &'static ::core::primitive::str = #name;
                const ORDER: ::core::primitive::u32 = #order;
                const DERIVATION: &'static ::core::primitive::str = #derivation;

                /// Checks the parameters and computes what no step changes.
                fn constants(&self, h: #scalar) -> ::core::result::Result<Self::Constants, #krate::Error> {
                    #checks
                    #private::Power::power_constants(self, h)
                }
                #private::formulas_of_sites!(#scalar, #length, #start, #end);
            }
        }
    }

    /// The implementation of `Conserves` for all sites: sums of what each has, along motions that move all of them alike.
    fn conserves_of_power(&self, power: &Power<'g>, generics: &Generics) -> TokenStream {
        let Some(kernel) = self.program.find(Id::ConservedMomenta) else { return TokenStream::new() };
        let (krate, private, scalar) = (&self.paths.krate, &self.paths.private, &self.paths.scalar);
        let Generics { parameters, arguments, predicates } = generics;
        let ident = &power.item.ident;
        let names = self.program.formulas.symmetries.conserved.iter().map(|momentum| momentum.name.as_str());
        let count = Literal::usize_unsuffixed(self.program.formulas.symmetries.conserved.len());
        let scope = self.scope_of_system();
        let (locals, entries) = (locals(&scope, kernel), &kernel.outputs[0].1);
        let added = entries.iter().enumerate().map(|(k, entry)| {
            let (k, value) = (Literal::usize_unsuffixed(k), scope.code(entry, false));
            quote!(sum[#k] += #value;)
        });
        let formulas = self.program.formulas.table().titled_all(|id| matches!(id, Id::Conserved(_)));
        let documentation = docs::formulas("The momenta that no step changes, sums over all sites.", formulas, None);
        quote! {
            #[automatically_derived]
            impl<#parameters> #krate::Conserves for #ident<#arguments> #predicates {
                type Conserved = #private::Conserved<#scalar, #count>;

                #documentation
                fn conserved(&self, q: &Self::Configuration, mu: &Self::Momentum) -> Self::Conserved {
                    let mut sum = [<#scalar as #private::Zero>::zero(); #count];
                    for (q, mu) in ::core::iter::zip(q, mu) {
                        #locals
                        #(#added)*
                    }
                    #private::Conserved::new([#(#names),*], sum)
                }
            }
        }
    }

    /// Checks of the fields that terms read.
    fn checks_of_terms(&self, power: &Power<'g>) -> TokenStream {
        let private = &self.paths.private;
        let mut checked: Vec<&str> = Vec::new();
        let mut checks = Vec::new();
        // sites check what they have copies of, but for what differs from site to site
        let of_sites = self.model.parameters.iter().zip(&power.copied).filter(|(parameter, _)| parameter.per_site);
        let of_terms = power.parameters.iter().map(|parameter| (parameter, &parameter.field));
        for (parameter, field) in of_terms.chain(of_sites) {
            if checked.contains(&parameter.name.as_str()) {
                continue;
            }
            checked.push(&parameter.name);
            let name = &parameter.name;
            checks.push(quote!(#private::check_finite(#name, &self.#field)?;));
            let Some(promise) = parameter.promise else { continue };
            let leaves = parameter.leaves.iter().map(|leaf| {
                // the place of an entry is every site here
                let access = accessor(&leaf.accessor.inside_site());
                match promise {
                    Promise::Symmetric => quote!(#private::check_symmetric(#name, &entry #access)?;),
                    Promise::Diagonal => quote!(#private::check_diagonal(#name, &entry #access)?;),
                    Promise::Unit => quote!(#private::check_unit(#name, &entry #access)?;),
                }
            });
            let entries =
                if parameter.per_site { quote!(&self.#field) } else { quote!(::core::slice::from_ref(&self.#field)) };
            checks.push(quote!(for entry in #entries { #(#leaves)* }));
        }
        quote!(#(#checks)*)
    }
}
