//! The names and the shapes of numbers.

use clebsch::{Clebsch, Columns, Form, Names};

/// A value with its name and its shape.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// The name.
    pub name: String,
    /// The lengths of an array of NumPy.
    pub shape: Vec<usize>,
}

impl Quantity {
    /// A value of this form.
    pub fn new(name: &str, form: Form) -> Self {
        Self { name: name.to_owned(), shape: shape(form) }
    }
}

/// The shape of an array of NumPy: vectors have one length, and parts of a tuple without names are one after the other.
fn shape(form: Form) -> Vec<usize> {
    match form {
        Form::Number => Vec::new(),
        Form::Matrix { rows, columns: 1 } => vec![rows],
        Form::Matrix { rows: 1, columns } => vec![columns],
        Form::Matrix { rows, columns } => vec![rows, columns],
        Form::Quaternion => vec![4],
        Form::Array { length, of } => [vec![length], shape(*of)].concat(),
        Form::Tuple(_) => vec![form.width()],
    }
}

/// What a system is made of, and the numbers of a row: the time, the configuration, the momentum, the energy, the conserved momenta.
#[derive(Clone, Debug)]
pub struct Layout {
    /// The name of the struct.
    pub name: &'static str,
    /// The derivation in words and formulas.
    pub derivation: &'static str,
    /// The order of a step.
    pub order: u32,
    /// Whether a state has a time.
    pub is_timed: bool,
    /// The parameters.
    pub parameters: Vec<Quantity>,
    /// The parts of the configuration.
    pub configuration: Vec<Quantity>,
    /// The momentum.
    pub momentum: Quantity,
    /// The input of the forces; of shape (0,) if they take none.
    pub input: Quantity,
    /// The conserved momenta.
    pub conserved: &'static [&'static str],
    /// The methods besides that of the declared dials.
    pub methods: &'static [&'static str],
}

impl Layout {
    /// The layout of a system with these parameters, conserved momenta and methods.
    pub fn of<S: Clebsch>(
        parameters: &[(&str, Form)],
        conserved: &'static [&'static str],
        methods: &'static [&'static str],
    ) -> Self {
        let mut configuration = Vec::new();
        let form = <S::Configuration as Columns<S::Scalar>>::FORM;
        each_value(S::CONFIGURATION_NAMES, form, &mut |name, form| configuration.push(Quantity::new(name, form)));
        let momentum = if configuration.iter().any(|part| part.name == "N") { "momentum" } else { "N" };
        Self {
            name: S::NAME,
            derivation: S::DERIVATION,
            order: S::ORDER,
            is_timed: size_of::<S::Time>() > 0,
            parameters: parameters.iter().map(|(name, form)| Quantity::new(name, *form)).collect(),
            configuration,
            momentum: Quantity::new(momentum, <S::Momentum as Columns<S::Scalar>>::FORM),
            input: Quantity::new("input", <S::Input as Columns<S::Scalar>>::FORM),
            conserved,
            methods,
        }
    }
}

/// The values with names of their own in a configuration.
fn each_value(names: Names, form: Form, visit: &mut impl FnMut(&'static str, Form)) {
    match (names, form) {
        (Names::One(name) | Names::Components(name), form) => visit(name, form),
        (Names::Each(names), Form::Tuple(forms)) => {
            names.iter().zip(forms).for_each(|(names, form)| each_value(*names, **form, visit));
        }
        // by construction: names nest as the configuration does
        (Names::Each(_), _) => {}
    }
}
