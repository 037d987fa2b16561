//! The printed form of a declaration: one line for each key and field.

use std::fmt;

use super::{Closure, Declaration, DeclaredGroup, Definition, Potential, joined, spell, spell_type};

impl fmt::Display for Declaration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "declaration {}{}", self.ident, super::spelling::tokens(&self.generics))?;
        for DeclaredGroup { name, definition } in &self.groups {
            match definition {
                Definition::Equation(closure) => writeln!(f, "  group {name} = {}", closure.spell())?,
                Definition::Basis(elements, _) => {
                    writeln!(f, "  group {name} = basis([{}])", joined(elements.iter().map(spell)))?;
                }
            }
        }
        let entry = |f: &mut fmt::Formatter<'_>, closure: &Closure| {
            writeln!(f, "  {:<10} = {}", closure.key.to_string(), closure.spell())
        };
        entry(f, &self.action)?;
        entry(f, self.kinetic.closure())?;
        match &self.potential {
            Some(Potential::Closure(closure)) => entry(f, closure)?,
            Some(Potential::Opaque(opaque)) => writeln!(f, "  potential  = {}", opaque.spell())?,
            None => {}
        }
        let control = self.control.iter().flat_map(|control| [Some(&control.price), control.bounds.as_ref()]).flatten();
        let others = self.force.iter().chain(&self.force_on).chain(control);
        others.chain(&self.endpoint).chain(&self.symmetries).try_for_each(|closure| entry(f, closure))?;
        for (name, value) in self.dials.given() {
            writeln!(f, "  {name:<10} = {}", value.value)?;
        }
        for method in &self.methods {
            let dials = joined(method.dials.given().map(|(name, value)| format!("{name} = {}", value.value)));
            writeln!(f, "  method {} = ({dials})", method.name)?;
        }
        for field in &self.fields {
            let promise = field.promise.map(|(promise, _)| format!(", {promise}")).unwrap_or_default();
            writeln!(f, "  field {}: {}{promise}", field.name(), spell_type(&field.ty))?;
        }
        Ok(())
    }
}
