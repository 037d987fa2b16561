//! The fifth stage: the program as Rust, documented with the formulas it computes.

mod call;
mod code;
mod collocation;
mod constants;
mod control;
mod dials;
mod docs;
mod equation;
mod exact;
mod function;
mod functions;
mod jacobian;
mod matrices;
mod methods;
mod names;
mod opaque;
mod parts;
mod power;
mod scheme;
mod scope;
mod solve;
mod stub;
mod system;
mod types;
mod variation;

use std::cell::RefCell;
use std::ops::Deref;

use proc_macro2::{Ident, TokenStream};
use quote::{ToTokens, format_ident, quote};

use crate::MethodProgram;
use crate::derive::{FormulaTable, MechanicsFormulas, Symbols, SystemFormulas};
use crate::lower::{KernelTable, MechanicsProgram, Program};
use crate::model::{Item, Mechanics, Opaque, Power, System};
use names::Names;
use scope::{Scope, size};
use types::{Paths, Target};

pub use functions::shown_by;
pub use stub::stub;

/// The integrator of a program.
pub fn emit(program: &Program<'_>) -> TokenStream {
    let (emitter, items) = expanded(program);
    let asked = emitter.model.emit;
    let generated = asked.generated.then(|| {
        let documentation = "The code that `derive(Clebsch)` has generated for this struct.";
        emitter.constant("GENERATED", documentation, &pretty(&items))
    });
    let latex = asked.latex.then(|| {
        let documentation = "The formulas of the derivation of this struct in LaTeX, an `align*` of its own.";
        emitter.constant("DERIVATION_LATEX", documentation, &emitter.rows.latex())
    });
    quote! {
        // the lints of straight-line code are ours to mind, not the user's; signatures are the same for every system, and
        // not every kernel reads all of its arguments
        #[allow(clippy::all, clippy::pedantic, unused_parens, unused_variables, dead_code)]
        const _: () = {
            #items
        };
        #generated
        #latex
    }
}

/// All items, with what emits those that every system has.
fn expanded<'a, 'g>(program: &'a Program<'g>) -> (SystemEmitter<'a, 'g>, TokenStream) {
    match program {
        Program::Mechanics(program) => {
            let emitter = Emitter::new(program);
            let items = emitter.items();
            (emitter.system, items)
        }
        Program::Steered(program) => {
            let table = (program.formulas.table(), &program.table);
            let emitter = SystemEmitter::new(&program.formulas, table, (None, None), &[]);
            let (groups, aliases, controlled) = (emitter.groups(), emitter.aliases(), emitter.controlled());
            let documentation = "The derivation of this struct in words and formulas.";
            let derivation = emitter.constant("DERIVATION", documentation, &program.derivation());
            (emitter, quote!(#groups #aliases #controlled #derivation))
        }
    }
}

/// The texts of `DERIVATION` of a program and of its methods, one after the other.
pub fn derivations(program: &Program<'_>) -> String {
    let methods = program.mechanics().into_iter().flat_map(|program| &program.methods);
    let methods = methods.map(|method| format!("\n{}", method.program.derivation_by(&method.name)));
    methods.fold(program.derivation(), |text, method| text + &method)
}

/// The generated code of a program as text.
pub fn generated(program: &Program<'_>) -> String {
    pretty(&expanded(program).1)
}

fn pretty(items: &TokenStream) -> String {
    match syn::parse2(items.clone()) {
        Ok(file) => prettyplease::unparse(&file),
        // by construction: what is emitted parses; if not, the raw tokens show where
        Err(_) => items.to_string(),
    }
}

/// What every part of the expansion needs.
struct Emitter<'a, 'g> {
    system: SystemEmitter<'a, 'g>,
    program: &'a MechanicsProgram<'g>,
    formulas: &'a MechanicsFormulas<'g>,
    model: &'a Mechanics<'g>,
}

/// What the parts need that mechanics and control have in common.
struct SystemEmitter<'a, 'g> {
    model: &'a System<'g>,
    symbols: &'a Symbols<'g>,
    rows: &'a FormulaTable<'g>,
    kernels: &'a KernelTable,
    keeps_matrices: bool,
    power: Option<&'a Power<'g>>,
    opaque: Option<&'a Opaque>,
    /// The method that is emitted, where it is not that of the declared dials.
    method: Option<&'a Ident>,
    /// Paths of the runtime, as they are spelled where no name of the expansion is in scope.
    spelled: Paths,
    paths: Paths,
    /// The user's struct; of a power that of a site.
    target: Target,
    names: Names,
}

impl<'a, 'g> Deref for Emitter<'a, 'g> {
    type Target = SystemEmitter<'a, 'g>;

    fn deref(&self) -> &SystemEmitter<'a, 'g> {
        &self.system
    }
}

impl<'a, 'g> Emitter<'a, 'g> {
    fn new(program: &'a MechanicsProgram<'g>) -> Emitter<'a, 'g> {
        let (formulas, model) = (&program.formulas, &program.formulas.model);
        Emitter { system: SystemEmitter::of_mechanics(program), program, formulas, model }
    }

    /// The emitter of a method, which has the names of that of the declared dials.
    fn of_method(declared: &'a MechanicsProgram<'g>, method: &'a MethodProgram<'g>) -> Emitter<'a, 'g> {
        let emitter = Emitter::new(&method.program);
        let SystemEmitter { spelled, paths, target, names, .. } = SystemEmitter::of_mechanics(declared);
        let method = Some(&method.name);
        Emitter { system: SystemEmitter { method, spelled, paths, target, names, ..emitter.system }, ..emitter }
    }

    fn items(&self) -> TokenStream {
        let (groups, aliases) = (self.groups(), self.aliases());
        let (power, constants, system) = (self.power(), self.constants_type(), self.system());
        // what is conserved of a power is a sum over its sites
        let conserves = self.power.is_none().then(|| self.conserves());
        let (variational, sensitive, controlled) = (self.variational(), self.sensitive(), self.controlled());
        let (check, parts, equations) = (self.potential_check(), self.parts(), self.equations());
        let (velocity, methods) = (self.velocity(), self.methods());
        quote!(#groups #aliases #power #constants #system #conserves #variational #sensitive #controlled #check #parts #equations #velocity #methods)
    }
}

impl<'a, 'g> SystemEmitter<'a, 'g> {
    fn of_mechanics(program: &'a MechanicsProgram<'g>) -> SystemEmitter<'a, 'g> {
        let formulas = &program.formulas;
        let parts = (formulas.model.power.as_ref(), formulas.model.opaque.as_ref());
        let emitter = SystemEmitter::new(formulas, (formulas.table(), &program.table), parts, &program.methods);
        SystemEmitter { keeps_matrices: program.form.keeps_matrices(), ..emitter }
    }

    fn new(
        formulas: &'a SystemFormulas<'g>,
        (rows, kernels): (&'a FormulaTable<'g>, &'a KernelTable),
        (power, opaque): (Option<&'a Power<'g>>, Option<&'a Opaque>),
        methods: &[MethodProgram<'g>],
    ) -> SystemEmitter<'a, 'g> {
        let (model, symbols, item) = (&*formulas.model, &formulas.symbols, &formulas.model.item);
        let names = Names::new(model, (power, opaque), methods.iter().map(|method| &method.name));
        let spelled = Paths::new(&item.krate.to_token_stream(), &item.scalar);
        let paths = spelled.named(item, &names);
        let target = Target::new(&item.ident, &item.generics, &item.scalar, &spelled.private);
        let (method, keeps_matrices) = (None, false);
        SystemEmitter {
            model,
            symbols,
            rows,
            kernels,
            keeps_matrices,
            power,
            opaque,
            method,
            spelled,
            paths,
            target,
            names,
        }
    }

    /// The documentation types of the groups, named where the user has written them, so that an editor shows their pages there.
    fn groups(&self) -> TokenStream {
        let krate = &self.paths.krate;
        let built_in = self.model.factors.iter().filter(|factor| !factor.group.is_declared());
        let types = built_in.map(|factor| {
            let (name, sizes) = factor.group.symbol();
            let (name, sizes) = (Ident::new(name, factor.span), sizes.into_iter().map(size));
            quote!(const _: ::core::option::Option<#krate::group::#name<#(#sizes),*>> = ::core::option::Option::None;)
        });
        types.collect()
    }

    /// The user's struct as it is declared, where that is another one than that of a site.
    fn declared(&self, private: &TokenStream) -> Target {
        let item: &Item = self.power.map_or(&self.model.item, |power| &power.item);
        Target::new(&item.ident, &item.generics, &item.scalar, private)
    }

    /// A constant of the user's struct that holds a text.
    fn constant(&self, name: &str, documentation: &str, text: &str) -> TokenStream {
        let (name, documentation) = (format_ident!("{name}"), docs::lines(documentation));
        let constant = quote! {
            #documentation
            pub const #name: &'static ::core::primitive::str = #text;
        };
        self.declared(&self.spelled.private).derived(None, constant)
    }

    /// The scope of a method of the user's struct.
    fn scope_of_system(&self) -> Scope<'_, 'g> {
        self.scope(self.receiver(), None)
    }

    /// The scope of a part of a step.
    fn scope_of_step(&self) -> Scope<'_, 'g> {
        self.scope(quote!(self), Some(quote!(c)))
    }

    fn scope(&self, system: TokenStream, constants: Option<TokenStream>) -> Scope<'_, 'g> {
        let [momenta, coordinates] = [(0..self.model.dimension()).collect(), (0..self.model.dimension()).collect()];
        let (reads, numbers) = (RefCell::default(), RefCell::default());
        Scope { emitter: self, system, constants, momenta, coordinates, reads, numbers }
    }
}

/// A constant of a trait that is true or false.
fn flag(name: &str, value: bool) -> TokenStream {
    let name = format_ident!("{name}");
    quote!(const #name: ::core::primitive::bool = #value;)
}
