//! The closures as a whole: what each of them gives, and what it has to give.

use clebsch_symbolic::{Expr, Group, Property, Role, Shape};
use syn::{BinOp, Expr as Syntax, Stmt};

use super::arguments::Arguments;
use super::elaborate::{Context, Elaborator, shortened};
use super::value::Value;
use super::{Configuration, Discretization, Factor, Kinetic, Spans, Structure, Written};
use crate::diagnostic::{Diagnostic, Diagnostics, Place};
use crate::parse::{self, Closure, Declaration, Pattern, spell};

/// Φ_F(q), leaf by leaf.
pub(super) fn action<'g>(
    context: &mut Context<'_, 'g>,
    declaration: &Declaration,
    arguments: &Arguments<'_, 'g>,
    structure: &Structure,
    configurations: Option<&[Configuration<'g>]>,
) -> Option<Vec<Expr<'g>>> {
    let closure = &declaration.action;
    let scope = arguments.action_scope(&mut context.diagnostics);
    let value = Elaborator::new(context, "action", scope).elaborate(&closure.body)?;
    let configurations = configurations?;
    let mut leaves = Vec::new();
    let fits = flatten(&value, structure, configurations, &mut leaves);
    if let Err((found, expected)) = fits {
        let body = shortened(&spell(&closure.body));
        let message = format!("the action gives {found}, but it has to give {expected}");
        let error = Diagnostic::new(tail(&closure.body).0, message).note(format!(
            "`{body}` is the new value of `{}`, which has the shape of the old one",
            arguments.configuration.spell()
        ));
        context.diagnostics.push(error);
        return None;
    }
    Some(leaves)
}

/// Takes a value apart as the configuration nests, or says what was found and what was expected.
fn flatten<'g>(
    value: &Value<'g>,
    structure: &Structure,
    configurations: &[Configuration<'g>],
    leaves: &mut Vec<Expr<'g>>,
) -> Result<(), (String, String)> {
    match (value, structure) {
        (Value::Matrix(expr), Structure::Leaf(leaf)) if expr.shape() == configurations[*leaf].shape => {
            leaves.push(*expr);
            Ok(())
        }
        (Value::Identity(scale), Structure::Leaf(leaf)) if configurations[*leaf].shape.is_square() => {
            leaves.push(*scale * scale.graph().identity(configurations[*leaf].shape.rows));
            Ok(())
        }
        (Value::Tuple(values), Structure::Tuple(parts)) | (Value::Array(values), Structure::Array(parts))
            if values.len() == parts.len() =>
        {
            values.iter().zip(parts).try_for_each(|(value, part)| flatten(value, part, configurations, leaves))
        }
        (value, Structure::Leaf(leaf)) => {
            let Configuration { name, shape, .. } = &configurations[*leaf];
            Err((value.describe(), format!("{shape} for `{name}`")))
        }
        (value, Structure::Tuple(parts)) => Err((value.describe(), format!("a tuple of {}", parts.len()))),
        (value, Structure::Array(parts)) => Err((value.describe(), format!("an array of {}", parts.len()))),
    }
}

/// The cost, or the Lagrangian with its velocity.
pub(super) fn kinetic<'g>(
    context: &mut Context<'_, 'g>,
    declaration: &Declaration,
    arguments: &Arguments<'_, 'g>,
    factors: Option<&[Factor<'g>]>,
) -> Option<Kinetic<'g>> {
    match &declaration.kinetic {
        parse::Kinetic::Cost(closure) => cost(context, closure, arguments, factors),
        parse::Kinetic::Lagrangian(closure) => {
            let discretization = declaration.dials.discretization.as_ref();
            let discretization = discretization.map_or(Discretization::Cayley, |discretization| discretization.value);
            lagrangian(context, closure, arguments, factors, discretization)
        }
    }
}

fn cost<'g>(
    context: &mut Context<'_, 'g>,
    closure: &Closure,
    arguments: &Arguments<'_, 'g>,
    factors: Option<&[Factor<'g>]>,
) -> Option<Kinetic<'g>> {
    let scope = arguments.cost_scope(closure, &mut context.diagnostics);
    let cost = scalar(context, closure, Elaborated { scope, needs: "a discrete Lagrangian is a scalar" })?;
    for factor in factors? {
        if !cost.depends_on(factor.symbol) {
            let message = format!("the cost does not depend on `{}`", factor.name);
            let error = Diagnostic::new(tail(&closure.body).0, message)
                .help(format!("add the kinetic energy of `{}`, as in `{}`", factor.name, example_cost(factor)))
                .note(format!(
                    "the momentum of `{}` is the derivative of the cost, and cannot be inverted where that is 0",
                    factor.name
                ));
            context.diagnostics.push(error);
        }
    }
    Some(Kinetic::Cost(cost))
}

fn example_cost(factor: &Factor) -> String {
    match factor.group {
        Group::Translation(_) => format!("self.mass * {}.norm_squared() / (2 * h)", factor.name),
        _ => format!("self.mass * ({} - I).norm_squared() / (4 * h)", factor.name),
    }
}

fn lagrangian<'g>(
    context: &mut Context<'_, 'g>,
    closure: &Closure,
    arguments: &Arguments<'_, 'g>,
    factors: Option<&[Factor<'g>]>,
    discretization: Discretization,
) -> Option<Kinetic<'g>> {
    let name = closure.arguments.last().map(|argument| argument.pattern.spell()).unwrap_or_default();
    let velocity = match factors {
        Some([Factor { group: Group::SpecialOrthogonal(3), .. }]) => {
            Some(context.graph.symbol(&name, Shape::vector(3), Role::Algebra(0), Property::General))
        }
        Some(factors) => {
            let groups: Vec<String> = factors.iter().map(|factor| factor.group.name()).collect();
            let what = format!("a lagrangian on {}", groups.join(" x "));
            let error = Diagnostic::later(closure.key.span(), what)
                .help("declare a `cost`, the discrete kinetic energy, instead");
            context.diagnostics.push(error);
            None
        }
        None => None,
    };
    let scope = arguments.lagrangian_scope(closure, velocity, &mut context.diagnostics);
    let energy = scalar(context, closure, Elaborated { scope, needs: "a Lagrangian is a scalar" })?;
    let velocity = velocity?;
    if !energy.depends_on(velocity) {
        let error =
            Diagnostic::new(tail(&closure.body).0, format!("the lagrangian does not depend on the velocity `{name}`"));
        context
            .diagnostics
            .push(error.help(format!("add the kinetic energy, as in `{name}.dot(&(self.inertia * {name})) / 2`")));
        return None;
    }
    Some(Kinetic::Lagrangian { energy, velocity, name, discretization })
}

/// V(q).
pub(super) fn potential<'g>(
    context: &mut Context<'_, 'g>,
    declaration: &Declaration,
    arguments: &Arguments<'_, 'g>,
) -> Option<Expr<'g>> {
    let closure = declaration.potential.as_ref()?;
    let scope = arguments.potential_scope(closure, &mut context.diagnostics);
    scalar(context, closure, Elaborated { scope, needs: "an energy is a scalar" })
}

/// What a scalar closure is elaborated with.
struct Elaborated<'g> {
    scope: super::scope::Scope<'g>,
    needs: &'static str,
}

/// The value of a closure that has to give a scalar.
fn scalar<'g>(context: &mut Context<'_, 'g>, closure: &Closure, given: Elaborated<'g>) -> Option<Expr<'g>> {
    let key = closure.key.to_string();
    let mut elaborator = Elaborator::new(context, &key, given.scope);
    let value = elaborator.elaborate(&closure.body)?;
    if let Some(expr) = value.matrix().filter(|expr| expr.shape().is_scalar()) {
        return Some(expr);
    }
    let (place, tail) = tail(&closure.body);
    let error = Diagnostic::new(place, format!("the {key} is {}, but {}", value.describe(), given.needs));
    let help = to_scalar(tail, &value);
    let reason = elaborator.quietly(|elaborator| because(elaborator, tail, &value));
    let error = error.maybe_help(help);
    context.diagnostics.push(match reason {
        Some(reason) => error.note(reason),
        None => error,
    });
    None
}

/// How a scalar is made from a value.
fn to_scalar(tail: &Syntax, value: &Value) -> Option<String> {
    let text = match tail {
        Syntax::Binary(_) | Syntax::Unary(_) => format!("({})", spell(tail)),
        _ => spell(tail),
    };
    match value {
        Value::Matrix(expr) if expr.shape() == Shape::vector(3) => Some(format!("take a component, as in `{text}.z`")),
        Value::Matrix(expr) if expr.shape().is_column() => Some(format!("take a component, as in `{text}[0]`")),
        Value::Matrix(expr) if expr.shape().is_square() => Some(format!("take the trace, as in `{text}.trace()`")),
        Value::Matrix(_) => Some(format!("take an entry, as in `{text}[(0, 0)]`")),
        Value::Array(_) => Some(format!("add its entries, as in `{text}.sum()`")),
        _ => None,
    }
}

/// Why a product has its shape. `let`s of a block are out of scope here, and then there is no reason.
fn because<'g>(elaborator: &mut Elaborator<'_, '_, 'g>, tail: &Syntax, value: &Value<'g>) -> Option<String> {
    let Syntax::Binary(product) = tail else { return None };
    if !matches!(product.op, BinOp::Mul(_)) {
        return None;
    }
    let left = elaborator.elaborate(&product.left)?;
    let right = elaborator.elaborate(&product.right)?;
    left.shape()?;
    right.shape()?;
    let (a, b) = (spell(&product.left), spell(&product.right));
    Some(format!(
        "`{}` is {} because `{a}` is {} and `{b}` is {}",
        spell(tail),
        value.describe(),
        left.describe(),
        right.describe()
    ))
}

/// The expression that gives a body its value, and where it is.
fn tail(body: &Syntax) -> (Place, &Syntax) {
    match body {
        Syntax::Block(block) => match block.block.stmts.last() {
            Some(Stmt::Expr(value, None)) => tail(value),
            _ => (Place::of(body), body),
        },
        Syntax::Paren(inner) => tail(&inner.expr),
        Syntax::Group(inner) => tail(&inner.expr),
        _ => (Place::of(body), body),
    }
}

/// The name of each leaf: the pattern's names, with accessors where one name stands for several leaves.
pub(super) fn leaf_names(
    pattern: &Pattern,
    structure: &Structure,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<String>> {
    match (pattern, structure) {
        (Pattern::Name(ident), _) => {
            let name = syn::ext::IdentExt::unraw(ident).to_string();
            Some(structure.accessors().into_iter().map(|accessor| format!("{name}{accessor}")).collect())
        }
        (Pattern::Tuple(patterns, _), Structure::Tuple(parts)) if patterns.len() == parts.len() => {
            let names: Option<Vec<Vec<String>>> =
                patterns.iter().zip(parts).map(|(pattern, part)| leaf_names(pattern, part, diagnostics)).collect();
            names.map(|names| names.into_iter().flatten().collect())
        }
        (Pattern::Tuple(patterns, place), structure) => {
            let is = match structure {
                Structure::Leaf(_) => "no tuple".to_string(),
                Structure::Tuple(parts) => format!("a tuple of {}", parts.len()),
                Structure::Array(parts) => format!("an array of {}", parts.len()),
            };
            let message = format!("`{}` has {} names, but its type is {is}", pattern.spell(), patterns.len());
            diagnostics
                .push(Diagnostic::new(*place, message).help("write one name, or as many as the tuple has parts"));
            None
        }
    }
}

/// The bodies as they were written.
pub(super) fn spans(declaration: &Declaration) -> Spans {
    let written = |closure: &Closure| Written {
        place: Place::of(&closure.body),
        text: spell(&closure.body),
        arguments: closure.spell_head(),
    };
    Spans {
        action: written(&declaration.action),
        kinetic: written(declaration.kinetic.closure()),
        potential: declaration.potential.as_ref().map(written),
    }
}
