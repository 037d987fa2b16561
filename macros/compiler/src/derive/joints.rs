//! Joints: constraints φ = 0 on the configurations of neighbouring sites of a power.
//!
//! Each is differentiated once, for all indices of its range. The rows along motions of a site that it reads are
//! J(q, ∂φ) there, one for each entry of φ.

use clebsch_symbolic::{Expr, IntoList, Shape, identity};

use super::constraint::{check_system, free_motion, inverse};
use super::energy::Energy;
use super::power::{SiteTerm, home, of_terms, symbol_at};
use super::{Home, SystemFormulas};
use crate::diagnostic::{Diagnostics, bail};
use crate::model::features::{self, Feature, Found};
use crate::model::{Joint, Mechanics, Term};

/// The formulas of the joints of a power.
pub struct JointFormulas<'g> {
    /// The joints.
    pub all: Vec<JointRows<'g>>,
    /// Σ⁻¹μ of a site.
    pub mobility: Expr<'g>,
    /// Σξ + A of a site.
    pub momentum: Expr<'g>,
    /// ξ′ of a site without joints and without the potential of all sites, a function of t, q, μ and the input u.
    pub acceleration: Expr<'g>,
}

/// The formulas of one joint.
pub struct JointRows<'g> {
    /// φ.
    pub places: Expr<'g>,
    /// Its rows along motions of the later site.
    pub own: Expr<'g>,
    /// Its rows along motions of the site before; 0 where it reads one site.
    pub before: Expr<'g>,
    /// −∂φ/∂t.
    pub velocity: Expr<'g>,
    /// The second derivative of φ in time with constant velocities: ξ of the later site, and μ in place of that of the site
    /// before.
    pub bend: Expr<'g>,
    /// The index of its range that has a given site as the later one.
    pub home: Home<'g>,
}

/// The formulas of the joints of a model; `None` if it has none.
///
/// # Errors
/// A kinetic energy or an action that does not go with them, and joints that depend on each other.
pub(super) fn of<'g>(
    model: &Mechanics<'g>,
    system: &SystemFormulas<'g>,
    (energy, inertia): (&Energy<'g>, Expr<'g>),
    (potential, force): (Expr<'g>, Option<&[Expr<'g>]>),
) -> Result<Option<JointFormulas<'g>>, Diagnostics> {
    let Some(power) = &model.power else { return Ok(None) };
    let Some(joints) = &power.joints else { return Ok(None) };
    check_system(model, system, energy)?;
    features::check((Feature::Joints, Found::somewhere()), |feature| {
        let moves = feature == Feature::MovingInertia && system.is_moving(inertia);
        moves.then(|| Found::at(model.spans.kinetic.place))
    })?;
    let momenta = model.graph.below(&system.symbols.momenta);
    let gyroscopic = system.symbols.slope(energy.gyroscopic);
    let mut all = Vec::new();
    for joint in &joints.all {
        let rows = rows(model, system, joint);
        check_rows(joint, &rows)?;
        all.push(rows);
    }
    let inverse = inverse(system, inertia);
    let velocity = inverse * (momenta - gyroscopic);
    let free = free_motion(model, system, (energy.gyroscopic - potential, force), velocity);
    Ok(Some(JointFormulas {
        all,
        mobility: inverse * momenta,
        momentum: system.symbols.slope(energy.kinetic) + gyroscopic,
        acceleration: velocity.differential(&free),
    }))
}

fn rows<'g>(model: &Mechanics<'g>, system: &SystemFormulas<'g>, joint: &Joint<'g>) -> JointRows<'g> {
    let places = joint.term.value;
    let symbols = places.symbols();
    let generator = system.leaves_by_generator();
    // the change of each leaf at a place by a velocity there
    let motion = |place: usize| -> Vec<(Expr<'g>, Expr<'g>)> {
        let there = |leaf: usize| Some((generator.get(leaf)?.0, symbol_at(&symbols, place, leaf)?));
        let there: Vec<(Expr<'g>, Expr<'g>)> = (0..generator.len()).filter_map(there).into_list();
        let moved = |(leaf, motion): &(Expr<'g>, Expr<'g>)| {
            let (_, symbol) = there.iter().find(|(own, _)| own == leaf)?;
            Some((*symbol, motion.substitute(&there)))
        };
        generator.iter().filter_map(moved).into_list()
    };
    let along = |place: usize| system.symbols.slopes(places.differential(&motion(place))).expand();
    let of_before = system.symbols.algebra.iter().copied().zip(system.symbols.momenta.iter().copied()).into_list();
    let mut changes = motion(joint.own);
    for (leaf, change) in joint.before.map_or(Vec::new(), motion) {
        changes.push((leaf, change.substitute(&of_before)));
    }
    changes.push((model.time, model.graph.integer(1)));
    let own = along(joint.own);
    let home = model.power.as_ref().and_then(|power| home(&joint.term, power, &power.places[joint.own]));
    JointRows {
        places,
        own,
        before: joint.before.map_or_else(|| model.graph.zero(own.shape()), along),
        velocity: -places.differential(&[(model.time, model.graph.integer(1))]),
        bend: places.differential(&changes).differential(&changes),
        // by construction: its index is that of its range, plus a number
        home: home.unwrap_or(Home { index: None, wraps: false, is_everywhere: false }),
    }
}

/// Every entry of φ depends on the configuration, and none follows from the others.
fn check_rows<'g>(joint: &Joint<'g>, rows: &JointRows<'g>) -> Result<(), Diagnostics> {
    let graph = rows.own.graph();
    let (place, text) = (joint.written.place, &joint.written.text);
    let all = graph.beside(&[rows.own, rows.before]);
    let Shape { rows: count, columns } = all.shape();
    if let Some(i) = (0..count).find(|&i| identity::vanishes(all.block(i, 0, Shape::new(1, columns)))) {
        let which = if count > 1 { format!("component {i} of ") } else { String::new() };
        bail!(place, "{which}`{text}` does not depend on the configuration";
            help "leave it out, or write the configuration that it fixes";
            note "an equation that fixes nothing has no force")
    }
    let rank = identity::rank(all);
    if rank < count {
        bail!(place, "the components of `{text}` follow from each other";
            help "leave out those that follow from others";
            note "its rows have rank {rank}, and there are {count} of them: their forces are not determined")
    }
    Ok(())
}

/// Each entry of each φ as a term with its gradient, for the symmetries that all of them have.
pub(super) fn entries<'g>(model: &Mechanics<'g>) -> Vec<SiteTerm<'g>> {
    let Some(power) = &model.power else { return Vec::new() };
    let joints = power.joints.iter().flat_map(|joints| &joints.all);
    let entry =
        |joint: &Joint<'g>, i: usize| Term { ranges: joint.term.ranges.clone(), value: joint.term.value.entry(i, 0) };
    let terms = joints.flat_map(|joint| (0..joint.count()).map(move |i| entry(joint, i))).into_list();
    of_terms(model, power.places.len(), &terms)
}
