//! Powers: the site as a system of its own, and the implementation for all of them, a loop over sites for each method.

mod joints;
mod terms;

use clebsch_symbolic::{Group, Property};
use proc_macro2::TokenStream;
use quote::quote;

use super::block::{self, Target, time_type, types_of_system};
use super::function::Body;
use super::functions::SITES;
use super::scheme::composed;
use super::scope::{nested_type, size};
use super::{Emitter, flag};
use crate::model::{LeafSpace, Order, Parameter, Power};
use terms::Terms;

impl<'g> Emitter<'_, 'g> {
    /// The struct of a site and the implementation for all sites, where the declaration is a power.
    pub(super) fn power(&self) -> TokenStream {
        let Some(power) = self.power else { return TokenStream::new() };
        let target = self.declared();
        let (site, sites, whole) = (self.site(), self.sites(power, &target), self.whole_power(power, &target));
        let (conserves, joined) = (self.conserves(), self.joined(power, &target));
        quote!(#site #sites #whole #joined #conserves)
    }

    /// The struct of a site: the fields that it reads.
    fn site(&self) -> TokenStream {
        let Target { ident, parameters, predicates, .. } = &self.target;
        let fields = self.model.parameters.iter().map(|parameter| {
            let (field, ty) = (&parameter.field, self.type_of(parameter));
            let field = self.names.of_user(quote!(#field));
            quote!(#field: #ty,)
        });
        let marker = self.is_generic().then(|| quote!(scalar: ::core::marker::PhantomData<T>,));
        quote! {
            /// One site, as it moves while the other sites do not act on it.
            #[derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug)]
            pub struct #ident #parameters #predicates { #(#fields)* #marker }
        }
    }

    /// The type of a field, or of its entry for one site.
    fn type_of(&self, parameter: &Parameter<'g>) -> TokenStream {
        nested_type(&parameter.structure, |leaf| {
            // the nesting of a field counts its leaves from 0
            let leaf = &parameter.leaves[leaf];
            if leaf.is_scalar { quote!(T) } else { block::leaf(leaf.shape, false) }
        })
    }

    /// The items that tie sites together.
    fn sites(&self, power: &Power<'g>, target: &Target) -> TokenStream {
        let (length, site, site_type) = (&self.length, &self.target.ident, self.target.of_type());
        let fields = self.model.parameters.iter().zip(&power.copied).map(|(parameter, field)| {
            let (name, index) = (&parameter.field, parameter.per_site.then(|| quote!([i])));
            let name = self.names.of_user(quote!(#name));
            quote!(#name: self.#field #index,)
        });
        let marker = self.is_generic().then(|| quote!(scalar: ::core::marker::PhantomData,));
        let of_site = if power.has_own_inputs { quote!(&u[i]) } else { quote!(u) };
        let terms = Terms::new(self, power);
        let is_bounded = self.model.configurations.iter().all(|leaf| match leaf.space {
            LeafSpace::Unit | LeafSpace::Projector(_) | LeafSpace::Orthonormal => true,
            LeafSpace::Group(group) => Group::element_property(group) == Property::Orthogonal,
            LeafSpace::Vectors | LeafSpace::Symmetric => false,
        });
        let flags = [
            flag("IS_UNIFORM", power.is_uniform),
            flag("GATHERS", self.program.gathered.is_some()),
            flag("IS_BOUNDED", is_bounded),
        ];
        let least = usize::try_from(power.least).ok().filter(|least| *least > 1).map(|least| {
            let least = size(least);
            quote!(const LEAST_SITES: ::core::primitive::usize = #least;)
        });
        let gradient = match &self.program.gathered {
            Some(stencil) => terms.gathered_gradient(stencil),
            None => terms.added_gradient(),
        };
        let potential =
            self.functions(SITES, (0, 0), &|word| (word == "Sites").then(|| quote!([Q; #length])), |_, _| {
                let terms = terms.potential();
                let code = quote! {
                    let _ = (t, q);
                    let mut sum = <T as runtime::Zero>::zero();
                    #terms
                    sum
                };
                Some(Body::from(code))
            });
        target.derived(
            Some(quote!(runtime::Power<#length>)),
            quote! {
                type Site = #site_type;

                #(#flags)*
                #least

                /// The site with this index, which is below the number of sites.
                #[inline]
                fn site(&self, i: ::core::primitive::usize) -> Self::Site {
                    let _ = i;
                    #site { #(#fields)* #marker }
                }
                #[inline]
                fn input_of_site(u: &Self::Input, i: ::core::primitive::usize) -> &<Self::Site as runtime::Clebsch>::Input {
                    let _ = i;
                    #of_site
                }
                #[inline]
                fn constants_of_sites(constants: &<Self as runtime::Clebsch>::Constants) -> &<Self as runtime::Clebsch>::Constants {
                    constants
                }
                #potential
                #gradient
            },
        )
    }

    /// The implementation of the trait `Clebsch` for all sites together.
    fn whole_power(&self, power: &Power<'g>, target: &Target) -> TokenStream {
        let (names, length, order) = (self.names_of(&target.name), &self.length, power.order.number());
        let places = [quote!([Q; #length]), quote!([F; #length]), quote!([Mu; #length])];
        let input = &self.input;
        let input = if power.has_own_inputs { quote!([#input; #length]) } else { input.clone() };
        let types = types_of_system(&places, &input, &time_type(self.formulas.is_timed()));
        let (derivation, checks) = (self.program.derivation(), self.checks_of_terms(power));
        let (scheme, start, end) = match (power.terms.is_empty(), self.model.order) {
            (true, _) => (quote!(FreeSites), quote!(0.0), quote!(0.0)),
            (false, Order::Second) => (quote!(SitesOfSecondOrder), quote!(-0.5), quote!(-0.5)),
            (false, _) => (quote!(SitesOfFirstOrder), quote!(0.0), quote!(-1.0)),
        };
        let (scheme, of_joints) = match &power.joints {
            None => (quote!(runtime::#scheme<#length>), TokenStream::new()),
            Some(joints) => {
                let (rows, dimension) = (size(joints.rows), size(self.dimension));
                let scheme =
                    if power.terms.is_empty() { quote!(FreeJoinedSites) } else { quote!(JoinedSitesOfSecondOrder) };
                let scheme = quote!(runtime::#scheme<#length, #rows, #dimension>);
                (scheme, quote!(runtime::formulas_of_joints!(T, #length, #rows, #dimension);))
            }
        };
        let scheme = composed(self.formulas.stages_of_sites(), scheme);
        target.derived(
            Some(quote!(runtime::Clebsch)),
            quote! {
                #types
                type Constants = runtime::SiteConstants<Self, #length>;
                type Scheme = #scheme;

                #names
                const ORDER: ::core::primitive::u32 = #order;
                const DERIVATION: &'static ::core::primitive::str = #derivation;

                /// Checks the parameters and computes the constants.
                fn constants(&self, h: T) -> ::core::result::Result<Self::Constants, runtime::Error> {
                    #checks
                    runtime::Power::power_constants(self, h)
                }
                runtime::formulas_of_sites!(T, #length, #start, #end);
                #of_joints
            },
        )
    }

    /// Checks of the fields that terms read.
    fn checks_of_terms(&self, power: &Power<'g>) -> TokenStream {
        let mut checked: Vec<&str> = Vec::new();
        let mut checks = TokenStream::new();
        // sites check their copies of fields, but not fields that differ from site to site
        let of_sites = self.model.parameters.iter().zip(&power.copied).filter(|(parameter, _)| parameter.per_site);
        let of_terms = power.parameters.iter().map(|parameter| (parameter, &parameter.field));
        for (parameter, field) in of_terms.chain(of_sites) {
            let name = parameter.name.as_str();
            if checked.contains(&name) {
                continue;
            }
            checked.push(name);
            checks.extend(quote!(runtime::check_finite(#name, &self.#field)?;));
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
