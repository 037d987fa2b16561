//! Joints: the equations of the configurations of a power, between neighbouring sites.

use clebsch_symbolic::{Expr, IntoList, Role};
use syn::Expr as Syntax;

use super::Written;
use super::constraint::{Sides, equation, list, sequence};
use super::elaborate::Elaborator;
use super::features::{self, Feature, Found};
use super::power::{Joint, Joints, Linear, Range, SiteIndex, Term};
use super::sites::{Sites, unrolled};
use super::slots::{CONSTRAINT, Slot};
use super::typed::ActedSystem;
use crate::diagnostic::{Diagnostics, refuse};
use crate::parse::{Closure, Declaration};

/// One equation, for all indices of its range.
struct Read<'g> {
    range: Option<Range<'g>>,
    sides: Sides<'g>,
}

impl<'g> ActedSystem<'_, '_, 'g> {
    /// The joints of a power. `None` with an error, which was reported.
    pub fn joints(&mut self, declaration: &Declaration) -> Option<Joints<'g>> {
        let mut all = Vec::new();
        for closure in &declaration.constraints {
            all.extend(self.joints_of(closure)?);
        }
        let (diagnostics, sites) = (self.context.diagnostics, self.context.power.as_ref()?);
        let mut joints = Joints { all: Vec::new(), rows: 0, is_ring: false };
        for Read { range, sides } in all {
            let (own, before, is_ring) = ends(sites, range, &sides, diagnostics)?;
            joints.is_ring |= is_ring;
            let term = Term { ranges: range.into_iter().collect(), value: sides.difference };
            joints.add(term, (own, before), sides.written, sites);
        }
        Some(joints)
    }

    /// The joints of one closure.
    fn joints_of(&mut self, closure: &Closure) -> Option<Vec<Read<'g>>> {
        let diagnostics = self.context.diagnostics;
        let matched = self.arguments.matched(closure, CONSTRAINT);
        if matched.has_error() {
            return None;
        }
        if let Some(velocity) = matched.argument(Slot::Velocity) {
            let place = velocity.pattern.names().first().map_or_else(Found::somewhere, |name| Found::at(name.span()));
            let found = (Feature::VelocityConstraint, place);
            return diagnostics.refuse(features::refusal(found, (Feature::Power, Found::somewhere())));
        }
        let scope = self.arguments.scope(&matched, &[]);
        let list = list(closure, diagnostics)?;
        let mut elaborator = Elaborator::new(self.context, "constraint", scope);
        elaborator.in_block(&closure.body, |elaborator| {
            let equations = list.elems.iter().map(|syntax| read(elaborator, syntax));
            equations.into_list().into_iter().collect()
        })
    }
}

/// `a == b`, or `(1..N).map(|i| a == b)`.
fn read<'g>(elaborator: &mut Elaborator<'_, '_, 'g>, syntax: &Syntax) -> Option<Read<'g>> {
    let Some(call) = sequence(syntax) else { return Some(Read { range: None, sides: equation(elaborator, syntax)? }) };
    let (range, sides) = elaborator.of_range(call, |elaborator, body| match sequence(body) {
        None => equation(elaborator, body),
        Some(inner) => {
            refuse!(elaborator.context.diagnostics, inner, "ranges inside each other make joints of all pairs";
            help "{}", unrolled("constraint", &elaborator.context.power.as_ref()?.length);
            note "a joint is of one site, or of two neighbours")
        }
    })?;
    Some(Read { range: Some(range), sides })
}

/// The later one of the sites that an equation reads, the one before, and whether they are the first and the last of a ring.
fn ends<'g>(
    sites: &Sites<'g>,
    range: Option<Range<'g>>,
    sides: &Sides<'g>,
    diagnostics: &Diagnostics,
) -> Option<(usize, Option<usize>, bool)> {
    let Written { place, text } = &sides.written;
    let mut read: Vec<usize> = Vec::new();
    for symbol in sides.difference.symbols() {
        if let Some(Role::At(at, _)) = symbol.role()
            && !read.contains(&at)
        {
            read.push(at);
        }
    }
    read.sort_unstable();
    let name = |at: usize| format!("`{}[{}]`", sites.pattern, sites.places[at].text());
    let follows = |at: usize| match Linear::of(sites.places[at].index) {
        Some(linear) => linear.indices.first().copied().unwrap_or(0) == i64::from(range.is_some()),
        None => false,
    };
    if let Some(&at) = read.iter().find(|&&at| !follows(at)) {
        let (of, index) = (name(at), if range.is_some() { "`i`, plus a number" } else { "one site" });
        refuse!(diagnostics, *place, "the index of {of} is not {index}";
            help "{}", unrolled("constraint", &sites.length);
            note "the equations of neighbours are solved from the first site to the last")
    }
    match read[..] {
        [] => refuse!(diagnostics, *place, "`{text}` reads no site";
            help "leave it out, or write the configuration that it fixes"),
        [own] => Some((own, None, sites.places[own].wraps)),
        [first, second] => match order(&sites.places[first], &sites.places[second]) {
            Some((true, is_ring)) => Some((first, Some(second), is_ring)),
            Some((false, is_ring)) => Some((second, Some(first), is_ring)),
            None => {
                refuse!(diagnostics, *place, "`{text}` reads {} and {}, which are no neighbours", name(first), name(second);
                help "{}", unrolled("constraint", &sites.length);
                note "the equations of neighbours are solved from the first site to the last")
            }
        },
        _ => refuse!(diagnostics, *place, "`{text}` reads {} sites", read.len();
            help "{}", unrolled("constraint", &sites.length);
            note "a joint is of one site, or of two neighbours"),
    }
}

/// Whether the first of two neighbours is the later one, and whether they are neighbours in a ring alone.
fn order<'g>(first: &SiteIndex<'g>, second: &SiteIndex<'g>) -> Option<(bool, bool)> {
    let wraps = first.wraps || second.wraps;
    let Linear { constant, sites, indices } = Linear::of((first.index - second.index).expand())?;
    if indices.iter().any(|&coefficient| coefficient != 0) {
        return None;
    }
    match (constant, sites) {
        (1, 0) => Some((true, wraps)),
        (-1, 0) => Some((false, wraps)),
        (1, _) if wraps => Some((true, true)),
        (-1, _) if wraps => Some((false, true)),
        // the last site and the first
        (-1, 1) => Some((false, true)),
        (1, -1) => Some((true, true)),
        _ => None,
    }
}

impl<'g> Joints<'g> {
    /// Adds a joint, in the first rows that no other joint of the same sites has.
    fn add(&mut self, term: Term<'g>, (own, before): (usize, Option<usize>), written: Written, sites: &Sites<'g>) {
        let count = term.value.shape().rows;
        let of_site = homes(&term, &sites.places[own], sites.count);
        let mut first = 0;
        loop {
            let meets = |joint: &&Joint<'g>| {
                let apart = joint.first + joint.count() <= first || first + count <= joint.first;
                !apart && meet(&of_site, &homes(&joint.term, &sites.places[joint.own], sites.count))
            };
            let Some(other) = self.all.iter().find(meets) else { break };
            first = other.first + other.count();
        }
        self.rows = self.rows.max(first + count);
        self.all.push(Joint { term, own, before, first, written });
    }
}

/// The sites that are the later ones of a joint: from the first up to and without the second; `None` for all.
fn homes<'g>(term: &Term<'g>, own: &SiteIndex<'g>, count: Expr<'g>) -> Option<Range<'g>> {
    let graph = count.graph();
    let symbol = own.index.symbols().into_iter().find(|symbol| matches!(symbol.role(), Some(Role::Site(_))));
    let at = |end: Expr<'g>| symbol.map_or(own.index, |symbol| own.index.substitute(&[(symbol, end)]).expand());
    match term.ranges.first() {
        _ if own.wraps => None,
        Some((from, to)) => Some((at(*from), at(*to))),
        None => Some((own.index, (own.index + graph.integer(1)).expand())),
    }
}

/// Whether two ranges may share a site for some N.
fn meet<'g>(first: &Option<Range<'g>>, second: &Option<Range<'g>>) -> bool {
    let (Some((a, b)), Some((c, d))) = (first, second) else { return true };
    let is_before = |end: &Expr<'g>, start: &Expr<'g>| {
        Linear::of((*start - *end).expand())
            .is_some_and(|Linear { constant, sites, .. }| sites >= 0 && constant.saturating_add(sites) >= 0)
    };
    !is_before(b, c) && !is_before(d, a)
}
