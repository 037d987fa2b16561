//! The end of every expansion: within a budget of work, or with an error that says so. A panic of ours becomes an error
//! too.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

use clebsch_symbolic::work::{self, Exhausted};
use clebsch_symbolic::{Graph, IntoList};
use proc_macro2::{Span, TokenStream, TokenTree};
use syn::{Expr, Type};

use crate::diagnostic::{Diagnostic, Diagnostics, Location, error};
use crate::model::ByNumber;
use crate::parse::{ChartChoice, Closure, CodeForm, Declaration, Discretization, Kinetic, Located, Order, Potential};

/// The work of one expansion, for each of its methods: about a second where nothing is optimised, as in a crate of a user. A unit is up to a
/// quarter of a microsecond there. Fixtures of the tests take up to a quarter of the budget, and the largest scenes two thirds.
pub const WORK: u64 = 3_300_000;

/// The stages behind the first one.
#[derive(Copy, Clone, PartialEq, Eq)]
pub(crate) enum CompilerStage {
    Model,
    Derive,
    Lower,
    Emit,
}

/// Where an expansion is.
pub(crate) type Stage = Cell<CompilerStage>;

/// Runs the stages behind the first one, which say where they are, on the budget of one expansion.
///
/// # Errors
/// Those of the stages, and one that names the declaration too large.
pub(crate) fn within<T>(
    declaration: &Declaration,
    stages: impl FnOnce(&Stage) -> Result<T, Diagnostics>,
) -> Result<T, Diagnostics> {
    let stage = Cell::new(CompilerStage::Model);
    let programs = 1 + declaration.methods.len() as u64;
    work::within(programs * WORK, || stages(&stage))
        .unwrap_or_else(|Exhausted| Err(too_large(declaration, stage.get()).into()))
}

/// The error for a declaration on which the budget was used up.
fn too_large(declaration: &Declaration, stage: CompilerStage) -> Diagnostic {
    let kinetic = &declaration.kinetic.closure().body;
    let others = Others { declaration, left: Cell::new(WORK / 6) };
    let (place, what, instead) = others.culprit().unwrap_or_else(|| {
        let (body, what) = match stage {
            CompilerStage::Model => (&declaration.action.body, "the laws of this action take"),
            CompilerStage::Derive => (kinetic, "the formulas that are derived from this take"),
            CompilerStage::Lower => (kinetic, "the code of a step with this takes"),
            CompilerStage::Emit => (kinetic, "the text of a step with this takes"),
        };
        let less = "use a smaller group or fewer factors, or a struct for each part that moves by itself";
        (body.into(), what.to_string(), less)
    });
    let mut error = error!(place, "`{}` is too large to expand: {what} more than {WORK} terms", declaration.ident);
    for text in others.smaller() {
        error = error.help(text);
    }
    let no_sites = others.no_sites();
    // advice about a const generic is none for a number
    let of_number = |help: &&str| !help.contains("const generic");
    let cure = no_sites.as_ref().and_then(|reason| reason.first_help()).filter(of_number);
    let error = error.help(cure.unwrap_or(instead));
    let error = match &no_sites {
        Some(reason) => error.note(format!("its sites are not stepped in loops: {}", reason.message())),
        None => error,
    };
    error.note("formulas are expanded at compile time, and products of sums get a term for each pair of terms")
}

/// A change of a declaration.
type Change = fn(&mut Declaration);

/// Declarations next to one that is too large.
struct Others<'a> {
    declaration: &'a Declaration,
    /// The work that may be spent on all of them yet.
    left: Cell<u64>,
}

impl Others<'_> {
    /// Whether the work that is left is enough for the declaration with a change.
    fn is_small(&self, change: Change) -> bool {
        let mut other = self.declaration.clone();
        change(&mut other);
        other.methods.clear();
        let before = work::spent();
        let stages = || crate::program(&Graph::new(), &other, &Cell::new(CompilerStage::Model)).is_ok();
        let is_small = work::within(self.left.get(), stages) == Ok(true);
        self.left.set(self.left.get().saturating_sub(work::spent() - before));
        is_small
    }

    /// The closure that makes the declaration large, and its replacement. It is the first optional closure without which the
    /// declaration is small.
    fn culprit(&self) -> Option<(Location, String, &'static str)> {
        let declaration = self.declaration;
        let potential = declaration.potential.as_ref().and_then(Potential::closure);
        const METHODS: &str = "write a shorter potential, or methods for its value and gradient: `potential = opaque(Self::value, Self::gradient)`";
        const CONSTRAINT: &str = "write a shorter constraint, with parts of it as fields";
        let rows: [(Option<&Closure>, Change, &str, &str); 6] = [
            (declaration.endpoint.as_ref(), |rest| rest.endpoint = None, "price", "write a shorter price of the end"),
            (declaration.target.as_ref(), |rest| rest.target = None, "target", "write shorter conditions of the end"),
            (potential, |rest| rest.potential = None, "potential", METHODS),
            (declaration.force.as_ref(), |rest| rest.force = None, "force", SHORTER_FORCE),
            (declaration.force_on.as_ref(), |rest| rest.force_on = None, "force", SHORTER_FORCE),
            (declaration.constraints.first(), |rest| rest.constraints.clear(), "constraint", CONSTRAINT),
        ];
        rows.into_iter().find_map(|(closure, without, what, instead)| {
            let closure = closure.filter(|_| self.is_small(without))?;
            Some((Location::from(&closure.body), format!("the formulas of this {what} take"), instead))
        })
    }

    /// The changes of dials that make the declaration small. Each was tried.
    fn smaller(&self) -> Vec<&'static str> {
        let dials = &self.declaration.dials;
        let chart = dials.chart.as_ref().map(|chart| chart.value);
        let discretization = dials.discretization.as_ref().map(|discretization| discretization.value);
        let is_other_lagrangian = matches!(self.declaration.kinetic, Kinetic::Lagrangian(_))
            && discretization != Some(Discretization::Exponential);
        let is_high = dials.order.as_ref().is_some_and(|order| !matches!(order.value, Order::First | Order::Second));
        // with a const generic it is in loops already
        let is_written_out = |ty: &Type| matches!(ty, Type::Array(array) if matches!(array.len, Expr::Lit(_)));
        let mut types = self.declaration.action.arguments.iter().filter_map(|argument| argument.ty.as_ref());
        let is_product = types.any(is_written_out);
        let is_unrolled = dials.code.as_ref().is_some_and(|code| code.value == CodeForm::Unrolled);
        let rows: [(bool, Change, &str); 5] = [
            (
                is_unrolled,
                |other| other.dials.code = None,
                "leave out `code = unrolled`: then long code has a shorter form",
            ),
            (
                dials.emit.tangent,
                |other| other.dials.emit.tangent = false,
                "leave `tangent` out of `emit`: it takes second derivatives of everything",
            ),
            (
                chart == Some(ChartChoice::Exponential),
                |other| other.dials.chart = None,
                "leave out `chart = exponential`: formulas in Cayley's are shorter",
            ),
            (
                is_other_lagrangian,
                |other| other.dials.discretization = Some(exponential()),
                "write `discretization = exponential`, whose formulas are shorter",
            ),
            (is_high, |other| other.dials.order = None, "write `order = 2`"),
        ];
        let tried =
            rows.into_iter().filter_map(|(applies, change, text)| (applies && self.is_small(change)).then_some(text));
        let in_loops = is_product && !crate::model::may_be_sites(self.declaration);
        in_loops.then_some(crate::model::IN_LOOPS).into_iter().chain(tried).into_list()
    }

    /// Why the sites of a product by a number are not stepped in loops.
    fn no_sites(&self) -> Option<Diagnostic> {
        let declaration = self.declaration;
        let is_by_number = declaration.methods.is_empty() && crate::model::may_be_sites(declaration);
        let graph = Graph::new();
        let by_sites = || {
            let model = crate::model::model(&graph, declaration, ByNumber::Sites)?;
            crate::derive::derive(model).map(|_| ())
        };
        let tried = is_by_number.then(|| work::within(WORK / 12, by_sites))?;
        tried.ok()?.err()?.into_iter().next()
    }
}

fn exponential() -> Located<Discretization> {
    Located { value: Discretization::Exponential, span: Span::call_site() }
}

const SHORTER_FORCE: &str = "write a shorter force, or put the part of it that is long into the input";

/// The result, or the error that a panic of ours becomes. It is our fault, but shows at the user's item.
///
/// # Errors
/// Where it panics.
pub(crate) fn without_panic<T>(item: &TokenStream, make: impl FnOnce() -> T) -> Result<T, Diagnostics> {
    catch_unwind(AssertUnwindSafe(make)).map_err(|payload| {
        let text = payload.downcast_ref::<String>().map(String::as_str).or(payload.downcast_ref::<&str>().copied());
        let error = error!(name(item), "this declaration has found a bug in clebsch: {}", text.unwrap_or("a panic");
            help "report it with the declaration, which need not be right: any declaration is to have an integrator or an error that helps");
        error.into()
    })
}

/// The name of an item; its first token where it has none.
fn name(item: &TokenStream) -> Span {
    let mut tokens = item.clone().into_iter().skip_while(|token| {
        !matches!(token, TokenTree::Ident(word) if ["struct", "enum", "union"].iter().any(|keyword| word == keyword))
    });
    let keyword = tokens.next();
    let found = tokens.next().or(keyword).or_else(|| item.clone().into_iter().next());
    found.map_or_else(Span::call_site, |token| token.span())
}

#[cfg(test)]
mod tests;
