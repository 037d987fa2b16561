//! Powers: N equal sites, each moved by its own element of a group, tied to each other by their potential alone.
//!
//! ```text
//! Φ_F(q)_i = φ_{F_i}(q_i),    ℓd = Σ_i k(h, q_i, F_i) − h V(q),    V(q) = Σ of terms
//! ```
//! The momentum equation of a step uncouples, so that a step kicks all sites, moves one after the other, and kicks them
//! again. A site is a system of its own. The code here is the same for every power and does not grow with N.

mod formulas;

use crate::parts::{F, Mu, Q, T, U};
use crate::scheme::{self, At, InStorage, Scheme};
use crate::space::{larger, minus, plus};
use crate::{Clebsch, Error, Scalar, Space};
use core::array::from_fn;
use num_traits::{One, Zero};

/// The configuration of a site.
pub type Point<P, const N: usize> = <<P as Power<N>>::Site as Clebsch>::Configuration;
/// The group element of a site.
pub type Motion<P, const N: usize> = <<P as Power<N>>::Site as Clebsch>::Element;
/// The momentum of a site.
pub type SiteMomentum<P, const N: usize> = <<P as Power<N>>::Site as Clebsch>::Momentum;
/// The input of the forces of a site.
pub type SiteInput<P, const N: usize> = <<P as Power<N>>::Site as Clebsch>::Input;
/// A site after a step.
type MovedSite<P, const N: usize> = (Point<P, N>, SiteMomentum<P, N>);
/// The constants of a power with these sites.
pub type Constants<P, const N: usize> = PowerConstants<T<P>, scheme::Constants<<P as Power<N>>::Site>>;
/// How a site is stepped.
pub(crate) type SiteScheme<P, const N: usize> = <<P as Power<N>>::Site as Clebsch>::Scheme;
/// The representing matrix of the momentum of a site.
type MomentumMatrix<P, const N: usize> = <<P as Power<N>>::Site as Clebsch>::MomentumMatrix;

/// The constants of all steps of a power.
#[derive(Clone, Copy, Debug)]
pub struct PowerConstants<T, C> {
    pub(crate) h: T,
    /// Those of each site, or of the first one where sites differ.
    pub(crate) site: C,
}

impl<T: Scalar, C> PowerConstants<T, C> {
    /// A part of the step size.
    #[inline]
    pub fn part(&self, part: f64) -> T {
        T::from_f64(part) * self.h
    }
}

/// The index modulo N of a site.
#[inline]
pub fn wrapped<const N: usize>(index: isize) -> usize {
    // most are inside; a negative one is larger than every N
    if (index as usize) < N { index as usize } else { remainder::<N>(index) }
}

#[cold]
fn remainder<const N: usize>(index: isize) -> usize {
    index.checked_rem_euclid(N as isize).unwrap_or(0) as usize
}

/// The constants of all steps of a site.
pub(crate) fn site_constants<S: Clebsch>(site: &S, h: S::Scalar) -> Result<scheme::Constants<S>, Error> {
    S::Scheme::constants(site, h)
}

/// A site after a step with the momentum n and the input u of its forces.
#[inline(always)]
pub(crate) fn moved_site<P: Power<N>, const N: usize>(
    site: &P::Site,
    c: &scheme::Constants<P::Site>,
    t: T<P>,
    (q, n): (&Point<P, N>, &SiteMomentum<P, N>),
    u: &SiteInput<P, N>,
) -> Result<MovedSite<P, N>, Error> {
    scheme::moved(At::new(site, c, t), (q, n), u)
}

/// N equal sites, as `#[derive(Clebsch)]` declares them by a const generic N.
///
/// Only the code that ties the sites together is generated; everything else comes from [`site`](Self::site).
///
/// ```
/// # use clebsch::{Clebsch, Power};
/// # use nalgebra::Vector1;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action    = |a: [Translation<1>; N], x: [Vector1; N]| (0..N).map(|i| x[i] + a[i]),
/// #     cost      = |h, a| (0..N).map(|i| a[i].norm_squared() / (2 * h)).sum(),
/// #     potential = |x| (0..N).map(|i| (x[(i + 1) % N] - x[i]).norm_squared() / 2).sum(),
/// # )]
/// # struct Ring<const N: usize>;
/// let ring = Ring::<8>;
/// let mut places = [Vector1::zeros(); 8];
/// places[3].x = 2.0;
/// assert_eq!(ring.potential_of_sites(0.0, &places), 4.0); // two springs of 2 m
/// ```
pub trait Power<const N: usize>:
    Clebsch<
        Configuration = [Point<Self, N>; N],
        Element = [Motion<Self, N>; N],
        Momentum = [SiteMomentum<Self, N>; N],
        MomentumMatrix = [MomentumMatrix<Self, N>; N],
        Constants = Constants<Self, N>,
        Scheme: InStorage<Self, N>,
    >
{
    /// One site, a system of its own.
    type Site: Clebsch<Scalar = Self::Scalar>;

    /// Whether all sites have the same kinetic energy.
    const IS_UNIFORM: bool;

    /// The least N that has all sites that the declaration names.
    const LEAST_SITES: usize = 1;

    /// Whether the gradient is gathered site by site, by [`gradient_at`](Self::gradient_at); else terms are added, by [`add_gradient`](Self::add_gradient).
    const GATHERS: bool;

    /// Whether the configuration of a site is finite wherever its motion is, as unit vectors and rotations are: then only momenta are looked at.
    const IS_BOUNDED: bool;

    /// The site with this index.
    ///
    /// # Panics
    /// As arrays do, for an index that is not below N.
    fn site(&self, i: usize) -> Self::Site;

    /// The input of a site: its own, or one that all sites share.
    ///
    /// # Panics
    /// As arrays do, for an index that is not below N.
    fn input_of_site(u: &Self::Input, i: usize) -> &SiteInput<Self, N>;

    /// The constants as those of a power.
    fn constants_of_sites(constants: &Self::Constants) -> &Constants<Self, N>;

    /// The potential V(t, q), a sum over sites.
    fn potential_of_sites(&self, t: T<Self>, q: &Q<Self>) -> T<Self>;

    /// ∂V/∂q_i of all terms that read the site i, where it is gathered.
    #[inline]
    fn gradient_at(&self, _t: T<Self>, _q: &Q<Self>, _i: usize) -> Point<Self, N> {
        Space::origin()
    }

    /// Adds ∂V/∂q, a covector for each site, where it is not gathered.
    #[inline]
    fn add_gradient(&self, _t: T<Self>, _q: &Q<Self>, _gradient: &mut Q<Self>) {}

    /// The constants of a step of size `h`.
    fn power_constants(&self, h: T<Self>) -> Result<Constants<Self, N>, Error> {
        const { assert!(N > 0, "a power has at least one site") };
        const {
            assert!(N >= Self::LEAST_SITES, "the declaration names a site that N does not have, or the same site twice")
        };
        // sites that differ are checked one by one; the constants of the first stand for all where they are equal
        let others = if Self::IS_UNIFORM { 1 } else { N };
        (1..others).try_for_each(|i| site_constants(&self.site(i), h).map(drop))?;
        Ok(PowerConstants { h, site: site_constants(&self.site(0), h)? })
    }

    /// The result of `give` for each site.
    #[inline(always)]
    fn each<R>(&self, mut give: impl FnMut(&Self::Site, usize) -> R) -> [R; N] {
        from_fn(|i| give(&self.site(i), i))
    }

    /// ∂V/∂q.
    #[inline]
    fn slope(&self, t: T<Self>, q: &Q<Self>) -> Q<Self> {
        if Self::GATHERS {
            return from_fn(|i| self.gradient_at(t, q, i));
        }
        let mut gradient = [Space::origin(); N];
        self.add_gradient(t, q, &mut gradient);
        gradient
    }

    /// J(q, weight ∂V).
    #[inline]
    fn power_kick(&self, t: T<Self>, q: &Q<Self>, weight: T<Self>) -> Mu<Self> {
        let gradient = if Self::GATHERS { [Space::origin(); N] } else { self.slope(t, q) };
        let mut kick = [Space::origin(); N];
        // not by `from_fn`: a closure that is not inlined does not know that its index is below N
        for i in 0..N {
            let slope = if Self::GATHERS { self.gradient_at(t, q, i) } else { gradient[i] };
            kick[i] = self.kick_of_site(i, &q[i], &slope, weight);
        }
        kick
    }

    /// J(q, weight ∂V) of one site.
    #[inline(always)]
    fn kick_of_site(&self, i: usize, q: &Point<Self, N>, p: &Point<Self, N>, weight: T<Self>) -> SiteMomentum<Self, N> {
        let momentum = self.site(i).momentum_map(q, p);
        momentum.zip_map(&momentum, |x, _| weight * x)
    }

    /// The kicks of all sites in the storage of others, added to their momenta. Returns the sum of all numbers: if it is finite, all of them are.
    #[inline]
    fn kick_into(
        &self,
        t: T<Self>,
        q: &Q<Self>,
        weight: T<Self>,
        gradient: &mut Q<Self>,
        kick: &mut Mu<Self>,
        mu: &mut Mu<Self>,
    ) -> T<Self> {
        if !Self::GATHERS {
            gradient.iter_mut().for_each(|gradient| *gradient = Space::origin());
            self.add_gradient(t, q, gradient);
        }
        let mut sum = T::<Self>::zero();
        for i in 0..N {
            let slope = if Self::GATHERS { self.gradient_at(t, q, i) } else { gradient[i] };
            kick[i] = self.kick_of_site(i, &q[i], &slope, weight);
            mu[i] = plus(&mu[i], &kick[i]);
            sum += if Self::IS_BOUNDED { mu[i].sum() } else { q[i].sum() + mu[i].sum() };
        }
        sum
    }

    /// The result of `give` for a site and its constants; where sites differ, the constants are computed for each.
    #[inline(always)]
    fn at_site<R>(
        &self,
        c: &Constants<Self, N>,
        i: usize,
        act: impl FnOnce(&Self::Site, &scheme::Constants<Self::Site>) -> Result<R, Error>,
    ) -> Result<R, Error> {
        let site = self.site(i);
        if Self::IS_UNIFORM { act(&site, &c.site) } else { act(&site, &site_constants(&site, c.h)?) }
    }

    /// Moves one site with the momentum n and the input u of its forces.
    #[inline(always)]
    fn moved(
        &self,
        c: &Constants<Self, N>,
        t: T<Self>,
        i: usize,
        (q, n): (&Point<Self, N>, &SiteMomentum<Self, N>),
        u: &SiteInput<Self, N>,
    ) -> Result<MovedSite<Self, N>, Error> {
        self.at_site(c, i, |site, c| moved_site::<Self, N>(site, c, t, (q, n), u))
    }

    /// The same with `kick` added to the momentum. An input that is not given is 0.
    #[inline(always)]
    fn kicked_and_moved(
        &self,
        c: &Constants<Self, N>,
        t: T<Self>,
        i: usize,
        (q, mu, kick): (&Point<Self, N>, &SiteMomentum<Self, N>, Option<&Mu<Self>>),
        u: Option<&U<Self>>,
    ) -> Result<MovedSite<Self, N>, (usize, Error)> {
        let n = kick.map_or(*mu, |kick| plus(mu, &kick[i]));
        let u = u.map_or_else(Space::origin, |u| *Self::input_of_site(u, i));
        self.moved(c, t, i, (q, &n), &u).map_err(|error| (i, error))
    }

    /// Moves all sites with their momenta, and with `kick` added, in the storage of others. An input of forces that is not given is 0. An error comes with the index of its site.
    #[inline]
    fn drift_into(
        &self,
        c: &Constants<Self, N>,
        t: T<Self>,
        (q, mu): (&Q<Self>, &Mu<Self>),
        kick: Option<&Mu<Self>>,
        u: Option<&U<Self>>,
        (next, moved): (&mut Q<Self>, &mut Mu<Self>),
    ) -> Result<(), (usize, Error)> {
        for i in 0..N {
            (next[i], moved[i]) = self.kicked_and_moved(c, t, i, (&q[i], &mu[i], kick), u)?;
        }
        Ok(())
    }

    /// The same in place.
    // a function of its own: its references are known to be of different arrays, which halves the time of a step
    #[inline]
    fn drift_in_place(
        &self,
        c: &Constants<Self, N>,
        t: T<Self>,
        q: &mut Q<Self>,
        mu: &mut Mu<Self>,
        kick: Option<&Mu<Self>>,
        u: Option<&U<Self>>,
    ) -> Result<(), (usize, Error)> {
        for i in 0..N {
            (q[i], mu[i]) = self.kicked_and_moved(c, t, i, (&q[i], &mu[i], kick), u)?;
        }
        Ok(())
    }

    /// F⁻ℓd, where the kick at the start has the weight `part` of a step.
    #[inline]
    fn power_legendre(&self, h: T<Self>, t: T<Self>, q: &Q<Self>, f: &F<Self>, part: f64) -> Mu<Self> {
        let mut momenta = self.power_kick(t, q, h * Scalar::from_f64(part));
        // not by a closure, as in `power_kick`
        for i in 0..N {
            momenta[i] = minus(&self.site(i).legendre(h, t, &q[i], &f[i]), &momenta[i]);
        }
        momenta
    }

    /// F⁺ℓd, where the kick at the end has the weight `part` of a step.
    #[inline]
    fn power_legendre_next(&self, h: T<Self>, t: T<Self>, q: &Q<Self>, f: &F<Self>, part: f64) -> Mu<Self> {
        let mut momenta = self.power_kick(t + h, &self.act(f, q), h * Scalar::from_f64(part));
        for i in 0..N {
            momenta[i] = plus(&self.site(i).legendre_next(h, t, &q[i], &f[i]), &momenta[i]);
        }
        momenta
    }

    /// ½ J(q, ∂(U₁ − U₀)) of kicks with these weights of a step.
    #[inline]
    fn power_stagger(&self, h: T<Self>, t: T<Self>, q: &Q<Self>, start: f64, end: f64) -> Mu<Self> {
        if start == end {
            return [Space::origin(); N];
        }
        self.power_kick(t, q, h * Scalar::from_f64(0.5 * (end - start)))
    }

    /// The kinetic energy of all sites.
    fn power_kinetic_energy(&self, c: &Constants<Self, N>, t: T<Self>, q: &Q<Self>, mu: &Mu<Self>) -> T<Self> {
        let mut sum = T::<Self>::zero();
        for (i, (q, mu)) in q.iter().zip(mu).enumerate() {
            let energy =
                self.at_site(c, i, |site, c| Ok(site.kinetic_energy(SiteScheme::<Self, N>::whole(c), t, q, mu)));
            // by construction: the constants of all sites have been made once
            sum += energy.unwrap_or(Scalar::from_f64(f64::INFINITY));
        }
        sum
    }

    /// Whether the kinetic energy of every site is positive.
    fn power_check_kinetic_energy(&self, t: T<Self>, q: &Q<Self>) -> Result<(), Error> {
        q.iter().enumerate().try_for_each(|(i, q)| self.site(i).check_kinetic_energy(t, q))
    }

    /// The representing matrices, site by site.
    #[inline]
    fn matrices_of(mu: &Mu<Self>) -> Self::MomentumMatrix {
        from_fn(|i| Self::Site::momentum_matrix(&mu[i]))
    }

    /// The components, site by site.
    #[inline]
    fn components_of(m: &Self::MomentumMatrix) -> Mu<Self> {
        from_fn(|i| Self::Site::momentum_components(&m[i]))
    }

    /// The largest defect of a site.
    fn power_orbit_defect(&self, q: &Q<Self>) -> T<Self> {
        q.iter().enumerate().fold(Zero::zero(), |most, (i, q)| larger(most, self.site(i).orbit_defect(q)))
    }

    /// The size of the defects of all sites together.
    fn power_isotropy_defect(&self, q: &Q<Self>, mu: &Mu<Self>) -> T<Self> {
        let zero = T::<Self>::zero();
        let defects = || q.iter().zip(mu).enumerate().map(|(i, (q, mu))| self.site(i).isotropy_defect(q, mu));
        let most = defects().fold(zero, larger);
        // squares of large ones are no numbers any more
        let scale = T::<Self>::select(zero.below(most), most, One::one());
        let squares = defects().fold(zero, |sum, defect| sum + (defect / scale) * (defect / scale));
        scale * Scalar::sqrt(squares)
    }
}

#[cfg(test)]
mod tests;
