//! Steps of higher order: those of second order, composed.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::{Emitter, code, docs};

impl Emitter<'_, '_> {
    /// The type of the constants of a stepper: those of one step, or of all that a step is composed of.
    pub(super) fn constants_of_steps(&self) -> TokenStream {
        let (private, scalar, name) = (&self.paths.private, &self.paths.scalar, &self.names.constants);
        let (_, arguments) = self.constants_generics();
        match self.distinct_stages() {
            Some(distinct) => quote!(#private::Composed<#scalar, #name #arguments, #distinct>),
            None => quote!(#name #arguments),
        }
    }

    /// How many of the step sizes of a composed step differ: it is the same forwards and backwards.
    fn distinct_stages(&self) -> Option<Literal> {
        self.program.formulas.stages().map(|stages| Literal::usize_unsuffixed(stages.div_ceil(2)))
    }

    /// The constants made by a closure of the step size: of one step, or of all.
    pub(super) fn made_for_steps(&self, body: &TokenStream) -> TokenStream {
        let Some(stages) = self.program.formulas.stages() else { return body.clone() };
        let (private, krate, scalar) = (&self.paths.private, &self.paths.krate, &self.paths.scalar);
        let (name, (_, arguments)) = (&self.names.constants, self.constants_generics());
        let sizes = format_ident!("SIZES_OF_{stages}");
        quote! {
            #private::Composed::new(h, &#private::#sizes, |h: #scalar| -> ::core::result::Result<#name #arguments, #krate::Error> {
                #body
            })
        }
    }

    /// The constants of a step of the whole size.
    pub(super) fn whole(&self) -> TokenStream {
        if self.program.formulas.stages().is_some() { quote!(constants.whole) } else { quote!(constants) }
    }

    /// The same as a field of `Step`, and those of the first step that is made.
    pub(super) fn whole_and_first(&self) -> [TokenStream; 2] {
        match self.program.formulas.stages() {
            Some(_) => [quote!(constants: &constants.whole), quote!(constants: &constants.stages[0])],
            None => [quote!(constants), quote!(constants)],
        }
    }

    /// A step of the discrete Euler–Poincaré representation.
    pub(super) fn step_taken(&self) -> TokenStream {
        let (private, step) = (&self.paths.private, &self.names.step);
        let (time, input) = (self.time_argument(), self.input_argument());
        if self.program.formulas.splitting.is_some() {
            let krate = &self.paths.krate;
            return quote!(#krate::Clebsch::steps(self, constants, (t, constants.step_size), 1, q, mu, impulse, u));
        }
        if self.follows_great_circles() {
            return self.great_circles_taken();
        }
        if self.program.formulas.stages().is_none() {
            return quote!(#step::euler_poincare(&#step { system: self, constants }, #time q, mu, impulse, #input));
        }
        quote! {
            #private::compose(constants, t, (*q, *mu, *impulse), |constants, t, (q, mu, impulse)| {
                #step::euler_poincare(&#step { system: self, constants }, #time &q, &mu, &impulse, #input)
            })
        }
    }

    /// A step of the discrete symmetric representation.
    pub(super) fn symmetric_step_taken(&self) -> TokenStream {
        let (private, krate, step) = (&self.paths.private, &self.paths.krate, &self.names.step);
        let time = self.time_argument();
        if !self.model.has_covectors() {
            return quote!(::core::result::Result::Err(#krate::Error::NoCovector));
        }
        let pushed = |_: &TokenStream| {
            let gradient = quote!(#step::kick_gradient(&step, #time &q, weight, gradient));
            let sum = code::combined(self.model, &quote!(p), quote!(+), &quote!(gradient), &self.paths);
            quote!(|t, weight, gradient, (q, p)| { let gradient = #gradient; (q, #sum) })
        };
        if let Some(split) = self.split(&quote!(1), &quote!((*q, *p)), &quote!(drift_symmetric), &pushed) {
            return split;
        }
        if self.program.formulas.stages().is_none() {
            return quote!(#step::symmetric(&#step { system: self, constants }, #time q, p));
        }
        quote! {
            #private::compose_symmetric(constants, t, (*q, *p), |constants, t, (q, p)| {
                #step::symmetric(&#step { system: self, constants }, #time &q, &p)
            })
        }
    }

    /// The method that makes several steps, where that is less than each of them.
    pub(super) fn steps_taken(&self) -> TokenStream {
        let (private, step) = (&self.paths.private, &self.names.step);
        let (title, taken) = match self.split_steps(&quote!(steps)) {
            Some(split) => {
                ("Several steps, the drift at the end of one and that at the start of the next in one.", split)
            }
            None if self.follows_great_circles() && self.program.formulas.stages().is_none() => {
                ("Several steps in (q, w).", {
                    let turned = self.turned_in_place(&quote!(steps));
                    quote!(#private::in_place((*q, *mu, *impulse), #turned))
                })
            }
            None if self.keeps_motions() => (
                "Several steps of one motion.",
                quote!(#step::euler_poincare_steps(&#step { system: self, constants }, steps, q, mu, impulse)),
            ),
            None => return TokenStream::new(),
        };
        self.several_steps(title, &taken)
    }

    /// The method that makes several steps.
    pub(super) fn several_steps(&self, title: &str, taken: &TokenStream) -> TokenStream {
        let (krate, scalar) = (&self.paths.krate, &self.paths.scalar);
        let title = docs::lines(&[title.to_string()]);
        quote! {
            #title
            fn steps(
                &self,
                constants: &Self::Constants,
                (t, _): (#scalar, #scalar),
                steps: ::core::primitive::usize,
                q: &Self::Configuration,
                mu: &Self::Held,
                impulse: &Self::Impulse,
                u: &Self::Input,
            ) -> ::core::result::Result<(Self::Configuration, Self::Held, Self::Impulse), #krate::Error> {
                #taken
            }
        }
    }

    /// The method that makes a step into the place of another state: `next`, `held` and `left`.
    pub(super) fn step_into(&self, taken: &TokenStream) -> TokenStream {
        let (krate, scalar) = (&self.paths.krate, &self.paths.scalar);
        quote! {
            /// One step into the place of another state.
            #[inline]
            fn step_into(
                &self,
                constants: &Self::Constants,
                t: #scalar,
                (q, mu, impulse): (&Self::Configuration, &Self::Held, &Self::Impulse),
                u: &Self::Input,
                (next, held, left): (&mut Self::Configuration, &mut Self::Held, &mut Self::Impulse),
            ) -> ::core::result::Result<(), #krate::Error> {
                #taken
            }
        }
    }

    /// Steps of a splitting in the discrete Euler–Poincaré representation.
    fn split_steps(&self, steps: &TokenStream) -> Option<TokenStream> {
        let state = self.state_of_drifts(&quote!(q), &quote!(mu));
        let kicked = |kick: &TokenStream| match self.is_compensated() {
            true => {
                let pushed = self.pushed_by(kick.clone());
                quote!(|t, weight, gradient, #state| { #pushed #state })
            }
            false => quote!(|t, weight, gradient, (q, mu)| (q, mu + #kick)),
        };
        let start = self.state_of_drifts(&quote!(*q), &quote!(*mu));
        let split = self.split(steps, &start, &quote!(drift), &kicked)?;
        let left = self.with_rests(quote!(()));
        let rests = self.is_compensated().then(|| quote!(let (q_rest, mu_rest) = impulse.1;));
        Some(quote!(#rests #split.map(|#state| (q, mu, #left))))
    }

    /// A splitting from a state: drifts by a method of `Step`, kicks by what is made of the impulse of one.
    fn split(
        &self,
        steps: &TokenStream,
        start: &TokenStream,
        drift: &TokenStream,
        kicked: &dyn Fn(&TokenStream) -> TokenStream,
    ) -> Option<TokenStream> {
        let splitting = self.program.formulas.splitting.as_ref()?;
        let (private, step, time) = (&self.paths.private, &self.names.step, self.time_argument());
        let kind = if splitting.has_gradient { "GRADIENT" } else { "PLAIN" };
        let kicks = format_ident!("{kind}_{}", self.model.order.number());
        let kick = kicked(&quote!(#step::kick(&step, #time &q, weight, gradient)));
        Some(quote! {
            let step = #step { system: self, constants };
            #private::split(&#private::#kicks, (t, constants.step_size, #steps), #start, |part, state| #step::#drift(&step, part, state), #kick)
        })
    }

    /// The step to which an edge of a composed step belongs: its constants, its time and the number of the edge in it.
    pub(super) fn stage_of_edge(&self) -> TokenStream {
        if self.program.formulas.stages().is_none() {
            return TokenStream::new();
        }
        let parts = Literal::usize_unsuffixed(self.program.formulas.parts);
        quote! {
            let stage = constants.stage(edge / #parts);
            let (constants, t, edge) = (stage.constants, t + stage.start, edge % #parts);
        }
    }

    /// The slopes of an edge, those along the size and the time of its own step made of those along h and t of the whole one.
    pub(super) fn slopes_of_step(&self, slopes: TokenStream) -> TokenStream {
        if self.program.formulas.stages().is_none() {
            return slopes;
        }
        let position = |name: &str| self.program.formulas.quantities.iter().position(|quantity| quantity.name == name);
        let [size, time] = ["h", "t"].map(|name| match position(name).map(Literal::usize_unsuffixed) {
            Some(column) => quote!(::core::option::Option::Some(#column)),
            None => quote!(::core::option::Option::None),
        });
        quote! {
            let (before, after) = { #slopes };
            (stage.slopes(before, #size, #time), stage.slopes(after, #size, #time))
        }
    }
}
