//! The printed form of a model: a line for each parameter, factor, configuration and formula.

use std::fmt;

use clebsch_symbolic::Group;

use super::scalar::spell_scalar;
use super::{
    BoundKind, Condition, FieldEnergies, Isotropy, Joint, Kinetic, LeafSpace, Mechanics, Model, Motion,
    OfferedSymmetry, Order, Parameter, Side, Signature, Steered, System, VelocityRows,
};
use crate::parse::joined;

impl fmt::Display for Model<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Model::Mechanics(model) => write!(f, "{model}"),
            Model::Steered(model) => write!(f, "{model}"),
        }
    }
}

impl fmt::Display for Mechanics<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let scalar = spell_scalar(&self.item.scalar);
        match &self.power {
            Some(power) => writeln!(f, "model {} over {scalar}, {} times", power.item.ident, power.length)?,
            None => writeln!(f, "model {} over {scalar}", self.item.ident)?,
        }
        self.system.print_action(f)?;
        match &self.kinetic {
            Kinetic::Cost(cost) => writeln!(f, "  cost       {cost}")?,
            Kinetic::Lagrangian { energy, name, discretization, .. } => {
                writeln!(f, "  lagrangian {energy} of {name}, by {discretization}")?;
            }
        }
        match self.potential {
            Some(potential) => writeln!(f, "  potential  {potential}")?,
            None if self.power.as_ref().is_some_and(|power| !power.terms.is_empty()) => {}
            None if self.field.is_some() => {}
            None => writeln!(f, "  potential  none")?,
        }
        if let Some(power) = &self.power {
            power.parameters.iter().try_for_each(|parameter| write!(f, "{parameter}"))?;
            for term in &power.terms {
                let indices = term.indices();
                let indices = if indices.is_empty() { indices } else { format!(", for {indices}") };
                writeln!(f, "  term       {}{indices}", term.value)?;
            }
            for Joint { term, .. } in power.joints.iter().flat_map(|joints| &joints.all) {
                let indices = term.indices();
                let indices = if indices.is_empty() { indices } else { format!(", for {indices}") };
                writeln!(f, "  constraint {} = 0{indices}", term.value)?;
            }
        }
        if let Some(FieldEnergies { edges, potential, .. }) = &self.field {
            potential.iter().try_for_each(|potential| writeln!(f, "  potential  {potential}"))?;
            edges.iter().try_for_each(|edge| writeln!(f, "  edge       {}", edge.value))?;
        }
        if let Some(force) = &self.force {
            force.of_group.iter().flatten().try_for_each(|part| writeln!(f, "  force      {part}"))?;
            force.on_configuration.iter().flatten().try_for_each(|part| writeln!(f, "  force on   {part}"))?;
        }
        if let Some(constraint) = &self.constraint {
            constraint.places.iter().try_for_each(|places| writeln!(f, "  constraint {places} = 0"))?;
            let mut velocities = constraint.velocities.iter();
            velocities
                .try_for_each(|VelocityRows { rows, values }| writeln!(f, "  constraint {rows} * xi = {values}"))?;
        }
        self.system.print_inputs(f)?;
        if self.power.as_ref().is_some_and(|power| power.has_own_inputs) {
            writeln!(f, "  inputs     one for each site")?;
        }
        for OfferedSymmetry { group, name, side, configurations, elements, .. } in &self.symmetries {
            let images = joined(configurations.iter().chain(elements));
            writeln!(f, "  symmetry {name}: {}, {side}: {images}", group.name(self.graph))?;
        }
        if self.isotropy == Isotropy::Free {
            writeln!(f, "  isotropy   {}", self.isotropy)?;
        }
        if self.signature == Signature::Indefinite {
            writeln!(f, "  signature  {}", self.signature)?;
        }
        self.system.print_dials(f)?;
        writeln!(f, "  order      {}", self.declared_order())
    }
}

impl fmt::Display for Steered<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "model {} over {}", self.item.ident, spell_scalar(&self.item.scalar))?;
        self.system.print_action(f)?;
        match &self.motion {
            Motion::Controls { velocity, discretization } => {
                velocity.iter().try_for_each(|part| writeln!(f, "  controls   {part}, by {discretization}"))?;
            }
            Motion::Dynamics { from: Some((rate, method)), .. } => writeln!(f, "  dynamics   {method} of {rate}")?,
            Motion::Dynamics { next, .. } => next.iter().try_for_each(|part| writeln!(f, "  dynamics   {part}"))?,
        }
        self.system.print_inputs(f)?;
        self.system.print_dials(f)
    }
}

impl System<'_> {
    fn print_action(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = |group: Group| group.name(self.graph);
        self.parameters.iter().try_for_each(|parameter| write!(f, "{parameter}"))?;
        self.constants.iter().try_for_each(|constant| writeln!(f, "  constant {}", constant.symbol))?;
        for factor in &self.factors {
            let side = if factor.moves { factor.side.to_string() } else { "moves nothing".to_string() };
            writeln!(f, "  factor {}: {}, {side}", factor.name, name(factor.group))?;
        }
        for leaf in &self.configurations {
            let space = match leaf.space {
                LeafSpace::Vectors => String::new(),
                LeafSpace::Unit => ", unit".to_string(),
                LeafSpace::Symmetric => ", symmetric".to_string(),
                LeafSpace::Projector(rank) => format!(", projector of rank {rank}"),
                LeafSpace::Orthonormal => ", orthonormal columns".to_string(),
                LeafSpace::Group(group) => format!(" in {}", name(group)),
            };
            writeln!(f, "  configuration {}: {}{space}", leaf.name, leaf.shape)?;
        }
        let mut images = self.configurations.iter().zip(&self.action);
        images.try_for_each(|(leaf, image)| writeln!(f, "  action     {} -> {image}", leaf.name))
    }

    fn print_inputs(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.chosen().iter().try_for_each(|leaf| writeln!(f, "  input      {}: {}", leaf.name, leaf.shape))?;
        let referred = [("reference", &self.reference.1), ("at the end", &self.end_reference.1)];
        for (name, leaf) in referred.into_iter().flat_map(|(name, leaves)| leaves.iter().map(move |leaf| (name, leaf)))
        {
            writeln!(f, "  {name:<10} {}: {}", leaf.name, leaf.shape)?;
        }
        if let Some(control) = &self.control {
            writeln!(f, "  price      {}", control.price)?;
            control.bounds.iter().try_for_each(|bound| match bound.kind {
                BoundKind::Equation => writeln!(f, "  equation   {} = 0", bound.value),
                BoundKind::Inequality => writeln!(f, "  bound      {} <= 0", bound.value),
                BoundKind::Soft(price) => writeln!(f, "  soft bound {} <= 0, else {price} times it", bound.value),
            })?;
        }
        self.endpoint.iter().try_for_each(|price| writeln!(f, "  endpoint   {}", price.value))?;
        let conditions = self.target.iter().flat_map(|target| &target.conditions);
        conditions.into_iter().try_for_each(|Condition { left, right, is_equation, .. }| {
            writeln!(f, "  target     {} {} 0", *left - *right, if *is_equation { "=" } else { "<=" })
        })
    }

    fn print_dials(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.dials.given().into_iter().try_for_each(|(name, value)| writeln!(f, "  {name:<10} {}", value.value))
    }
}

impl fmt::Display for Parameter<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for leaf in &self.leaves {
            let shape = if leaf.is_scalar { "scalar".to_string() } else { leaf.shape.to_string() };
            let promise = self.promise.map(|promise| format!(", {promise}")).unwrap_or_default();
            writeln!(f, "  parameter {}: {shape}{promise}", leaf.symbol)?;
        }
        Ok(())
    }
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if *self == Side::Left { "left" } else { "right" })
    }
}

impl fmt::Display for Order {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.number())
    }
}
