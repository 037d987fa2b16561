//! The fifth stage: the program as Rust, documented with the formulas it computes.

mod call;
mod code;
mod collocation;
mod constants;
mod control;
mod docs;
mod equation;
mod exact;
mod jacobian;
mod matrices;
mod methods;
mod names;
mod opaque;
mod parts;
mod path;
mod power;
mod scheme;
mod stub;
mod system;
mod variation;

use std::ops::Deref;

use clebsch_symbolic::Group;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use crate::MethodProgram;
use crate::derive::{FormulaTable, Id, Symbols, SystemFormulas};
use crate::lower::{KernelTable, MechanicsProgram, Program, SteeredProgram};
use crate::model::{Item, Mechanics, Opaque, Power, System};
use code::{Scope, Spelled, nested_type};
use names::Names;
use path::Paths;

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
            let emitter = SystemEmitter::of_steered(program);
            let items = emitter.items_of_control(&program.derivation());
            (emitter, items)
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
    generics: Generics,
    names: Names,
}

impl<'a, 'g> Deref for Emitter<'a, 'g> {
    type Target = SystemEmitter<'a, 'g>;

    fn deref(&self) -> &SystemEmitter<'a, 'g> {
        &self.system
    }
}

/// The user's generics in the forms that impls need.
struct Generics {
    /// Parameters as an impl declares them, without angle brackets or defaults.
    parameters: TokenStream,
    /// Arguments, without angle brackets.
    arguments: TokenStream,
    /// The where clause, with the scalar's bound.
    predicates: TokenStream,
}

impl Generics {
    fn of(item: &Item, paths: &Paths) -> Generics {
        let mut generics = item.generics.clone();
        for parameter in generics.type_params_mut() {
            parameter.default = None;
        }
        for parameter in generics.const_params_mut() {
            parameter.default = None;
        }
        let parameters = &generics.params;
        let arguments = generics.params.iter().map(|parameter| match parameter {
            syn::GenericParam::Lifetime(lifetime) => {
                let lifetime = &lifetime.lifetime;
                quote!(#lifetime)
            }
            syn::GenericParam::Type(parameter) => {
                let ident = &parameter.ident;
                quote!(#ident)
            }
            syn::GenericParam::Const(parameter) => {
                let ident = &parameter.ident;
                quote!(#ident)
            }
        });
        let arguments: Vec<TokenStream> = arguments.collect();
        let predicates = generics.where_clause.as_ref().map(|clause| &clause.predicates).into_iter().flatten();
        let predicates: Vec<_> = predicates.collect();
        let (private, scalar) = (&paths.private, &paths.scalar);
        let bound =
            matches!(item.scalar, crate::model::ScalarType::Parameter(_)).then(|| quote!(#scalar: #private::Scalar,));
        Generics {
            parameters: quote!(#parameters),
            arguments: quote!(#(#arguments),*),
            predicates: quote!(where #(#predicates,)* #bound),
        }
    }
}

impl<'a, 'g> Emitter<'a, 'g> {
    fn new(program: &'a MechanicsProgram<'g>) -> Emitter<'a, 'g> {
        Emitter { system: SystemEmitter::of_mechanics(program), program, model: &program.formulas.model }
    }

    /// The emitter of a method, which has the names of that of the declared dials.
    fn of_method(declared: &'a MechanicsProgram<'g>, method: &'a MethodProgram<'g>) -> Emitter<'a, 'g> {
        let program = &method.program;
        let SystemEmitter { spelled, paths, generics, names, .. } = SystemEmitter::of_mechanics(declared);
        let method = Some(&method.name);
        let system = SystemEmitter { method, spelled, paths, generics, names, ..SystemEmitter::of_mechanics(program) };
        Emitter { system, program, model: &program.formulas.model }
    }

    fn items(&self) -> TokenStream {
        let groups = self.groups();
        let power = self.power();
        let constants = self.constants_type();
        let system = self.system();
        let conserves = self.conserves();
        let parts = self.parts();
        let (equations, velocity, check) = (self.equations(), self.velocity(), self.potential_check());
        let (variational, sensitive, controlled) = (self.variational(), self.sensitive(), self.controlled());
        let (aliases, methods) = (self.aliases(), self.methods());
        quote!(#groups #aliases #power #constants #system #conserves #variational #sensitive #controlled #check #parts #equations #velocity #methods)
    }

    /// Whether the cost or the potential depends on the time, so that steps are told it.
    fn is_timed(&self) -> bool {
        self.program.formulas.is_timed()
    }

    /// Whether the end kick of a step serves as the start kick of the next.
    fn shares_impulse(&self) -> bool {
        let formulas = &self.program.formulas;
        let last = formulas.stepped - 1;
        formulas.substeps[0].start == formulas.substeps[last].end
            && self.program.find(Id::StartKick(0)).is_some()
            && self.program.find(Id::EndKick(last)).is_some()
            && formulas.splitting.is_none()
            && formulas.collocation.is_none()
    }

    /// Whether steps are made in (q, w).
    fn follows_great_circles(&self) -> bool {
        self.program.turns_in_plane()
    }

    /// Whether sums are compensated.
    fn is_compensated(&self) -> bool {
        self.program.formulas.is_compensated()
    }

    /// Whether steps are made in (q, w) and nothing pushes.
    fn is_free_on_great_circles(&self) -> bool {
        let is_free = |id: Id| self.program.find(id).is_none();
        self.follows_great_circles() && is_free(Id::StartGradient(0)) && is_free(Id::EndGradient(0))
    }
}

impl<'a, 'g> SystemEmitter<'a, 'g> {
    fn of_mechanics(program: &'a MechanicsProgram<'g>) -> SystemEmitter<'a, 'g> {
        let model = &program.formulas.model;
        let (power, opaque) = (model.power.as_ref(), model.opaque.as_ref());
        let names = Names::new(model, (power, opaque), methods::names(&program.methods));
        let emitter = SystemEmitter::new(&program.formulas, program.formulas.table(), &program.table, names);
        SystemEmitter { keeps_matrices: program.form.keeps_matrices(), power, opaque, ..emitter }
    }

    fn of_steered(program: &'a SteeredProgram<'g>) -> SystemEmitter<'a, 'g> {
        let names = Names::new(&program.formulas.model, (None, None), std::iter::empty());
        SystemEmitter::new(&program.formulas, program.formulas.table(), &program.table, names)
    }

    fn new(
        formulas: &'a SystemFormulas<'g>,
        rows: &'a FormulaTable<'g>,
        kernels: &'a KernelTable,
        names: Names,
    ) -> SystemEmitter<'a, 'g> {
        let model = &*formulas.model;
        let spelled = Paths::new(&model.item);
        SystemEmitter {
            model,
            symbols: &formulas.symbols,
            rows,
            kernels,
            keeps_matrices: false,
            power: None,
            opaque: None,
            method: None,
            paths: spelled.named(&model.item, &names),
            generics: Generics::of(&model.item, &spelled),
            spelled,
            names,
        }
    }

    /// What is emitted of a configuration that inputs move.
    fn items_of_control(&self, derivation: &str) -> TokenStream {
        let (groups, aliases) = (self.groups(), self.aliases());
        let (controlled, derivation) = (self.controlled(), self.derivation_of_control(derivation));
        quote!(#groups #aliases #controlled #derivation)
    }

    /// The documentation types of the groups, named where the user has written them, so that an editor shows their pages there.
    fn groups(&self) -> TokenStream {
        let krate = &self.paths.krate;
        let built_in = self.model.factors.iter().filter(|factor| !factor.group.is_declared());
        let types = built_in.map(|factor| {
            let (name, sizes) = factor.group.symbol();
            let name = Ident::new(name, factor.span);
            let sizes = sizes.into_iter().map(Literal::usize_unsuffixed);
            quote!(const _: ::core::option::Option<#krate::group::#name<#(#sizes),*>> = ::core::option::Option::None;)
        });
        quote!(#(#types)*)
    }

    /// A constant of the user's struct that holds a text.
    fn constant(&self, name: &str, documentation: &str, text: &str) -> TokenStream {
        let item = self.power.map_or(&self.model.item, |power| &power.item);
        let Generics { parameters, arguments, predicates } = Generics::of(item, &self.spelled);
        let (ident, name) = (&item.ident, format_ident!("{name}"));
        let documentation = docs::lines(&[documentation.to_string()]);
        quote! {
            #[automatically_derived]
            impl<#parameters> #ident<#arguments> #predicates {
                #documentation
                pub const #name: &'static ::core::primitive::str = #text;
            }
        }
    }

    /// The scope of a method of the user's struct.
    fn scope_of_system(&self) -> Scope<'_, 'g> {
        self.scope(self.receiver(), None)
    }

    /// The scope of a part of a step.
    fn scope_of_step(&self) -> Scope<'_, 'g> {
        self.scope(quote!(self), Some(quote!(c)))
    }

    /// The scope of a method of an equation.
    fn scope_of_equation(&self) -> Scope<'_, 'g> {
        self.scope(quote!(system), Some(quote!(c)))
    }

    fn scope(&self, system: TokenStream, constants: Option<TokenStream>) -> Scope<'_, 'g> {
        let dimension = self.dimension();
        Scope {
            model: self.model,
            power: self.power,
            opaque: self.opaque,
            paths: &self.paths,
            system,
            constants,
            constant_names: &self.kernels.constant_names,
            momenta: (0..dimension).collect(),
            coordinates: (0..dimension).collect(),
            blocks: self.symbols.blocks.iter().map(|block| block.offset).collect(),
            momentum: "mu",
            item: self.item_type(),
            keeps_matrices: self.keeps_matrices,
            spelled: Spelled::default(),
        }
    }

    /// The user's struct with its generics.
    fn item_type(&self) -> TokenStream {
        let (ident, arguments) = (&self.model.item.ident, &self.generics.arguments);
        if arguments.is_empty() { quote!(#ident) } else { quote!(#ident<#arguments>) }
    }

    fn input_type(&self) -> TokenStream {
        nested_type(&self.model.input, &|leaf| self.paths.leaf(self.model.inputs[leaf].shape, false))
    }

    /// The number of components of a momentum.
    fn dimension(&self) -> usize {
        self.model.dimension()
    }

    /// Short names for what signatures are made of.
    fn aliases(&self) -> TokenStream {
        let Names { runtime, scalar, configuration, element, momentum, .. } = &self.names;
        let (module, spelled) = (&self.spelled.private, &self.spelled.scalar);
        let is_parameter = matches!(self.model.item.scalar, crate::model::ScalarType::Parameter(_));
        let scalar = (!is_parameter).then(|| quote!(type #scalar = #spelled;));
        let generics = is_parameter.then(|| quote!(<#spelled>));
        // momenta that are stepped alone have no configuration
        let of_configuration = generics.clone().filter(|_| !self.model.configurations.is_empty());
        let [q, f, mu] = self.types(&self.paths);
        quote! {
            use #module as #runtime;
            #scalar
            type #configuration #of_configuration = #q;
            type #element #generics = #f;
            type #momentum #generics = #mu;
        }
    }

    /// The types of q, F and μ.
    fn types(&self, paths: &Paths) -> [TokenStream; 3] {
        let configuration = nested_type(&self.model.configuration, &|leaf| {
            let configuration = &self.model.configurations[leaf];
            paths.leaf(configuration.shape, configuration.is_quaternion)
        });
        let element = nested_type(&self.model.element, &|factor| {
            let group = self.model.factors[factor].group;
            paths.leaf(group.element_shape(), group == Group::UnitQuaternions)
        });
        [configuration, element, paths.matrix(self.dimension(), 1)]
    }

    fn configuration_type(&self) -> TokenStream {
        let name = &self.names.configuration;
        if self.model.configurations.is_empty() { quote!(#name) } else { self.alias(name) }
    }

    fn element_type(&self) -> TokenStream {
        self.alias(&self.names.element)
    }

    fn momentum_type(&self) -> TokenStream {
        self.alias(&self.names.momentum)
    }

    /// The type of a vector, by its name where it has one.
    fn vector_type(&self, rows: usize) -> TokenStream {
        if rows == self.dimension() { self.momentum_type() } else { self.paths.matrix(rows, 1) }
    }

    /// The names of the types of q, F and μ.
    fn names_of_types(&self) -> [TokenStream; 3] {
        [self.configuration_type(), self.element_type(), self.momentum_type()]
    }

    fn alias(&self, name: &Ident) -> TokenStream {
        let (_, arguments) = self.constants_generics();
        quote!(#name #arguments)
    }

    fn constants_generics(&self) -> (TokenStream, TokenStream) {
        let (private, scalar) = (&self.paths.private, &self.paths.scalar);
        match self.model.item.scalar {
            crate::model::ScalarType::Parameter(_) => (quote!(<#scalar: #private::Scalar>), quote!(<#scalar>)),
            _ => (quote!(), quote!()),
        }
    }
}
