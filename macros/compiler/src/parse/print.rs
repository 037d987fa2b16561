//! The printed form of a declaration: one line for each key and field.

use std::fmt;

use super::{Declaration, Definition, Kinetic, Potential, spell, spell_type};

impl fmt::Display for Declaration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "declaration {}{}", self.ident, super::spelling::tokens(&self.generics))?;
        for group in &self.groups {
            match &group.definition {
                Definition::Equation(closure) => writeln!(f, "  group {} = {}", group.name, closure.spell())?,
                Definition::Basis(elements, _) => {
                    let elements: Vec<String> = elements.iter().map(spell).collect();
                    writeln!(f, "  group {} = basis([{}])", group.name, elements.join(", "))?;
                }
            }
        }
        writeln!(f, "  action     = {}", self.action.spell())?;
        match &self.kinetic {
            Kinetic::Cost(closure) => writeln!(f, "  cost       = {}", closure.spell())?,
            Kinetic::Lagrangian(closure) => writeln!(f, "  lagrangian = {}", closure.spell())?,
            Kinetic::Controls(closure) => writeln!(f, "  controls   = {}", closure.spell())?,
            Kinetic::Dynamics(closure) => writeln!(f, "  dynamics   = {}", closure.spell())?,
        }
        match &self.potential {
            Some(Potential::Closure(closure)) => writeln!(f, "  potential  = {}", closure.spell())?,
            Some(Potential::Opaque(opaque)) => writeln!(f, "  potential  = {}", opaque.spell())?,
            None => {}
        }
        for force in self.force.iter().chain(&self.force_on) {
            writeln!(f, "  {:<10} = {}", force.key.to_string(), force.spell())?;
        }
        if let Some(control) = &self.control {
            for closure in [&control.price].into_iter().chain(&control.bounds) {
                writeln!(f, "  {:<10} = {}", closure.key.to_string(), closure.spell())?;
            }
        }
        if let Some(endpoint) = &self.endpoint {
            writeln!(f, "  endpoint   = {}", endpoint.spell())?;
        }
        for symmetry in &self.symmetries {
            writeln!(f, "  symmetry   = {}", symmetry.spell())?;
        }
        for (name, value) in self.dials.given() {
            writeln!(f, "  {name:<10} = {value}")?;
        }
        for method in &self.methods {
            let dials: Vec<String> = method.dials.given().map(|(name, value)| format!("{name} = {value}")).collect();
            writeln!(f, "  method {} = ({})", method.name, dials.join(", "))?;
        }
        for field in &self.fields {
            let promise = field.promise.map(|(promise, _)| format!(", {promise:?}").to_lowercase()).unwrap_or_default();
            writeln!(f, "  field {}: {}{promise}", field.name(), spell_type(&field.ty))?;
        }
        Ok(())
    }
}
