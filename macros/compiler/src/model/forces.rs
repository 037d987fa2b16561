//! Forces: the closures `force` and `force_on`, with the velocity and the input that they introduce.

use clebsch_symbolic::{Elements, Expr, Graph, IntoList, Role, Shape, indexed};

use super::arguments::sites_of;
use super::closures::{optional, written};
use super::features::{self, Feature, Found};
use super::sites;
use super::slots::{CHOSEN_FORCE, FORCE, Slot};
use super::space::{Space, column};
use super::spaces::{SpaceType, read_spaces};
use super::typed::{ActedSystem, Velocity};
use super::value::{Each, Value};
use super::{Factor, Force, LeafSpace};
use crate::diagnostic::{Diagnostics, error, refuse};
use crate::parse::{Argument, Closure, Declaration, shortened, tail};

/// A closure that has been read.
struct ReadForce<'g> {
    value: Vec<Expr<'g>>,
    velocities: Vec<Expr<'g>>,
    input: Option<Space<'g>>,
}

impl<'g> ActedSystem<'_, '_, 'g> {
    /// The forces, if there are any, with their input; `None` if a closure has an error, which was reported.
    pub fn forces(&mut self, declaration: &Declaration) -> Option<(Option<Force<'g>>, Space<'g>)> {
        let slots = if declaration.choice().is_some() { CHOSEN_FORCE } else { FORCE };
        let of_group = optional(declaration.force.as_ref(), |closure| self.force(closure, slots));
        let on_leaves = optional(declaration.force_on.as_ref(), |closure| self.force(closure, slots));
        let takes_input =
            |force: &Option<Option<ReadForce<'g>>>| force.iter().flatten().any(|read| read.input.is_some());
        if let Some(closure) = &declaration.force_on
            && takes_input(&of_group)
            && takes_input(&on_leaves)
        {
            let error = error!(closure.head, "both `force` and `force_on` take an input";
                help "let one of the two take all of the input, as a tuple if it has parts";
                note "a step has one input, `stepper.step_with(&state, &input)`");
            let help = declaration.choice().is_some().then_some(
                "if one of them is a reference, write it there without its type, which stands in the effort",
            );
            return self.context.diagnostics.refuse(error.maybe_help(help));
        }
        let (of_group, on_leaves) = of_group.zip(on_leaves)?;
        let mut all = of_group.iter().chain(&on_leaves);
        let velocities = all.clone().next().map(|read| read.velocities.clone());
        let input = all.find_map(|read| read.input.clone()).unwrap_or_else(Space::point);
        // both closures speak of one velocity, each under its own name
        let renamed = |read: &ReadForce<'g>| -> Vec<Expr<'g>> {
            let names: Vec<_> = read.velocities.iter().copied().zip(velocities.iter().flatten().copied()).into_list();
            read.value.each(|part| part.substitute(&names))
        };
        let closures = declaration.force.iter().chain(&declaration.force_on);
        let force = velocities.clone().map(|velocities| Force {
            of_group: of_group.as_ref().map(renamed),
            on_configuration: on_leaves.as_ref().map(renamed),
            velocities,
            written: closures.map(written).into_list(),
        });
        Some((force, input))
    }

    fn force(&mut self, closure: &Closure, slots: &'static [Slot]) -> Option<ReadForce<'g>> {
        let diagnostics = self.context.diagnostics;
        let matched = self.arguments.matched(closure, slots);
        let velocity = Velocity { graph: self.context.graph, factors: self.factors, diagnostics };
        let pattern = matched.argument(Slot::Velocity).map(|argument| &argument.pattern);
        let (value, velocities) = optional(pattern, |pattern| velocity.of(pattern, self.element))?.unzip();
        let unnamed = || indexed(self.factors.len(), |k| velocity.symbol(k, "velocity"));
        let velocities = velocities.unwrap_or_else(unnamed);
        let input = optional(matched.argument(Slot::Input), |argument| self.read_input(argument))?;
        let is_power = self.context.power.is_some();
        let has_own_inputs = self.context.power.as_ref().is_some_and(|power| power.has_own_inputs);
        let value = value.map(|own| own.of_each(Each::Motion, is_power));
        let of_input = input.as_ref().map(|input| input.value().of_each(Each::Input, has_own_inputs));
        let introduced = [(Slot::Velocity, value), (Slot::Input, of_input)];
        let mut scope = self.arguments.scope(&matched, &introduced);
        scope.set_velocities(&velocities, self.factors);
        let value = self.context.value(closure, scope)?;
        let value = self.of_site(closure, value)?;
        let value = if closure.key == "force" {
            self.components(closure, &value)?
        } else {
            let is = format!("a covector at `{}`, which has its shape", self.arguments.names.configuration.spell());
            self.space.leaves_of((&closure.key, &closure.body), &value, &is, diagnostics)?
        };
        value.iter().try_for_each(|part| self.check_every_site(closure, *part))?;
        Some(ReadForce { value, velocities, input })
    }

    /// The force on one site.
    fn of_site(&self, closure: &Closure, value: Value<'g>) -> Option<Value<'g>> {
        let value = sites::at_each(self.context.power.as_ref(), (value, &closure.body), "the force gives");
        self.context.diagnostics.take(value)
    }

    /// The force on a site of a power is one formula for all sites.
    fn check_every_site(&self, closure: &Closure, part: Expr<'g>) -> Option<()> {
        let Some(power) = &self.context.power else { return Some(()) };
        let Err(reason) = sites::of_every_site(part) else { return Some(()) };
        refuse!(self.context.diagnostics, tail(&closure.body), "the force on a site is the same formula for every site, and {reason}";
            help "read a field with one entry for each site, as in `self.strength[i]`";
            help "{}", sites::unrolled("force", &power.length))
    }

    /// The leaves of a typed argument: spaces of vectors.
    pub fn read_input(&mut self, argument: &Argument) -> Option<Space<'g>> {
        let diagnostics = self.context.diagnostics;
        let ty = argument.ty.as_ref()?;
        let own = self.context.power.as_mut().and_then(|power| {
            let (_, own) = sites_of(ty, self.names.generics).filter(|(length, _)| *length == power.length)?;
            power.has_own_inputs = true;
            Some(own)
        });
        let product = read_spaces(own.unwrap_or(ty), self.names)?;
        let is_other = |(leaf, _): &&(SpaceType, _)| leaf.space != LeafSpace::Vectors || leaf.is_quaternion;
        if let Some((_, ty)) = product.leaves.iter().find(is_other) {
            refuse!(diagnostics, *ty, "an input is made of vectors and matrices";
                help "write `u: Vector3`, or a tuple of such, `(torque, thrust): (Vector3, Vector1)`";
                note "forces are linear spaces: sums and multiples of inputs are inputs");
        }
        Space::new(self.context.graph, &argument.pattern, product, Role::Input, diagnostics)
    }

    /// The components of each factor: a vector, or a tuple with a vector for each block of its algebra, `(torque, force)` on SE(3).
    pub fn components(&self, closure: &Closure, value: &Value<'g>) -> Option<Vec<Expr<'g>>> {
        let leaf = |value: &Value<'g>, k: usize| {
            let factor = &self.factors[k];
            let shape = Shape::vector(factor.group.dimension());
            let vector = match value {
                Value::Matrix(expr) => Some(*expr).filter(|expr| expr.shape() == shape),
                Value::Tuple(values) => stacked(self.context.graph, factor, values),
                _ => None,
            };
            vector.ok_or_else(|| format!("{shape} for `{}`", factor.name))
        };
        let (found, needed) = match value.leaves(self.element, &leaf) {
            Ok(components) => return Some(components),
            Err(misfit) => misfit,
        };
        let (gives, has, is) = if closure.key == "controls" {
            ("the controls give", "they have", "a velocity in the group: it has the components of its Lie algebra")
        } else {
            ("the force gives", "it has", "a covector of the group: it has the components of the momentum")
        };
        let error = error!(tail(&closure.body), "{gives} {found}, but {has} to give {needed}";
            note "`{}` is {is}", shortened(&closure.body));
        let help = match self.factors {
            [factor] => column(Shape::vector(factor.group.dimension()), &closure.body, value),
            _ => None,
        };
        self.context.diagnostics.refuse(error.maybe_help(help))
    }
}

/// One vector from those of the blocks.
fn stacked<'g>(graph: &'g Graph, factor: &Factor<'g>, values: &[Value<'g>]) -> Option<Expr<'g>> {
    let (blocks, shape) = (graph.blocks(factor.group), Shape::vector(factor.group.dimension()));
    if blocks.len() != values.len() {
        return None;
    }
    blocks.iter().zip(values).try_fold(graph.zero(shape), |sum, (block, value)| {
        let part = value.matrix().filter(|part| part.shape() == Shape::vector(block.algebra.dimension))?;
        Some(sum + part.embed(shape, block.offset, 0))
    })
}

/// The dials that do not go with forces.
pub(super) fn check_dials(declaration: &Declaration, diagnostics: &Diagnostics) {
    let Some(force) = declaration.force.as_ref().or(declaration.force_on.as_ref()) else { return };
    let boundary = |feature| Found::when(feature == Feature::Boundary && declaration.dials.emit.boundary);
    diagnostics.extend(features::refusals_of((Feature::Forces, Found::at(force.head)), boundary));
}
