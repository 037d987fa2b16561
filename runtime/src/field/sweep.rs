//! The forces on all sites of a grid, line by line. The sites of a line follow each other in the last direction.

use super::edges::Edge;
use super::{Field, Grid, Lattice};
use crate::parts::{Mu, Q, T};
use crate::space::plus;
use crate::{Error, Space};
use core::ops::Range;
use num_traits::Zero;

/// `mu` with a force added, times `weight`.
#[inline(always)]
fn pushed<S: Field<D>, const D: usize>(mu: &Mu<S>, force: &Mu<S>, weight: T<S>) -> Mu<S> {
    mu.zip_map(force, |mu, force| mu + weight * force)
}

/// The neighbours before and after some sites in each direction.
type Around<'q, S, const D: usize> = ([&'q [Q<S>]; D], [&'q [Q<S>]; D]);

/// A field on a grid at a time.
struct Sweep<'a, S: Field<D>, P, const D: usize> {
    /// The parameters of a site.
    site: P,
    /// Whether the force on a site is found from all of its edges at once: all of them have the same parameters then.
    gathers: bool,
    grid: &'a Grid<T<S>, D>,
    t: T<S>,
    weight: T<S>,
    q: &'a [Q<S>],
}

impl<'s, S: Field<D> + 's, P: Fn(usize) -> &'s S + Copy, const D: usize> Sweep<'_, S, P, D> {
    /// The force on the site at a place, wherever it is.
    fn force_at(&self, index: usize, place: &[usize; D]) -> Mu<S> {
        let (system, spacing) = ((self.site)(index), self.grid.spacings());
        let Some(q) = self.q.get(index) else { return Space::origin() };
        let (mut before, mut after) = ([q; D], [q; D]);
        let (mut is_inside, mut neighbours) = (self.gathers, [[None; 2]; D]);
        for d in 0..D {
            let there = |site: usize| Some((site, self.q.get(site)?));
            let around = self.grid.around(index, place, d).map(|site| site.and_then(there));
            match around {
                [Some((_, first)), Some((_, last))] => (before[d], after[d]) = (first, last),
                _ => is_inside = false,
            }
            neighbours[d] = around;
        }
        if is_inside {
            return system.force_inside(self.t, spacing, q, &before, &after);
        }
        let mut force = if S::HAS_POTENTIAL { system.force_on_site(self.t, q) } else { Space::origin() };
        for (d, [before, after]) in neighbours.into_iter().enumerate() {
            if let Some((number, before)) = before {
                force = plus(&force, &(self.site)(number).edge_forces(d, spacing, before, q).1);
            }
            if let Some((_, after)) = after {
                force = plus(&force, &system.edge_forces(d, spacing, q, after).0);
            }
        }
        force
    }

    /// Adds the forces on sites of a line that follow each other. The first one is at a place.
    fn push_each(&self, start: usize, mut place: [usize; D], mu: &mut [Mu<S>]) {
        for (index, mu) in (start..).zip(mu) {
            if !self.grid.fixes(&place) {
                *mu = pushed::<S, D>(mu, &self.force_at(index, &place), self.weight);
            }
            if let Some(last) = place.last_mut() {
                *last += 1;
            }
        }
    }

    /// Adds the forces on sites of a line that follow each other. The first one is at a place.
    fn gather(&self, start: usize, place: [usize; D], mu: &mut [Mu<S>]) {
        let along = place.last().copied().unwrap_or(0);
        // the sites without those at the ends of the line
        let first = usize::from(along == 0);
        let count = mu.len().saturating_sub(first + usize::from(along + mu.len() >= self.grid.line()));
        let Some((own, around)) = self.inside(start + first, &place, count) else {
            return self.push_each(start, place, mu);
        };
        let Some((ahead, others)) = mu.split_at_mut_checked(first) else { return };
        let Some((between, behind)) = others.split_at_mut_checked(own.len()) else { return };
        self.push_each(start, place, ahead);
        self.push_between((self.site)(start), between, own, around);
        let mut end = place;
        if let Some(along) = end.last_mut() {
            *along += first + count;
        }
        self.push_each(start + first + count, end, behind);
    }

    /// Adds the forces on sites of a line between their neighbours.
    #[inline(always)]
    fn push_between(&self, system: &S, mu: &mut [Mu<S>], own: &[Q<S>], (before, after): Around<'_, S, D>) {
        // copies: the optimiser does not see that no momentum is a part of the grid, and would divide by the spacings at each site
        let (spacing, t, weight) = (*self.grid.spacings(), self.t, self.weight);
        let push = |mu: &mut Mu<S>, q: &Q<S>, around: &[(&Q<S>, &Q<S>)]| {
            let (mut before, mut after) = ([q; D], [q; D]);
            for ((before, after), around) in before.iter_mut().zip(&mut after).zip(around) {
                (*before, *after) = *around;
            }
            *mu = pushed::<S, D>(mu, &system.force_inside(t, &spacing, q, &before, &after), weight);
        };
        let sites = mu.iter_mut().zip(own);
        // One zip for each number of directions. An index in a loop over directions is checked at each site, and no two sites are
        // then pushed side by side.
        match (before.as_slice(), after.as_slice()) {
            ([b], [a]) => sites.zip(b.iter().zip(*a)).for_each(|((mu, q), x)| push(mu, q, &[x])),
            ([b, c], [a, d]) => {
                let around = b.iter().zip(*a).zip(c.iter().zip(*d));
                sites.zip(around).for_each(|((mu, q), (x, y))| push(mu, q, &[x, y]));
            }
            ([b, c, e], [a, d, f]) => {
                let around = b.iter().zip(*a).zip(c.iter().zip(*d)).zip(e.iter().zip(*f));
                sites.zip(around).for_each(|((mu, q), ((x, y), z))| push(mu, q, &[x, y, z]));
            }
            _ => {
                for (k, (mu, q)) in sites.enumerate() {
                    let mut around = [(q, q); D];
                    for d in 0..D {
                        let (Some(before), Some(after)) = (before[d].get(k), after[d].get(k)) else { break };
                        around[d] = (before, after);
                    }
                    push(mu, q, &around);
                }
            }
        }
    }

    /// So many sites of a line from one on between its ends, and their neighbours. In the other directions their place is that of
    /// `place`. `None` on a side of the grid, and for no sites.
    #[inline]
    fn inside(&self, start: usize, place: &[usize; D], count: usize) -> Option<(&[Q<S>], Around<'_, S, D>)> {
        let part = |first: usize| self.q.get(first..first.checked_add(count)?);
        let own = part(start).filter(|own| !own.is_empty())?;
        let (mut before, mut after) = ([own; D], [own; D]);
        for d in 0..D {
            let [first, last] =
                if d + 1 < D { self.grid.around(start, place, d) } else { [start.checked_sub(1), Some(start + 1)] };
            (before[d], after[d]) = (part(first?)?, part(last?)?);
        }
        Some((own, (before, after)))
    }

    /// Adds the forces of all edges of the sites from one on, one edge after the other.
    fn scatter(&self, first: usize, mu: &mut [Mu<S>]) {
        let spacing = self.grid.spacings();
        if S::HAS_POTENTIAL {
            for (i, (mu, q)) in (first..).zip(mu.iter_mut().zip(self.q.iter().skip(first))) {
                *mu = pushed::<S, D>(mu, &(self.site)(i).force_on_site(self.t, q), self.weight);
            }
        }
        self.each_edge(first..first + mu.len(), |d, [site, next]| {
            let (Some(q), Some(neighbour)) = (self.q.get(site), self.q.get(next)) else { return };
            let (own, other) = (self.site)(site).edge_forces(d, spacing, q, neighbour);
            // a site before the first one has a number beyond all others
            if let Some(mu) = mu.get_mut(site.wrapping_sub(first)) {
                *mu = pushed::<S, D>(mu, &own, self.weight);
            }
            if let Some(mu) = mu.get_mut(next.wrapping_sub(first)) {
                *mu = pushed::<S, D>(mu, &other, self.weight);
            }
        });
    }

    /// Visits each edge of some sites by its direction and the numbers of its ends, in an order that does not depend on the others.
    #[inline(always)]
    fn each_edge(&self, sites: Range<usize>, mut visit: impl FnMut(usize, [usize; 2])) {
        let line = self.grid.line();
        let meets = |start: usize| start < sites.end && sites.start < start + line;
        for start in (0..self.q.len()).step_by(line.max(1)) {
            let place = self.grid.split(start);
            for d in 0..D {
                if d + 1 < D {
                    let Some(next) = self.grid.around(start, &place, d)[1] else { continue };
                    if meets(start) || meets(next) {
                        let of_them = |j: &usize| sites.contains(&(start + j)) || sites.contains(&(next + j));
                        (0..line).filter(of_them).for_each(|j| visit(d, [start + j, next + j]));
                    }
                    continue;
                }
                let end = (start + line).min(sites.end.saturating_add(1));
                ((start + 1).max(sites.start)..end).for_each(|site| visit(d, [site - 1, site]));
                let last = start + line.saturating_sub(1);
                if let Some(next) = self.grid.around(last, &self.grid.split(last), d)[1]
                    && (sites.contains(&last) || sites.contains(&next))
                {
                    visit(d, [last, next]);
                }
            }
        }
    }
}

impl<S: Field<D>, const D: usize> Lattice<S> for Grid<T<S>, D> {
    fn sites(&self) -> usize {
        Grid::sites(self)
    }

    fn is_fixed(&self, site: usize) -> bool {
        Grid::is_fixed(self, site)
    }

    fn has_fixed(&self) -> bool {
        Grid::has_fixed(self)
    }

    fn check(&self) -> Result<(), Error> {
        Grid::check(self)
    }

    fn kick<'s>(
        &self,
        (site, are_alike): (impl Fn(usize) -> &'s S + Copy, bool),
        (t, weight): (T<S>, T<S>),
        q: &[Q<S>],
        (first, mu): (usize, &mut [Mu<S>]),
    ) where
        S: 's,
    {
        let sweep = Sweep { site, gathers: S::GATHERS && are_alike, grid: self, t, weight, q };
        if !sweep.gathers {
            return sweep.scatter(first, mu);
        }
        // line by line; the first and the last one need not be complete
        let (mut start, mut place, mut others) = (first, self.split(first), mu);
        while !others.is_empty() {
            let along = place.last().copied().unwrap_or(0);
            let length = self.line().saturating_sub(along).clamp(1, others.len());
            let (line, behind) = others.split_at_mut_checked(length).unwrap_or_default();
            sweep.gather(start, place, line);
            (start, others) = (start + length, behind);
            self.next_line(&mut place);
        }
    }

    fn row_length(&self) -> usize {
        self.row()
    }

    fn rows_of_neighbours(&self, are_alike: bool) -> Option<usize> {
        (S::GATHERS && are_alike || D == 1).then(|| self.row())
    }

    fn energy<'s>(&self, site: impl Fn(usize) -> &'s S + Copy, q: &[Q<S>], starts: Range<usize>) -> T<S>
    where
        S: 's,
    {
        let (mut total, mut start, along) = (T::<S>::zero(), starts.start, D.saturating_sub(1));
        // lines are added by themselves: sums of many numbers lose more
        while start < starts.end {
            let (place, mut part) = (self.split(start), T::<S>::zero());
            let to_end = self.line().saturating_sub(place.last().copied().unwrap_or(0)).max(1);
            let end = starts.end.min(start + to_end);
            let mut add = |d: usize, [number, next]: [usize; 2]| {
                if let (Some(q), Some(neighbour)) = (q.get(number), q.get(next)) {
                    part += site(number).edge_energy(d, self.spacings(), q, neighbour);
                }
            };
            for d in 0..along {
                if let Some(next) = self.around(start, &place, d)[1] {
                    (start..end).zip(next..).for_each(|(number, next)| add(d, [number, next]));
                }
            }
            (start + 1..end).for_each(|next| add(along, [next - 1, next]));
            if let Some(next) = self.around(end - 1, &self.split(end - 1), along)[1] {
                add(along, [end - 1, next]);
            }
            total += part;
            start = end;
        }
        total
    }

    fn visit_edges(&self, site: usize, visit: impl FnMut(Edge, usize)) {
        Grid::visit_edges(self, site, visit);
    }

    fn energy_of_edge(&self, system: &S, Edge { direction, .. }: Edge, [q, next]: [&Q<S>; 2]) -> T<S> {
        system.edge_energy(direction, self.spacings(), q, next)
    }

    fn forces(&self, system: &S, Edge { direction, .. }: Edge, [q, next]: [&Q<S>; 2]) -> (Mu<S>, Mu<S>) {
        system.edge_forces(direction, self.spacings(), q, next)
    }

    fn forces_along(
        &self,
        system: &S,
        Edge { direction, .. }: Edge,
        [q, next]: [&Q<S>; 2],
        [motion, next_motion]: [&Mu<S>; 2],
    ) -> (Mu<S>, Mu<S>) {
        system.edge_forces_along(direction, self.spacings(), q, next, motion, next_motion)
    }
}
