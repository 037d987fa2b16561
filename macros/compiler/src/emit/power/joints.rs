//! Joints between neighbouring sites: the values and the rows of the equations whose later site is a given one.

use proc_macro2::TokenStream;
use quote::quote;

use super::terms::{Terms, site};
use crate::derive::{Id, JointRows};
use crate::emit::Emitter;
use crate::emit::block::Target;
use crate::emit::function::{self, Body, no_words};
use crate::emit::functions::{JOINED, LOOPS, MOBILE};
use crate::emit::scope::size;
use crate::model::{Joint, Power};

impl<'g> Emitter<'_, 'g> {
    /// The implementations of `Mobile` for a site and of `Joined` and `Constrained` for all of them, where there are joints.
    pub(super) fn joined(&self, power: &Power<'g>, target: &Target) -> TokenStream {
        let Some(joints) = &power.joints else { return TokenStream::new() };
        let (length, dimension, most) = (&self.length, size(self.dimension), size(joints.rows));
        let constants = Some(quote!(c));
        let of_site = self.functions(MOBILE, (0, 0), &no_words, |function, kernel| {
            let scope = if ["mobility", "acceleration"].contains(&function.name) {
                self.scope(self.receiver(), constants.clone())
            } else {
                self.scope_of_system()
            };
            let words = |word: &str| {
                let parts = || {
                    let (system, parts) = (self.target.of_type(), self.trait_of_parts("Parts", &[]));
                    quote!(<#system as #parts>)
                };
                (word == "PartsOf").then(parts)
            };
            function.written(&scope, kernel, &words)
        });
        let mobile = self.target.derived(Some(quote!(runtime::Mobile<#dimension>)), of_site);
        let is_ring = joints.is_ring;
        let terms = Terms::new(self, power);
        let loops = size(joints.loops);
        let branch = match joints.loops {
            0 if joints.is_tree => quote!(runtime::Limb<T, #most, #dimension>),
            0 => quote!(()),
            _ => quote!(runtime::LoopedLimb<T, #most, #dimension, #loops>),
        };
        let formulas = self.formulas.joints.iter().flat_map(|joints| &joints.all);
        let all = joints.all.iter().zip(formulas).enumerate();
        let (closing, numbered): (Vec<_>, Vec<_>) = all.partition(|(_, (joint, _))| joint.is_loop);
        let parent = joints.is_tree.then(|| {
            let of_joint = |(_, (joint, rows)): &(usize, (&Joint<'g>, &JointRows<'g>))| terms.parent((joint, rows));
            let statements: TokenStream = numbered.iter().map(of_joint).collect();
            let title = function::documentation("The earlier site that the joints of a site read.", &[], None);
            quote! {
                #title
                fn parent(site: ::core::primitive::usize) -> runtime::Option<::core::primitive::usize> {
                    #statements
                    runtime::None
                }
            }
        });
        let places = || -> TokenStream {
            let statement = |&(number, (joint, rows)): &(usize, (&Joint<'g>, &JointRows<'g>))| {
                let kernel = self.program.kernel(Id::JointPlaces(number));
                let (first, values) = (size(joint.first), terms.entries(kernel, 0));
                terms.of_joint((joint, rows), kernel, quote!(runtime::put_places(&mut places, #first, [#(#values),*]);))
            };
            numbered.iter().map(statement).collect()
        };
        let bend = || -> TokenStream {
            let statement = |&(number, (joint, rows)): &(usize, (&Joint<'g>, &JointRows<'g>))| {
                let kernel = self.program.kernel(Id::JointBend(number));
                let (first, values) = (size(joint.first), terms.entries(kernel, 0));
                terms.of_joint((joint, rows), kernel, quote!(runtime::put_places(&mut places, #first, [#(#values),*]);))
            };
            numbered.iter().map(statement).collect()
        };
        let rows = || -> TokenStream {
            let statement = |&(number, (joint, rows)): &(usize, (&Joint<'g>, &JointRows<'g>))| {
                let kernel = self.program.kernel(Id::Joint(number));
                let nested = |output: usize| {
                    let entries = terms.entries(kernel, output);
                    let rows = entries.chunks(self.dimension).map(|row| quote!([#(#row),*]));
                    quote!([#(#rows),*])
                };
                let (first, own, before, velocity) =
                    (size(joint.first), nested(0), nested(1), terms.entries(kernel, 2));
                terms.of_joint((joint, rows), kernel, quote!(rows.put(#first, #own, #before, [#(#velocity),*]);))
            };
            numbered.iter().map(statement).collect()
        };
        let words = |word: &str| match word {
            "Sites" => Some(quote!([Q; #length])),
            "Index" => Some(quote!(::core::primitive::usize)),
            "Places" => Some(quote!(runtime::SVector<T, #most>)),
            "Rows" => Some(quote!(runtime::JointRows<T, #most, #dimension>)),
            _ => None,
        };
        let functions = self.functions(JOINED, (0, 0), &words, |function, _| {
            let of_places =
                |statements: TokenStream| quote!(let mut places = runtime::Space::<T>::origin(); #statements places);
            Some(Body::from(match function.name {
                "places_at" => {
                    let code = of_places(places());
                    quote!(let _ = (t, q, site); #code)
                }
                "bend_at" => {
                    let code = of_places(bend());
                    quote!(let _ = (t, q, site, x, mu); #code)
                }
                _ => {
                    let statements = rows();
                    quote!(let _ = (t, q, site); let mut rows = runtime::JointRows::none(); #statements rows)
                }
            }))
        });
        let of_loops = (joints.loops > 0).then(|| self.loops(&terms, &closing, length));
        let joined = target.derived(
            Some(quote!(runtime::Joined<#length, #most, #dimension>)),
            quote! {
                const IS_RING: ::core::primitive::bool = #is_ring;
                type Branch = #branch;
                #parent
                #functions
                #of_loops
            },
        );
        let reactions = quote!([runtime::SVector<T, #most>; #length]);
        let trait_of_joints = quote!(runtime::Joined::<#length, #most, #dimension>);
        let (reactions, multipliers, of_motion) = if joints.loops == 0 {
            let multipliers = quote!(#trait_of_joints::multipliers_of_joints(self, c, t, q, mu));
            (reactions, multipliers, quote!(#trait_of_joints::reactions_of_joints(self, c, t, q, mu, u)))
        } else {
            (
                quote!((#reactions, runtime::SVector<T, #loops>)),
                quote! {
                    let (joints, loops) = #trait_of_joints::multipliers_with_loops(self, c, t, q, mu);
                    (joints, loops.values())
                },
                quote! {
                    let (joints, loops) = #trait_of_joints::reactions_with_loops(self, c, t, q, mu, u)?;
                    runtime::Ok((joints, loops.values()))
                },
            )
        };
        let constrained = target.derived(
            Some(quote!(runtime::Constrained)),
            quote! {
                type Reactions = #reactions;

                fn momentum_of_velocity(
                    &self,
                    t: T,
                    q: &Self::Configuration,
                    x: &Self::Momentum,
                ) -> Self::Momentum {
                    runtime::Power::each(self, |site, i| runtime::Mobile::momentum_of_velocity(site, t, &q[i], &x[i]))
                }
            },
        );
        let reacting = target.derived(
            Some(quote!(runtime::Reacting)),
            quote! {
                fn multipliers(
                    &self,
                    c: &Self::Constants,
                    t: T,
                    q: &Self::Configuration,
                    mu: &Self::Momentum,
                ) -> Self::Reactions {
                    #multipliers
                }
                fn reactions_of_motion(
                    &self,
                    c: &Self::Constants,
                    t: T,
                    q: &Self::Configuration,
                    mu: &Self::Momentum,
                    u: &Self::Input,
                ) -> ::core::result::Result<Self::Reactions, runtime::Error> {
                    #of_motion
                }
            },
        );
        quote!(#mobile #joined #constrained #reacting)
    }
    /// The functions of joints that close loops.
    fn loops(
        &self,
        terms: &Terms<'_, '_, 'g>,
        closing: &[(usize, (&Joint<'g>, &JointRows<'g>))],
        length: &Option<TokenStream>,
    ) -> TokenStream {
        let dimension = size(self.dimension);
        let words = |word: &str| match word {
            "Sites" => Some(quote!([Q; #length])),
            "Velocities" => Some(quote!([Mu; #length])),
            "LoopRows" => Some(quote!([runtime::Loop<T, #dimension>])),
            _ => None,
        };
        let statement = |name: &str, number: usize, joint: &Joint<'g>| {
            let id = match name {
                "loop_rows" => Id::Joint(number),
                "loop_places" => Id::JointPlaces(number),
                _ => Id::JointBend(number),
            };
            let kernel = self.program.kernel(id);
            let entries = |output: usize| terms.entries(kernel, output);
            // by construction: a joint that closes a loop reads two sites
            let [own, before] = [site(joint.own), site(joint.before.unwrap_or(joint.own))];
            let put = if name == "loop_rows" {
                let nested = |output: usize| {
                    let entries = entries(output);
                    let rows = entries.chunks(self.dimension).map(|row| quote!([#(#row),*]));
                    quote!([#(#rows),*])
                };
                let (rows, velocity) = ([nested(0), nested(1)], entries(2));
                quote!(runtime::put_loops(loops, row, [#own, #before], [#(#rows),*], [#(#velocity),*]);)
            } else {
                let values = entries(0);
                quote!(runtime::put_loop_values(loops, row, [#(#values),*]);)
            };
            let velocities = |leave: &TokenStream| {
                let given = || quote!(let (runtime::Some(x), runtime::Some(mu)) = (velocities.get(#own), velocities.get(#before)) else { #leave };);
                (name == "loop_bends").then(given)
            };
            terms.of_loop(joint, kernel, (velocities, put))
        };
        self.functions(LOOPS, (0, 0), &words, |function, _| {
            let statements = closing.iter().map(|&(number, (joint, _))| statement(function.name, number, joint));
            let statements: TokenStream = statements.collect();
            let velocities = (function.name == "loop_bends").then(|| quote!(, velocities));
            Some(Body::from(quote!(let _ = (t, q #velocities); #statements)))
        })
    }
}
