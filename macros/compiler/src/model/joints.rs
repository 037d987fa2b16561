//! Joints: the equations of the configurations of a power, between neighbouring sites or between those of a tree.

use clebsch_symbolic::{Expr, IntoElements, IntoList, Role};
use syn::Expr as Syntax;

use super::Written;
use super::constraint::{Sides, check_range, check_squares, equation, list, of_each, sequence};
use super::elaborate::Elaborator;
use super::features::{self, Feature, Found};
use super::power::{Joint, Joints, Linear, Range, SiteIndex, Term};
use super::sites::{Sites, unrolled};
use super::slots::{CONSTRAINT, Slot};
use super::typed::ActedSystem;
use crate::diagnostic::{Diagnostic, Diagnostics, bail, refuse};
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
        let ends = all.iter().map(|Read { range, sides }| ends(sites, *range, sides, diagnostics));
        let mut ends = ends.collect::<Option<Vec<Ends>>>()?;
        let sites = self.context.power.as_mut()?;
        sites.least = ends.iter().fold(sites.least, |least, end| least.max(end.least));
        let sites = &*sites;
        close_ring(&mut ends, &all, sites);
        let is_loop = diagnostics.take(loops(&mut ends, &all, sites))?;
        let is = |order: Order| ends.iter().any(|end| end.order == order);
        let is_tree = is(Order::Tree) || is_loop.contains(&true);
        let mut joints = Joints { all: Vec::new(), rows: 0, is_ring: is(Order::Ring), is_tree, loops: 0 };
        for ((Read { range, sides }, ends), is_loop) in all.into_iter().zip(ends).zip(is_loop) {
            joints.add(range, sides, (&ends, is_loop), sites);
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
            let equations = list.elems.iter().map(|syntax| read(elaborator, syntax)).into_list();
            let all = equations.into_iter().collect::<Option<Vec<_>>>()?.into_iter().flatten().into_list();
            all.iter().try_for_each(|read: &Read<'g>| check_squares(elaborator.context, &read.sides))?;
            Some(all)
        })
    }
}

/// `a == b`, or `(1..N).map(|i| a == b)`, also with several equations for each index.
fn read<'g>(elaborator: &mut Elaborator<'_, '_, 'g>, syntax: &Syntax) -> Option<Vec<Read<'g>>> {
    let Some(call) = sequence(syntax) else {
        return Some(vec![Read { range: None, sides: equation(elaborator, syntax)? }]);
    };
    check_range(elaborator, call)?;
    let (range, all) = elaborator.of_range(call, of_each)?;
    Some(all.into_each(|sides| Read { range: Some(range), sides }))
}

/// The sites that an equation reads: the later one, its parent, and how they follow each other.
struct Ends {
    own: usize,
    before: Option<usize>,
    order: Order,
    /// The least N for which the later site is the later one.
    least: i64,
}

/// How two sites follow each other.
#[derive(Copy, Clone, PartialEq, Eq)]
enum Order {
    /// As neighbours, or there is one site.
    Chain,
    /// As the last site and the first one.
    Ring,
    /// As a site of a tree and its parent.
    Tree,
}

/// Joints of the last site and the first one, by numbers, close a ring if the last site hangs from the one before.
fn close_ring(ends: &mut [Ends], all: &[Read<'_>], sites: &Sites<'_>) {
    let graph = sites.count.graph();
    let last = (sites.count - graph.integer(1)).expand();
    let is_last = |at: usize| !sites.places[at].wraps && sites.places[at].index == last;
    let is_first = |at: usize| !sites.places[at].wraps && sites.places[at].index.is_zero();
    let hangs = |(end, read): (&Ends, &Read<'_>)| {
        let homes = homes(read.range, &sites.places[end.own], sites.count);
        end.order == Order::Chain && end.before.is_some() && meet([&homes, &Some((last, sites.count))], sites.least)
    };
    let is_chain = ends.iter().zip(all).any(hangs);
    for end in ends.iter_mut().filter(|_| is_chain) {
        if let Some(before) = end.before.filter(|&before| is_last(end.own) && is_first(before))
            && end.order == Order::Tree
        {
            *end = Ends { own: before, before: Some(end.own), order: Order::Ring, least: end.least };
        }
    }
}

fn ends<'g>(sites: &Sites<'g>, range: Option<Range<'g>>, sides: &Sides<'g>, diagnostics: &Diagnostics) -> Option<Ends> {
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
    let name = |at: usize| format!("`{}[{}]`", sites.pattern, sites.places[at].text(&sites.length));
    let follows = |at: usize| match Linear::of(sites.places[at].index) {
        Some(linear) => linear.indices.first().copied().unwrap_or(0) == i64::from(range.is_some()),
        None => false,
    };
    let is_number = |at: usize| !sites.places[at].wraps && sites.places[at].index.as_number().is_some();
    // the parent of all sites of a range may be one site
    let has_center = read.len() == 2 && read.iter().any(|&at| follows(at));
    if let Some(&at) = read.iter().find(|&&at| !(follows(at) || has_center && is_number(at))) {
        let (of, index) = (name(at), if range.is_some() { "`i`, plus a number" } else { "one site" });
        refuse!(diagnostics, *place, "the index of {of} is not {index}";
            help "{}", unrolled("constraint", &sites.length);
            note "the equations of neighbours are solved from the first site to the last")
    }
    match read[..] {
        [] => refuse!(diagnostics, *place, "`{text}` reads no site";
            help "leave it out, or write the configuration that it fixes"),
        [own] if sites.places[own].wraps => Some(Ends { own, before: None, order: Order::Ring, least: 1 }),
        [own] => Some(Ends { own, before: None, order: Order::Chain, least: 1 }),
        [first, second] => match order(&sites.places[first], &sites.places[second], range) {
            Some((true, order, least)) => Some(Ends { own: first, before: Some(second), order, least }),
            Some((false, order, least)) => Some(Ends { own: second, before: Some(first), order, least }),
            None => {
                refuse!(diagnostics, *place, "it is not known which of {} and {} in `{text}` is the later site", name(first), name(second);
                    help "write the numbers of both sites, as `{0}[4]` and `{0}[1]`", sites.pattern;
                    note "joints are eliminated from the last site to the first")
            }
        },
        _ => refuse!(diagnostics, *place, "`{text}` reads {} sites", read.len();
            help "{}", unrolled("constraint", &sites.length);
            note "a joint is of one site, or of two"),
    }
}

/// Whether the first of two sites is the later one, how they follow each other, and the least N for which it is so.
fn order<'g>(first: &SiteIndex<'g>, second: &SiteIndex<'g>, range: Option<Range<'g>>) -> Option<(bool, Order, i64)> {
    let wraps = first.wraps || second.wraps;
    let Linear { constant, sites, indices } = Linear::of((first.index - second.index).expand())?;
    if let Some(&coefficient) = indices.iter().find(|&&coefficient| coefficient != 0) {
        // a site of a range, and one that stays
        let (own, center) = if coefficient > 0 { (first, second) } else { (second, first) };
        let center =
            Linear::of(center.index).filter(|center| center.sites == 0 && center.indices.iter().all(|&i| i == 0))?;
        let start = Linear::of(homes_of(range?, own).0).filter(|start| start.sites == 0)?;
        let is_later = !wraps && start.constant > center.constant;
        return is_later.then_some((coefficient > 0, Order::Tree, 1));
    }
    match (constant, sites) {
        (1, 0) if !wraps => Some((true, Order::Chain, 1)),
        (-1, 0) if !wraps => Some((false, Order::Chain, 1)),
        (1, _) if wraps => Some((true, Order::Ring, 1)),
        (-1, _) if wraps => Some((false, Order::Ring, 1)),
        // the last site and the first
        (-1, 1) => Some((false, Order::Ring, 1)),
        (1, -1) => Some((true, Order::Ring, 1)),
        (2.., 0) if !wraps => Some((true, Order::Tree, 1)),
        (..=-2, 0) if !wraps => Some((false, Order::Tree, 1)),
        // a site counted from the last one, `q[N - 1]`, and one counted from the first: c + N ≥ 1
        (_, 1) if !wraps => Some((true, Order::Tree, 1 - constant)),
        (_, -1) if !wraps => Some((false, Order::Tree, 1 + constant)),
        _ => None,
    }
}

/// The later sites of a joint, for all indices of its range.
fn homes_of<'g>((from, to): Range<'g>, own: &SiteIndex<'g>) -> Range<'g> {
    let symbol = own.index.symbols().into_iter().find(|symbol| matches!(symbol.role(), Some(Role::Site(_))));
    let at = |end: Expr<'g>| symbol.map_or(own.index, |symbol| own.index.substitute(&[(symbol, end)]).expand());
    (at(from), at(to))
}

impl<'g> Joints<'g> {
    /// Adds a joint: one of a loop behind all others, else in the first rows that no other joint of the same sites has.
    fn add(&mut self, range: Option<Range<'g>>, sides: Sides<'g>, (ends, is_loop): (&Ends, bool), sites: &Sites<'g>) {
        let Sides { difference: value, written } = sides;
        let (count, own) = (value.shape().rows, ends.own);
        let of_site = homes(range, &sites.places[own], sites.count);
        let meets = |joint: &&Joint<'g>, first: usize| {
            let apart = joint.first + joint.count() <= first || first + count <= joint.first;
            let others = || homes(joint.term.ranges.first().copied(), &sites.places[joint.own], sites.count);
            !joint.is_loop && !apart && meet([&of_site, &others()], sites.least)
        };
        let mut first = 0;
        if is_loop {
            first = self.loops;
            // by construction: the range of a loop has numbers for ends
            self.loops += count * range.map_or(Some(1), length).unwrap_or(1);
        } else {
            while let Some(other) = self.all.iter().find(|joint| meets(joint, first)) {
                first = other.first + other.count();
            }
            self.rows = self.rows.max(first + count);
        }
        let term = Term { ranges: range.into_iter().collect(), value };
        self.all.push(Joint { term, own, before: ends.before, first, is_loop, written });
    }
}

/// Which joints close a loop: their later site hangs from another one. Those of a range whose end is N come first.
///
/// # Errors
/// A loop for each site of such a range, and a ring by remainders in a tree.
fn loops<'g>(ends: &mut [Ends], all: &[Read<'g>], sites: &Sites<'g>) -> Result<Vec<bool>, Diagnostic> {
    let is_tree = ends.iter().any(|end| end.order == Order::Tree);
    for (end, read) in ends.iter_mut().zip(all).filter(|(end, _)| is_tree && end.order == Order::Ring) {
        let wraps = |at: usize| sites.places[at].wraps;
        let Some(before) = end.before.filter(|&before| !wraps(before) && !wraps(end.own)) else {
            bail!(read.sides.written.place, "these joints close a loop in a tree by a remainder";
                help "let the range end before, and write the joint of `{0}[{1} - 1]` and `{0}[0]` by itself", sites.pattern, sites.length;
                note "in a tree the joints of a site read it and one earlier site, and a joint more closes a loop");
        };
        *end = Ends { own: before, before: Some(end.own), order: Order::Tree, least: end.least };
    }
    let is_numbered = |joint: usize| all[joint].range.is_none_or(|range| length(range).is_some());
    let joints = 0..ends.len();
    let in_turn = joints.clone().filter(|&joint| !is_numbered(joint)).chain(joints.filter(|&joint| is_numbered(joint)));
    let mut is_loop = vec![false; ends.len()];
    let mut known: Vec<usize> = Vec::new();
    for joint in in_turn {
        let Some(other) = known.iter().copied().find(|&other| !have_one_parent(sites, [joint, other], ends, all))
        else {
            known.push(joint);
            continue;
        };
        if !is_numbered(joint) {
            let name = |at: usize| format!("`{}[{}]`", sites.pattern, sites.places[at].text(&sites.length));
            let (place, [joint, other]) = (all[joint].sides.written.place, [&ends[joint], &ends[other]]);
            let (own, known) = (name(joint.own), name(other.before.unwrap_or(other.own)));
            let parent = name(joint.before.unwrap_or(other.own));
            bail!(place, "{own} has two earlier sites, {known} and {parent}: each of these joints closes a loop";
                help "{}", unrolled("constraint", &sites.length);
                note "a loop is solved for all of its equations at once, and there may be only a number of them");
        }
        is_loop[joint] = true;
    }
    Ok(is_loop)
}

/// Whether no site hangs from another one by the first joint than by the second.
fn have_one_parent<'g>(sites: &Sites<'g>, pair: [usize; 2], ends: &[Ends], all: &[Read<'g>]) -> bool {
    let [own, other] = pair.map(|joint| &ends[joint]);
    let (Some(before), Some(parent)) = (own.before, other.before) else { return true };
    let [first, second] = pair.map(|joint| homes(all[joint].range, &sites.places[ends[joint].own], sites.count));
    !meet([&first, &second], sites.least)
        || has_same_parent(
            [&sites.places[own.own], &sites.places[before]],
            [&sites.places[other.own], &sites.places[parent]],
        )
}

/// The number of indices of a range with numbers for ends.
fn length((from, to): Range<'_>) -> Option<usize> {
    let (from, to) = (Linear::of(from)?, Linear::of(to)?);
    let is_number = |end: &Linear| end.sites == 0 && end.indices.iter().all(|&index| index == 0);
    (is_number(&from) && is_number(&to)).then(|| usize::try_from(to.constant - from.constant).unwrap_or(0))
}

/// Whether two joints of the same site have the same parent: by the number of sites between, or by its own number.
fn has_same_parent<'g>(first: [&SiteIndex<'g>; 2], second: [&SiteIndex<'g>; 2]) -> bool {
    let is_ring = first.iter().chain(&second).any(|place| place.wraps);
    let between = |[own, parent]: [&SiteIndex<'g>; 2]| (own.index - parent.index).expand();
    is_ring || between(first) == between(second) || first[1] == second[1]
}

/// The sites that are the later ones of a joint: from the first up to and without the second; `None` for all.
fn homes<'g>(range: Option<Range<'g>>, own: &SiteIndex<'g>, count: Expr<'g>) -> Option<Range<'g>> {
    let graph = count.graph();
    match range {
        _ if own.wraps => None,
        Some(range) => Some(homes_of(range, own)),
        None => Some((own.index, (own.index + graph.integer(1)).expand())),
    }
}

/// Whether two ranges may share a site for some N from the least one on.
fn meet<'g>(ranges: [&Option<Range<'g>>; 2], least: i64) -> bool {
    let [Some((a, b)), Some((c, d))] = ranges else { return true };
    let is_before = |end: &Expr<'g>, start: &Expr<'g>| {
        Linear::of((*start - *end).expand()).is_some_and(|Linear { constant, sites, .. }| {
            sites >= 0 && constant.saturating_add(sites.saturating_mul(least)) >= 0
        })
    };
    !is_before(b, c) && !is_before(d, a)
}
