//! The names that an expansion introduces beside the user's: they give way to what the user's item already calls so.

use std::collections::BTreeSet;

use proc_macro2::{Ident, TokenStream, TokenTree};
use quote::{ToTokens, format_ident};
use syn::Lifetime;

use crate::model::{Opaque, Power, ScalarType, System};

/// Names of generated types and of their lifetime.
pub struct Names {
    taken: BTreeSet<String>,
    /// The struct of the constants.
    pub constants: Ident,
    /// The struct of the equation of the velocity of a momentum.
    pub velocity: Ident,
    /// The lifetime of its references.
    pub lifetime: Lifetime,
    /// The runtime's module for generated code.
    pub runtime: Ident,
    /// The scalar, where it is no parameter.
    pub scalar: Ident,
    /// The type of configurations q.
    pub configuration: Ident,
    /// The type of group elements F.
    pub element: Ident,
    /// The type of momenta μ.
    pub momentum: Ident,
}

impl Names {
    /// The names for a model and its methods.
    pub fn new<'a>(
        model: &System<'_>,
        (power, opaque): (Option<&Power<'_>>, Option<&Opaque>),
        methods: impl Iterator<Item = &'a Ident>,
    ) -> Names {
        let mut taken = BTreeSet::new();
        // of a power the user's struct is another item than that of a site
        for item in [&model.item].into_iter().chain(power.map(|power| &power.item)) {
            collect(item.ident.to_token_stream(), &mut taken);
            collect(item.generics.to_token_stream(), &mut taken);
            collect(item.generics.where_clause.to_token_stream(), &mut taken);
        }
        taken.extend(methods.map(Ident::to_string));
        model.constants.iter().for_each(|constant| collect(constant.path.to_token_stream(), &mut taken));
        if let Some(opaque) = opaque {
            collect(opaque.value.to_token_stream(), &mut taken);
            collect(opaque.gradient.to_token_stream(), &mut taken);
        }
        if let ScalarType::Parameter(ident) = &model.item.scalar {
            taken.insert(ident.to_string());
        }
        let lifetime = format!("'{}", free("clebsch", &taken));
        Names {
            constants: free("Constants", &taken),
            velocity: free("Velocity", &taken),
            lifetime: Lifetime::new(&lifetime, proc_macro2::Span::call_site()),
            runtime: free("runtime", &taken),
            scalar: free("T", &taken),
            configuration: free("Q", &taken),
            element: free("F", &taken),
            momentum: free("Mu", &taken),
            taken,
        }
    }

    /// The struct of an equation.
    pub fn equation(&self, suffix: &str, number: usize) -> Ident {
        let suffix = match suffix {
            "_first" => "First",
            "_adjoint" => "Adjoint",
            "_whole" => "Whole",
            _ => "",
        };
        free(&format!("Equation{suffix}{}", number + 1), &self.taken)
    }
}

/// The name, with underscores behind it as long as it is taken.
fn free(name: &str, taken: &BTreeSet<String>) -> Ident {
    let mut name = name.to_string();
    while taken.contains(&name) {
        name.push('_');
    }
    format_ident!("{name}")
}

/// All identifiers of some tokens; those of lifetimes too, without their quote.
fn collect(tokens: TokenStream, taken: &mut BTreeSet<String>) {
    for token in tokens {
        match token {
            TokenTree::Ident(ident) => drop(taken.insert(ident.to_string())),
            TokenTree::Group(group) => collect(group.stream(), taken),
            TokenTree::Punct(_) | TokenTree::Literal(_) => {}
        }
    }
}
