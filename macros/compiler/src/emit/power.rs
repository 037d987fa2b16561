//! Powers: the site as a system of its own, and the implementation for all of them, a loop over sites for each method.

mod terms;

use clebsch_symbolic::{Group, Property};
use proc_macro2::TokenStream;
use quote::quote;

use super::function::Body;
use super::functions::SITES;
use super::scope::nested_type;
use super::system::types_of_system;
use super::types::Target;
use super::{Emitter, docs, flag};
use crate::model::{LeafSpace, Order, Parameter, Power};
use terms::Terms;

impl<'g> Emitter<'_, 'g> {
    /// The struct of a site and the implementation for all sites, where the declaration is a power.
    pub(super) fn power(&self) -> TokenStream {
        let Some(power) = self.power else { return TokenStream::new() };
        let target = self.declared(&self.paths.private);
        let (site, sites, whole) = (self.site(), self.sites(power, &target), self.whole_power(power, &target));
        let conserves = self.conserves();
        quote!(#site #sites #whole #conserves)
    }

    /// The struct of a site: the fields that it reads.
    fn site(&self) -> TokenStream {
        let (ident, (parameters, _, predicates)) = (&self.target.ident, self.target.generics.split_for_impl());
        let fields = self.model.parameters.iter().map(|parameter| {
            let (field, ty) = (&parameter.field, self.type_of(parameter));
            quote!(#field: #ty,)
        });
        let parameter = self.scalar_parameter();
        let scalar = parameter.map(|parameter| quote!(scalar: ::core::marker::PhantomData #parameter,));
        let documentation = docs::lines("One site: what moves it while the others do nothing to it.");
        quote! {
            #documentation
            #[derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug)]
            pub struct #ident #parameters #predicates { #(#fields)* #scalar }
        }
    }

    /// The type of a field, or of its entry for one site.
    fn type_of(&self, parameter: &Parameter<'g>) -> TokenStream {
        nested_type(&parameter.structure, |leaf| {
            // the nesting of a field counts its leaves from 0
            let leaf = &parameter.leaves[leaf];
            if leaf.is_scalar { self.paths.scalar.clone() } else { self.paths.leaf(leaf.shape, false) }
        })
    }

    /// What ties sites together.
    fn sites(&self, power: &Power<'g>, target: &Target) -> TokenStream {
        let (krate, private, scalar) = (&self.paths.krate, &self.paths.private, &self.paths.scalar);
        let (length, site, site_type) = (&power.length, &self.target.ident, self.target.of_type());
        let fields = self.model.parameters.iter().zip(&power.copied).map(|(parameter, field)| {
            let (name, index) = (&parameter.field, parameter.per_site.then(|| quote!([i])));
            quote!(#name: self.#field #index,)
        });
        let marker = self.model.item.scalar.is_parameter().then(|| quote!(scalar: ::core::marker::PhantomData,));
        let (point, terms) = (self.alias("Q"), Terms::new(self, power));
        let is_bounded = self.model.configurations.iter().all(|leaf| match leaf.space {
            LeafSpace::Unit => true,
            LeafSpace::Group(group) => Group::element_property(group) == Property::Orthogonal,
            LeafSpace::Vectors => false,
        });
        let flags = [
            flag("IS_UNIFORM", power.is_uniform),
            flag("GATHERS", self.program.gathered.is_some()),
            flag("IS_BOUNDED", is_bounded),
        ];
        let gradient = match &self.program.gathered {
            Some(stencil) => terms.gathered_gradient(stencil, &point),
            None => terms.added_gradient(&point),
        };
        let potential = self.functions(SITES, (0, 0), &[("Sites", quote!([#point; #length]))], |_, _| {
            let terms = terms.potential();
            let code = quote! {
                let _ = (t, q);
                let mut sum = <#scalar as #private::Zero>::zero();
                #terms
                sum
            };
            Some(Body::from(code))
        });
        target.derived(
            Some(quote!(#private::Power<#length>)),
            quote! {
                type Site = #site_type;

                #(#flags)*

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
                #potential
                #gradient
            },
        )
    }

    /// The implementation of the trait `Clebsch` for all sites together.
    fn whole_power(&self, power: &Power<'g>, target: &Target) -> TokenStream {
        let (krate, private, scalar) = (&self.paths.krate, &self.paths.private, &self.paths.scalar);
        let (name, length, order) = (target.ident.to_string(), &power.length, self.model.order.number());
        let places = ["Q", "F", "Mu"].map(|name| {
            let of_site = self.alias(name);
            quote!([#of_site; #length])
        });
        let types = types_of_system(scalar, &places, &quote!(()), &self.time_type());
        let (derivation, checks) = (self.program.derivation(), self.checks_of_terms(power));
        let (scheme, start, end) = match (power.terms.is_empty(), self.model.order) {
            (true, _) => (quote!(FreeSites), quote!(0.0), quote!(0.0)),
            (false, Order::Second) => (quote!(SitesOfSecondOrder), quote!(-0.5), quote!(-0.5)),
            (false, _) => (quote!(SitesOfFirstOrder), quote!(0.0), quote!(-1.0)),
        };
        target.derived(
            Some(quote!(#krate::Clebsch)),
            quote! {
                #types
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
            },
        )
    }

    /// Checks of the fields that terms read.
    fn checks_of_terms(&self, power: &Power<'g>) -> TokenStream {
        let private = &self.paths.private;
        let mut checked: Vec<&str> = Vec::new();
        let mut checks = TokenStream::new();
        // sites check what they have copies of, but for what differs from site to site
        let of_sites = self.model.parameters.iter().zip(&power.copied).filter(|(parameter, _)| parameter.per_site);
        let of_terms = power.parameters.iter().map(|parameter| (parameter, &parameter.field));
        for (parameter, field) in of_terms.chain(of_sites) {
            let name = parameter.name.as_str();
            if checked.contains(&name) {
                continue;
            }
            checked.push(name);
            checks.extend(quote!(#private::check_finite(#name, &self.#field)?;));
            let Some(promise) = parameter.promise else { continue };
            let leaves = parameter.leaves.iter().map(|leaf| {
                // the place of an entry is every site here
                let access = leaf.accessor.inside_site();
                self.check_of(promise, name, &quote!(entry #access))
            });
            let entries =
                if parameter.per_site { quote!(&self.#field) } else { quote!(::core::slice::from_ref(&self.#field)) };
            checks.extend(quote!(for entry in #entries { #(#leaves)* }));
        }
        checks
    }
}
