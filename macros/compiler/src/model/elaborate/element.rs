//! Functions of a group element: the coordinates by which energies of edges measure it.

use clebsch_symbolic::{Expr, Group, Property, Role, Shape};
use syn::ExprMethodCall;

use super::{Elaborator, Value};
use crate::diagnostic::refuse;
use crate::parse::spell;

impl<'g> Elaborator<'_, '_, 'g> {
    /// ξ with F = (I − ξ/2)⁻¹(I + ξ/2), as the symbol that the derivation knows; a translation is its own.
    pub(super) fn cayley(&mut self, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        let (text, k) = (spell(&call.receiver), self.element_of_edge(call, a)?);
        let Some(group) = self.group_of(a) else { return Some(Value::Matrix(a)) };
        if group == Group::UnitQuaternions || !group.has_cayley_chart(self.graph()) {
            let name = group.name(self.graph());
            refuse!(self, &call.method, "{name} has no Cayley map whose inverse a closure knows";
                help "write a function of the entries, as in `({text} - I).norm_squared()`")
        }
        let shape = Shape::vector(group.dimension());
        let z = self.graph().symbol(&format!("cay⁻¹({a})"), shape, Role::Cayley(k), Property::General);
        Some(Value::Matrix(2 * z))
    }

    /// ξ with F = exp ξ, as the symbol that the derivation knows; a translation is its own.
    pub(super) fn log(&mut self, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        let (text, k) = (spell(&call.receiver), self.element_of_edge(call, a)?);
        let Some(group) = self.group_of(a) else { return Some(Value::Matrix(a)) };
        let shape = Shape::vector(group.dimension());
        let y = self.graph().symbol(&format!("log({a})"), shape, Role::Logarithm(k), Property::General);
        if group == Group::UnitQuaternions || group.logarithm_slope(y).is_none() {
            let name = group.name(self.graph());
            refuse!(self, &call.method, "the derivative of the logarithm on {name} has no formula that a closure knows";
                help "write `{text}.cayley()`, or a function of the entries, as in `({text} - I).norm_squared()`")
        }
        Some(Value::Matrix(y))
    }

    /// The number of the factor whose element an expression is, in an energy of an edge.
    fn element_of_edge(&mut self, call: &ExprMethodCall, a: Expr<'g>) -> Option<usize> {
        if let (Some(Role::Element(k)), "space") = (a.role(), self.key) {
            return Some(k);
        }
        let (text, name) = (spell(&call.receiver), &call.method);
        refuse!(self, name, "`{text}` is not the element of an edge, and `{name}` is of nothing else";
            help "write it in `space = |ds, W| …`, where `W` moves a site to its neighbour")
    }
}
