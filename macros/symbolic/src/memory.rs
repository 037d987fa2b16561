//! Results of maps of expressions, remembered: the same parts stand in many expressions.
//!
//! A map that is asked again makes nothing new, so that remembering changes neither expressions nor their order.

use std::cell::RefCell;
use std::rc::Rc;

use crate::node::Id;
use crate::{Algebra, Elements, Expr, Graph, Group, Table, work};

/// A map of expressions.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(crate) enum Map {
    /// The replacement of expressions by others.
    Substitution(Vec<(Id, Id)>),
    /// The derivative in the direction in which symbols move.
    Differential(Vec<(Id, Id)>),
    /// The components of matrices.
    Components(Algebra),
    /// The derivative of the exponential of a group.
    ExponentialSlope(Group),
}

/// The images of expressions that are known.
#[derive(Default)]
pub(crate) struct Images {
    /// 1 + the image of each expression, or 0.
    known: RefCell<Vec<u32>>,
}

impl Images {
    pub(crate) fn get(&self, id: Id) -> Option<Id> {
        let entry = self.known.borrow().get(id.0 as usize).copied().unwrap_or(0);
        entry.checked_sub(1).map(Id)
    }

    pub(crate) fn set(&self, id: Id, image: Id) {
        let mut known = self.known.borrow_mut();
        if known.len() <= id.0 as usize {
            let mut larger = vec![0; 2 * (id.0 as usize + 1)];
            work::spend(larger.len() / 8);
            larger[..known.len()].copy_from_slice(&known);
            *known = larger;
        }
        known[id.0 as usize] = image.0 + 1;
    }

    /// The image of a part of the expression that is being mapped.
    pub(crate) fn of<'g>(&self, graph: &'g Graph, part: &Id) -> Expr<'g> {
        // by construction: parts come before the expressions that contain them
        graph.expr(self.get(*part).expect("the image of a part"))
    }
}

pub(crate) type Maps = RefCell<Table<Map, Rc<Images>>>;

impl Graph {
    /// The images of a map that are known.
    pub(crate) fn images(&self, map: Map) -> Rc<Images> {
        self.maps.borrow_mut().entry(map).clone()
    }
}

pub(crate) fn pairs(pairs: &[(Expr<'_>, Expr<'_>)]) -> Vec<(Id, Id)> {
    pairs.each(|(from, to)| (from.id, to.id))
}

impl<'g> Expr<'g> {
    /// The image under a map that gives the image of each node from those of its parts.
    pub(crate) fn mapped(self, images: &Images, image: impl Fn(Expr<'g>) -> Expr<'g>) -> Expr<'g> {
        if images.get(self.id).is_none() {
            for id in self.reachable_where(|id| images.get(id).is_none()) {
                images.set(id, image(self.graph.expr(id)).id);
            }
        }
        images.of(self.graph, &self.id)
    }

    /// The image under a map, which is made where it is not known.
    pub(crate) fn remembered(self, images: &Images, make: impl FnOnce() -> Expr<'g>) -> Expr<'g> {
        match images.get(self.id) {
            Some(known) => self.graph.expr(known),
            None => {
                let made = make();
                images.set(self.id, made.id);
                made
            }
        }
    }
}
