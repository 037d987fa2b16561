//! The fifth stage: the program as Rust, documented with the formulas it computes.

mod block;
mod call;
mod code;
mod collocation;
mod constants;
mod control;
mod equation;
mod field;
mod function;
mod functions;
mod matrices;
mod names;
mod parts;
mod power;
mod scheme;
mod scope;
mod solve;
mod stub;
mod system;
mod variation;

use std::cell::RefCell;
use std::ops::Deref;

use clebsch_symbolic::{Group, IntoList};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};

use crate::MethodProgram;
use crate::derive::{self, FormulaTable, MechanicsFormulas, OnEdge, Symbols, SystemFormulas};
use crate::lower::{KernelTable, MechanicsProgram, Program};
use crate::model::{Item, Mechanics, Opaque, Power, System};
use block::{Block, Target, anonymous, leaf, matrix};
use names::Names;
use scope::{Scope, nested_type, size};

pub use functions::shown_by;
pub use stub::stub;

/// The integrator of a program.
pub fn emit(program: &Program<'_>) -> TokenStream {
    let (emitter, items) = expanded(program);
    let asked = emitter.model.emit;
    #[cfg(feature = "generated")]
    let generated = asked.generated.then(|| {
        let documentation = "The code that `derive(Clebsch)` has generated for this struct.";
        emitter.constant("GENERATED", documentation, &pretty(&items))
    });
    // the parser refuses the word
    #[cfg(not(feature = "generated"))]
    let generated = None::<TokenStream>;
    let latex = asked.latex.then(|| {
        let documentation = "The formulas of the derivation of this struct in LaTeX, an `align*` of its own.";
        emitter.constant("DERIVATION_LATEX", documentation, &emitter.rows.latex())
    });
    let texts = emitter.names.put_in(quote!(#generated #latex));
    anonymous(&quote!(#items #texts))
}

/// All items, with the emitter of those that every system has.
fn expanded<'a, 'g>(program: &'a Program<'g>) -> (SystemEmitter<'a, 'g>, TokenStream) {
    let (emitter, items) = match program {
        Program::Mechanics(program) => {
            let emitter = Emitter::new(program);
            let items = emitter.items();
            (emitter.system, items)
        }
        Program::Steered(steered) => {
            let table = (steered.formulas.table(), &steered.table);
            let emitter = SystemEmitter::new(&steered.formulas, table, (None, None), &[]);
            let controlled = emitter.controlled();
            let documentation = "The derivation of this struct in words and formulas.";
            let derivation = emitter.constant("DERIVATION", documentation, &program.derivation());
            (emitter, quote!(#controlled #derivation))
        }
    };
    let groups = emitter.groups();
    let items = emitter.named(&quote!(#groups #items));
    (emitter, items)
}

/// The texts of `DERIVATION` of a program and of its methods, one after the other.
pub fn derivations(program: &Program<'_>) -> String {
    let methods = program.mechanics().into_iter().flat_map(|program| &program.methods);
    let methods = methods.map(|method| format!("\n{}", method.program.derivation_by(&method.name)));
    methods.fold(program.derivation(), |text, method| text + &method)
}

/// The derivations of a program and of its methods as an appendix of a paper, in LaTeX.
pub fn appendix(program: &Program<'_>) -> String {
    let table = match program {
        Program::Mechanics(program) => program.formulas.table(),
        Program::Steered(program) => program.formulas.table(),
    };
    let methods = program.mechanics().into_iter().flat_map(|program| &program.methods);
    let methods = methods.map(|MethodProgram { name, program }| {
        format!("\n{}", derive::appendix(&program.derivation_by(name), program.formulas.table()))
    });
    methods.fold(derive::appendix(&program.derivation(), table), |text, method| text + &method)
}

/// The generated code of a program as text.
#[cfg(feature = "generated")]
pub fn generated(program: &Program<'_>) -> String {
    pretty(&expanded(program).1)
}

#[cfg(feature = "generated")]
fn pretty(items: &TokenStream) -> String {
    match syn::parse2(items.clone()) {
        Ok(file) => prettyplease::unparse(&file),
        // by construction: emitted tokens parse; if not, the raw tokens show where
        Err(_) => items.to_string(),
    }
}

/// The data that every part of the expansion needs.
struct Emitter<'a, 'g> {
    system: SystemEmitter<'a, 'g>,
    program: &'a MechanicsProgram<'g>,
    formulas: &'a MechanicsFormulas<'g>,
    model: &'a Mechanics<'g>,
}

/// The data that mechanics and control share.
struct SystemEmitter<'a, 'g> {
    block: Block<'a>,
    model: &'a System<'g>,
    symbols: &'a Symbols<'g>,
    rows: &'a FormulaTable<'g>,
    kernels: &'a KernelTable,
    /// The functions of inputs that take the velocity of a step.
    on_edge: OnEdge,
    /// Where a constraint acts in steps, three numbers: its equations, the quantities that steps are differentiated by, and the equations on
    /// places.
    reactions: Option<[usize; 3]>,
    /// For each component of η, the chart coordinate of exp η to first order, as numerator and denominator.
    slopes_of_retraction: Vec<(i64, i64)>,
    keeps_matrices: bool,
    /// Whether it is the site of a field. Sites do not wait for each other: the number of operations counts, not their chain.
    is_of_field: bool,
    power: Option<&'a Power<'g>>,
    /// The number of its sites.
    length: Option<TokenStream>,
    opaque: Option<&'a Opaque>,
}

impl<'a, 'g> Deref for Emitter<'a, 'g> {
    type Target = SystemEmitter<'a, 'g>;

    fn deref(&self) -> &SystemEmitter<'a, 'g> {
        &self.system
    }
}

impl<'a> Deref for SystemEmitter<'a, '_> {
    type Target = Block<'a>;

    fn deref(&self) -> &Block<'a> {
        &self.block
    }
}

impl<'a, 'g> Emitter<'a, 'g> {
    fn new(program: &'a MechanicsProgram<'g>) -> Emitter<'a, 'g> {
        let (formulas, model) = (&program.formulas, &program.formulas.model);
        let parts = (model.power.as_ref(), model.opaque.as_ref());
        let system = SystemEmitter::new(formulas, (formulas.table(), &program.table), parts, &program.methods);
        let system = SystemEmitter {
            keeps_matrices: program.form.keeps_matrices(),
            is_of_field: model.field.is_some(),
            reactions: formulas.constraint.as_ref().map(|constraint| {
                let places = constraint.places.as_ref().map_or(0, |places| places.rows.shape().rows);
                [constraint.rows.shape().rows, formulas.quantities.len(), places]
            }),
            ..system
        };
        Emitter { system, program, formulas, model }
    }

    /// The emitter of a method, which stands in the block of that of the declared dials.
    fn of_method(&self, method: &'a MethodProgram<'g>) -> Emitter<'a, 'g> {
        let emitter = Emitter::new(&method.program);
        let block = Block { method: Some(&method.name), ..self.block.clone() };
        Emitter { system: SystemEmitter { block, ..emitter.system }, ..emitter }
    }

    fn items(&self) -> TokenStream {
        let (power, constants, system) = (self.power(), self.constants_type(), self.system());
        // a conserved quantity of a power is a sum over its sites
        let conserves = self.power.is_none().then(|| self.conserves());
        let (constrained, field) = (self.constrained(), self.field());
        let (variational, sensitive, controlled) = (self.variational(), self.sensitive(), self.controlled());
        let (check, parts, equations) = (self.potential_check(), self.parts(), self.equations());
        let (velocity, methods) = (self.velocity(), self.methods());
        quote!(#power #constants #system #conserves #constrained #field #variational #sensitive #controlled #check #parts #equations #velocity #methods)
    }

    /// The blocks of all methods. The names of types are those of the outer block; types of steps have names of their
    /// own.
    pub(super) fn methods(&self) -> TokenStream {
        let blocks = self.program.methods.iter().map(|method| {
            let emitter = self.of_method(method);
            let stepping = emitter.stepping(None, &emitter.program.derivation_by(&method.name));
            let (constants, method) =
                (emitter.constants_type(), emitter.implementation_of_method(&method.name, &stepping));
            let (edges, parts) = (emitter.edges(), emitter.parts());
            let (equations, velocity) = (emitter.equations(), emitter.velocity());
            quote!(const _: () = { #constants #method #edges #parts #equations #velocity };)
        });
        blocks.collect()
    }

    /// An implementation of a hidden trait of the runtime.
    pub(super) fn implementation(&self, name: &str, sizes: &[Literal], items: TokenStream) -> TokenStream {
        self.target.implementation(Some(self.trait_of_parts(name, sizes)), items)
    }

    /// The type of the method that is emitted.
    pub(super) fn own_method(&self) -> TokenStream {
        self.method.map_or_else(|| quote!(runtime::Declared), |method| self.names.of_user(quote!(#method)))
    }

    /// A trait of the parts of a step: by its sizes, and by the method that is emitted where there are several.
    pub(super) fn trait_of_parts(&self, name: &str, sizes: &[Literal]) -> TokenStream {
        let is_named = self.method.is_some() || !self.program.methods.is_empty();
        let method = is_named.then(|| self.own_method());
        let (name, mut arguments) =
            (format_ident!("{name}"), sizes.iter().map(|size| quote!(#size)).chain(method).peekable());
        if arguments.peek().is_none() { quote!(runtime::#name) } else { quote!(runtime::#name::<#(#arguments),*>) }
    }
}

impl<'a, 'g> SystemEmitter<'a, 'g> {
    fn new(
        formulas: &'a SystemFormulas<'g>,
        (rows, kernels): (&'a FormulaTable<'g>, &'a KernelTable),
        (power, opaque): (Option<&'a Power<'g>>, Option<&'a Opaque>),
        methods: &[MethodProgram<'g>],
    ) -> SystemEmitter<'a, 'g> {
        let (model, symbols, item) = (&*formulas.model, &formulas.symbols, &formulas.model.item);
        // of a power the user's struct is another item than that of a site
        let mut users: Vec<TokenStream> =
            [item].into_iter().chain(power.map(|power| &power.item)).map(of_item).into_list();
        users.extend(methods.iter().map(|method| method.name.to_token_stream()));
        users.extend(model.constants.iter().map(|constant| constant.path.to_token_stream()));
        users.extend(opaque.map(|Opaque { value, gradient, .. }| quote!(#value #gradient)));
        let names = Names::new(&item.scalar, !model.configurations.is_empty(), &users);
        let length = power.map(|power| names.of_user(power.length.to_token_stream()));
        let configuration = nested_type(&model.configuration, |k| {
            leaf(model.configurations[k].shape, model.configurations[k].is_quaternion)
        });
        let element = nested_type(&model.element, |k| {
            let group = model.factors[k].group;
            leaf(group.element_shape(), group == Group::UnitQuaternions)
        });
        let block = Block {
            krate: item.krate.to_token_stream(),
            scalar: &item.scalar,
            types: [configuration, element, matrix(model.dimension(), 1)],
            input: nested_type(&model.input, |k| leaf(model.inputs[k].shape, model.inputs[k].is_quaternion)),
            dimension: model.dimension(),
            method: None,
            target: Target::new(&item.ident, &item.generics, &item.scalar, &names),
            names,
        };
        SystemEmitter {
            block,
            model,
            symbols,
            rows,
            kernels,
            on_edge: formulas.steering.as_ref().map(|steering| steering.on_edge).unwrap_or_default(),
            reactions: None,
            slopes_of_retraction: formulas.slopes_of_retraction(),
            keeps_matrices: false,
            is_of_field: false,
            power,
            length,
            opaque,
        }
    }

    /// The documentation types of the groups, named where the user has written them, so that an editor shows their pages there.
    fn groups(&self) -> TokenStream {
        let built_in = self.model.factors.iter().filter(|factor| !factor.group.is_declared());
        let types = built_in.map(|factor| {
            let (name, sizes) = factor.group.symbol();
            let (name, sizes) = (Ident::new(name, factor.span), sizes.into_iter().map(size));
            quote!(const _: runtime::Option<runtime::group::#name<#(#sizes),*>> = runtime::None;)
        });
        types.collect()
    }

    /// The user's struct as it is declared, where that is another one than that of a site.
    fn declared(&self) -> Target {
        let item: &Item = self.power.map_or(&self.model.item, |power| &power.item);
        Target::new(&item.ident, &item.generics, &item.scalar, &self.names)
    }

    /// A constant of the user's struct that holds a text.
    fn constant(&self, name: &str, documentation: &str, text: &str) -> TokenStream {
        let (name, documentation) = (format_ident!("{name}"), format!(" {documentation}"));
        let constant = quote! {
            #[doc = #documentation]
            pub const #name: &'static ::core::primitive::str = #text;
        };
        self.declared().derived(None, constant)
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
        let [momenta, coordinates] = [(0..self.dimension).into_list(), (0..self.dimension).into_list()];
        let (reads, numbers) = (RefCell::default(), RefCell::default());
        Scope { emitter: self, system, constants, momenta, coordinates, reads, numbers }
    }
}

/// The names of the user in an item.
fn of_item(Item { ident, generics, .. }: &Item) -> TokenStream {
    let predicates = &generics.where_clause;
    quote!(#ident #generics #predicates)
}

/// A constant of a trait that is true or false.
fn flag(name: &str, value: bool) -> TokenStream {
    let name = format_ident!("{name}");
    quote!(const #name: ::core::primitive::bool = #value;)
}
