//! The declarations of C.

use crate::interface::is_timed;
use crate::numbers::Real;
use crate::status::{MESSAGE, STATUSES};
use clebsch::{Clebsch, Columns, Form, Method, Names, State, Stepper};
use core::fmt::{self, Display, Formatter};

/// The header of an exported system, which it prints.
///
/// ```
/// # use clebsch::Clebsch;
/// # use clebsch_c::Header;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # pub struct Particle { mass: f64 }
/// clebsch_c::export!(particle: Particle { mass: f64 });
///
/// # fn main() {
/// let header: Header = particle::HEADER;
/// assert!(header.to_string().contains("typedef struct {\n    double x[1];\n    double N[1];\n} particle_numbers;"));
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Header {
    name: &'static str,
    scalar: &'static str,
    parameters: &'static [(&'static str, Form)],
    is_timed: bool,
    configuration: (Names, Form),
    momentum: Form,
    input: Form,
    stepper: usize,
    state: usize,
}

impl Header {
    /// The header of a system with these parameters, by a method.
    pub const fn new<S: Clebsch<Scalar: Real>, M: Method<S>>(
        name: &'static str,
        parameters: &'static [(&'static str, Form)],
    ) -> Self {
        Self {
            name,
            scalar: <S::Scalar as Real>::NAME,
            parameters,
            is_timed: is_timed::<S>(),
            configuration: (S::CONFIGURATION_NAMES, <S::Configuration as Columns<S::Scalar>>::FORM),
            momentum: <S::Momentum as Columns<S::Scalar>>::FORM,
            input: <<S as Clebsch>::Input as Columns<S::Scalar>>::FORM,
            stepper: size_of::<Stepper<S, M>>().next_multiple_of(8),
            state: size_of::<State<S, M>>().next_multiple_of(8),
        }
    }

    /// A struct of C from its fields.
    fn write_struct(
        &self,
        f: &mut Formatter<'_>,
        suffix: &str,
        fields: impl FnOnce(&mut Formatter<'_>) -> fmt::Result,
    ) -> fmt::Result {
        writeln!(f, "typedef struct {{")?;
        fields(f)?;
        writeln!(f, "}} {}_{suffix};\n", self.name)
    }

    /// Bytes that only the functions read.
    fn write_bytes(&self, f: &mut Formatter<'_>, suffix: &str, size: usize) -> fmt::Result {
        writeln!(f, "typedef union {{")?;
        writeln!(f, "    double alignment;\n    uint64_t another_alignment;\n    unsigned char bytes[{size}];")?;
        writeln!(f, "}} {}_{suffix};\n", self.name)
    }

    /// The fields of a value with these names.
    fn write_fields(&self, f: &mut Formatter<'_>, names: Names, form: Form) -> fmt::Result {
        match (names, form) {
            (Names::Each(names), Form::Tuple(forms)) => {
                names.iter().zip(forms).try_for_each(|(names, form)| self.write_fields(f, *names, **form))
            }
            (Names::One(name) | Names::Components(name), _) => write_field(f, self.scalar, &name, form, 1),
            (Names::Each(_), _) => Ok(()),
        }
    }
}

/// A field of a struct, with an indentation of so many levels.
fn write_field(f: &mut Formatter<'_>, scalar: &str, name: &dyn Display, form: Form, level: usize) -> fmt::Result {
    if form.width() == 0 {
        return Ok(());
    }
    let of = inner(form);
    write!(f, "{:1$}", "", 4 * level)?;
    match of {
        Form::Tuple(parts) => {
            writeln!(f, "struct {{")?;
            for (part, form) in parts.iter().enumerate() {
                write_field(f, scalar, &format_args!("_{part}"), **form, level + 1)?;
            }
            write!(f, "{:1$}}}", "", 4 * level)?;
        }
        _ => write!(f, "{scalar}")?,
    }
    write!(f, " {name}")?;
    write_sizes(f, form)?;
    writeln!(f, ";{}", if of == Form::Quaternion { " /* w, i, j, k */" } else { "" })
}

/// The form of an entry of arrays in arrays.
fn inner(form: Form) -> Form {
    if let Form::Array { of, .. } = form { inner(*of) } else { form }
}

/// The sizes of arrays and matrices, from the outside in.
fn write_sizes(f: &mut Formatter<'_>, form: Form) -> fmt::Result {
    match form {
        Form::Number | Form::Tuple(_) => Ok(()),
        Form::Quaternion => write!(f, "[4]"),
        Form::Matrix { rows, columns } if rows == 1 || columns == 1 => write!(f, "[{}]", rows * columns),
        Form::Matrix { rows, columns } => write!(f, "[{rows}][{columns}]"),
        Form::Array { length, of } => {
            write!(f, "[{length}]")?;
            write_sizes(f, *of)
        }
    }
}

/// Whether a name is among those of a value.
fn has_name(names: Names, name: &str) -> bool {
    match names {
        Names::One(own) | Names::Components(own) => own == name,
        Names::Each(parts) => parts.iter().any(|part| has_name(*part, name)),
    }
}

impl Display for Header {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { name, scalar, .. } = self;
        writeln!(f, "/* Made by clebsch-c. Arrays of matrices are by rows. */")?;
        writeln!(f, "#pragma once\n\n#include <stddef.h>\n#include <stdint.h>\n")?;
        writeln!(f, "#ifdef __cplusplus\nextern \"C\" {{\n#endif\n")?;
        writeln!(f, "#ifndef CLEBSCH_STATUS\n#define CLEBSCH_STATUS\n\n/* How a call ended. */\nenum {{")?;
        for (name, number, meaning) in STATUSES {
            writeln!(f, "    /*{meaning} */\n    CLEBSCH_{name} = {number},")?;
        }
        writeln!(
            f,
            "}};\n\n/* A text in UTF-8. */\ntypedef struct {{\n    char text[{MESSAGE}];\n}} clebsch_message;\n\n#endif\n"
        )?;

        writeln!(f, "/* The parameters of the system. */")?;
        self.write_struct(f, "parameters", |f| {
            if self.parameters.is_empty() {
                writeln!(f, "    char none;")?;
            }
            self.parameters.iter().try_for_each(|(name, form)| write_field(f, scalar, name, *form, 1))
        })?;
        let momentum = if has_name(self.configuration.0, "N") { "momentum" } else { "N" };
        writeln!(
            f,
            "/* A state in numbers: {}the configuration, and the momentum. */",
            if self.is_timed { "the time, " } else { "" }
        )?;
        self.write_struct(f, "numbers", |f| {
            if self.is_timed {
                writeln!(f, "    {scalar} t;")?;
            }
            self.write_fields(f, self.configuration.0, self.configuration.1)?;
            write_field(f, scalar, &momentum, self.momentum, 1)
        })?;
        writeln!(f, "/* An impulse, in the components of the momentum. */")?;
        self.write_struct(f, "impulse", |f| write_field(f, scalar, &momentum, self.momentum, 1))?;
        writeln!(f, "/* The input of the forces. */")?;
        self.write_struct(f, "input", |f| match self.input.width() {
            0 => writeln!(f, "    char none;"),
            _ => write_field(f, scalar, &"u", self.input, 1),
        })?;
        writeln!(
            f,
            "/* A stepper and a state. Only the functions read their bytes. Copies are made by assignment. */"
        )?;
        self.write_bytes(f, "stepper", self.stepper)?;
        self.write_bytes(f, "state", self.state)?;
        let functions: [(&str, &str, &[&str]); 9] = [
            (
                "make",
                "Makes a stepper; size is sizeof(*stepper).",
                &["@stepper *stepper", "size_t size", "const @parameters *parameters", "# step_size"],
            ),
            (
                "start",
                "Makes a state and checks it; size is sizeof(*state).",
                &["const @stepper *stepper", "@state *state", "size_t size", "const @numbers *numbers"],
            ),
            (
                "step",
                "Makes a step. After an error the state is unchanged.",
                &["const @stepper *stepper", "@state *state"],
            ),
            (
                "step_with",
                "Makes a step with an input of the forces.",
                &["const @stepper *stepper", "@state *state", "const @input *input"],
            ),
            (
                "advance",
                "Makes so many steps. After an error the state is unchanged.",
                &["const @stepper *stepper", "@state *state", "size_t steps"],
            ),
            (
                "kick",
                "Adds an impulse to the momentum.",
                &["const @stepper *stepper", "@state *state", "const @impulse *impulse"],
            ),
            ("read", "Writes the numbers of a state.", &["const @state *state", "@numbers *numbers"]),
            (
                "energy",
                "Writes the energy of a state.",
                &["const @stepper *stepper", "const @state *state", "# *energy"],
            ),
            (
                "explain",
                "Writes the first error of a stepper, a state and a step with these numbers, and returns its status. \
                 Numbers and input may be null.",
                &[
                    "const @parameters *parameters",
                    "# step_size",
                    "const @numbers *numbers",
                    "const @input *input",
                    "clebsch_message *message",
                ],
            ),
        ];
        for (function, about, arguments) in functions {
            write!(f, "/* {about} */\nint32_t {name}_{function}(")?;
            for (index, argument) in arguments.iter().enumerate() {
                f.write_str(if index == 0 { "" } else { ", " })?;
                let (before, after) = argument.split_once('@').unwrap_or((argument, ""));
                match argument.strip_prefix('#') {
                    Some(after) => write!(f, "{scalar}{after}")?,
                    None if after.is_empty() => f.write_str(before)?,
                    None => write!(f, "{before}{name}_{after}")?,
                }
            }
            writeln!(f, ");\n")?;
        }
        writeln!(f, "#ifdef __cplusplus\n}}\n#endif")
    }
}
