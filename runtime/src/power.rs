//! Powers: N equal sites, each moved by its own element of a group, tied to each other by their potential alone.
//!
//! ```text
//! Φ_F(q)_i = φ_{F_i}(q_i),    ℓd = Σ_i k(h, q_i, F_i) − h V(q),    V(q) = Σ of terms
//! ```
//! The momentum equation of a step uncouples, so that a step kicks all sites, moves one after the other, and kicks them again. A site is a
//! system of its own; what is here is the same for every power and does not grow with N.

mod formulas;

use crate::scheme::{self, Scheme};
use crate::space::larger;
use crate::{Clebsch, Clock, Error, Scalar, Space, Time};
use core::array::from_fn;

/// The configuration of a site.
pub type Point<P, const N: usize> = <<P as Power<N>>::Site as Clebsch>::Configuration;
/// The group element of a site.
pub type Motion<P, const N: usize> = <<P as Power<N>>::Site as Clebsch>::Element;
/// The momentum of a site.
pub type SiteMomentum<P, const N: usize> = <<P as Power<N>>::Site as Clebsch>::Momentum;
/// What no step of a power with these sites changes.
pub type Constants<P, const N: usize> =
    PowerConstants<<P as Clebsch>::Scalar, scheme::Constants<<P as Power<N>>::Site>>;
/// A state of all sites.
type Arrays<P, const N: usize> = ([Point<P, N>; N], [SiteMomentum<P, N>; N]);
/// How a site is stepped.
type SiteScheme<P, const N: usize> = <<P as Power<N>>::Site as Clebsch>::Scheme;
/// The representing matrix of the momentum of a site.
type MomentumMatrix<P, const N: usize> = <<P as Power<N>>::Site as Clebsch>::MomentumMatrix;

/// What no step of a power changes.
#[derive(Clone, Copy, Debug)]
pub struct PowerConstants<T, C> {
    h: T,
    site: C,
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

#[inline]
fn plus<T: Scalar, S: Space<T>>(a: &S, b: &S) -> S {
    a.zip_map(b, |a, b| a + b)
}

#[inline]
fn minus<T: Scalar, S: Space<T>>(a: &S, b: &S) -> S {
    a.zip_map(b, |a, b| a - b)
}

/// What no step of a site changes.
///
/// # Errors
/// Those of [`Clebsch::constants`].
fn site_constants<S: Clebsch>(site: &S, h: S::Scalar) -> Result<scheme::Constants<S>, Error> {
    S::Scheme::constants(site, h)
}

/// N equal sites, as `#[derive(Clebsch)]` declares them by a const generic N.
///
/// Only what ties the sites together is generated; everything else is made of [`site`](Self::site).
pub trait Power<const N: usize>: Clebsch + Sized {
    /// One site, a system of its own.
    type Site: Clebsch<Scalar = Self::Scalar, Input = ()>;

    /// Whether all sites have the same kinetic energy.
    const IS_UNIFORM: bool;

    /// Whether the gradient of the potential is gathered site by site, by [`gradient_at`](Self::gradient_at); else the terms are gone through, and what each has
    /// for its sites is added there, by [`add_gradient`](Self::add_gradient).
    const GATHERS: bool;

    /// Whether the configuration of a site is finite wherever its motion is, as unit vectors and rotations are: then only momenta are looked at.
    const IS_BOUNDED: bool;

    /// The site with this index.
    ///
    /// # Panics
    /// As arrays do, for an index that is not below N.
    fn site(&self, i: usize) -> Self::Site;

    /// The constants as those of a power.
    fn constants_of_sites(constants: &Self::Constants) -> &Constants<Self, N>;

    /// The potential V(t, q), a sum over sites.
    fn potential_of_sites(&self, t: Self::Scalar, q: &[Point<Self, N>; N]) -> Self::Scalar;

    /// ∂V/∂q_i of all terms that read the site i, where it is gathered.
    #[inline]
    fn gradient_at(&self, _t: Self::Scalar, _q: &[Point<Self, N>; N], _i: usize) -> Point<Self, N> {
        Space::origin()
    }

    /// Adds ∂V/∂q, a covector for each site, where it is not gathered.
    #[inline]
    fn add_gradient(&self, _t: Self::Scalar, _q: &[Point<Self, N>; N], _gradient: &mut [Point<Self, N>; N]) {}

    /// The constants of a step of size `h`.
    ///
    /// # Errors
    /// Those of a site.
    fn power_constants(&self, h: Self::Scalar) -> Result<Constants<Self, N>, Error> {
        const { assert!(N > 0, "a power has at least one site") };
        // sites that differ are checked one by one; the constants of the first stand for all where they are equal
        let others = if Self::IS_UNIFORM { 1 } else { N };
        (1..others).try_for_each(|i| site_constants(&self.site(i), h).map(drop))?;
        Ok(PowerConstants { h, site: site_constants(&self.site(0), h)? })
    }

    /// Φ_F(q), site by site.
    #[inline]
    fn act_on_sites(&self, f: &[Motion<Self, N>; N], q: &[Point<Self, N>; N]) -> [Point<Self, N>; N] {
        from_fn(|i| self.site(i).act(&f[i], &q[i]))
    }

    /// J(q, p), site by site.
    #[inline]
    fn momenta_of(&self, q: &[Point<Self, N>; N], p: &[Point<Self, N>; N]) -> [SiteMomentum<Self, N>; N] {
        from_fn(|i| self.site(i).momentum_map(&q[i], &p[i]))
    }

    /// Ad*_F μ, site by site.
    #[inline]
    fn coadjoint_of_sites(
        &self,
        f: &[Motion<Self, N>; N],
        mu: &[SiteMomentum<Self, N>; N],
    ) -> [SiteMomentum<Self, N>; N] {
        from_fn(|i| self.site(i).coadjoint(&f[i], &mu[i]))
    }

    /// ∂V/∂q.
    #[inline]
    fn slope(&self, t: Self::Scalar, q: &[Point<Self, N>; N]) -> [Point<Self, N>; N] {
        if Self::GATHERS {
            return from_fn(|i| self.gradient_at(t, q, i));
        }
        let mut gradient = [Space::origin(); N];
        self.add_gradient(t, q, &mut gradient);
        gradient
    }

    /// J(q, weight ∂V).
    #[inline]
    fn power_kick(&self, t: Self::Scalar, q: &[Point<Self, N>; N], weight: Self::Scalar) -> [SiteMomentum<Self, N>; N] {
        if Self::GATHERS {
            return from_fn(|i| self.kick_of_site(i, &q[i], &self.gradient_at(t, q, i), weight));
        }
        let gradient = self.slope(t, q);
        from_fn(|i| self.kick_of_site(i, &q[i], &gradient[i], weight))
    }

    /// J(q, weight ∂V) of one site.
    #[inline(always)]
    fn kick_of_site(
        &self,
        i: usize,
        q: &Point<Self, N>,
        gradient: &Point<Self, N>,
        weight: Self::Scalar,
    ) -> SiteMomentum<Self, N> {
        let momentum = self.site(i).momentum_map(q, gradient);
        momentum.zip_map(&momentum, |x, _| weight * x)
    }

    /// The kicks of all sites in the storage of others, added to their momenta. Gives the sum of all numbers of the state that may not be finite, which is finite
    /// where they are, unless they are very large.
    #[inline]
    fn kick_into(
        &self,
        t: Self::Scalar,
        q: &[Point<Self, N>; N],
        weight: Self::Scalar,
        gradient: &mut [Point<Self, N>; N],
        kick: &mut [SiteMomentum<Self, N>; N],
        mu: &mut [SiteMomentum<Self, N>; N],
    ) -> Self::Scalar {
        if !Self::GATHERS {
            gradient.iter_mut().for_each(|gradient| *gradient = Space::origin());
            self.add_gradient(t, q, gradient);
        }
        let mut sum = <Self::Scalar as num_traits::Zero>::zero();
        for i in 0..N {
            let slope = if Self::GATHERS { self.gradient_at(t, q, i) } else { gradient[i] };
            kick[i] = self.kick_of_site(i, &q[i], &slope, weight);
            mu[i] = plus(&mu[i], &kick[i]);
            sum += if Self::IS_BOUNDED { mu[i].sum() } else { q[i].sum() + mu[i].sum() };
        }
        sum
    }

    /// What a site gives with its constants, which are made anew where sites differ.
    ///
    /// # Errors
    /// Those of `act`, and of the constants of the site.
    #[inline(always)]
    fn at_site<R>(
        &self,
        constants: &Constants<Self, N>,
        i: usize,
        act: impl FnOnce(&Self::Site, &scheme::Constants<Self::Site>) -> Result<R, Error>,
    ) -> Result<R, Error> {
        let site = self.site(i);
        match Self::IS_UNIFORM {
            true => act(&site, &constants.site),
            false => act(&site, &site_constants(&site, constants.h)?),
        }
    }

    /// Moves one site with the momentum n.
    ///
    /// # Errors
    /// Those of a step of the site.
    #[inline(always)]
    #[allow(clippy::type_complexity, reason = "what a step of the trait gives")]
    fn moved(
        &self,
        constants: &Constants<Self, N>,
        t: Self::Scalar,
        i: usize,
        q: &Point<Self, N>,
        n: &SiteMomentum<Self, N>,
    ) -> Result<(Point<Self, N>, SiteMomentum<Self, N>), Error> {
        self.at_site(constants, i, |site, constants| {
            let left = SiteScheme::<Self, N>::left(site, constants, t, q, n);
            let held = SiteScheme::<Self, N>::held(q, n);
            let (q, held, _) = SiteScheme::<Self, N>::step(site, constants, t, (q, &held, &left), &())?;
            Ok((q, SiteScheme::<Self, N>::momentum(&q, &held)))
        })
    }

    /// Moves all sites with their momenta, and with `kick` beside them, in the storage of others.
    ///
    /// # Errors
    /// Those of a step of a site, with its index.
    #[inline]
    #[allow(clippy::too_many_arguments, reason = "two states, and what is between")]
    fn drift_into(
        &self,
        constants: &Constants<Self, N>,
        t: Self::Scalar,
        q: &[Point<Self, N>; N],
        mu: &[SiteMomentum<Self, N>; N],
        kick: Option<&[SiteMomentum<Self, N>; N]>,
        next: &mut [Point<Self, N>; N],
        moved: &mut [SiteMomentum<Self, N>; N],
    ) -> Result<(), (usize, Error)> {
        for i in 0..N {
            let n = match kick {
                Some(kick) => plus(&mu[i], &kick[i]),
                None => mu[i],
            };
            match self.moved(constants, t, i, &q[i], &n) {
                Ok((q, n)) => (next[i], moved[i]) = (q, n),
                Err(error) => return Err((i, error)),
            }
        }
        Ok(())
    }

    /// Moves all sites with their momenta.
    ///
    /// # Errors
    /// Those of a step of a site.
    #[inline]
    fn power_drift(
        &self,
        constants: &Constants<Self, N>,
        t: Self::Scalar,
        steps: usize,
        q: &[Point<Self, N>; N],
        mu: &[SiteMomentum<Self, N>; N],
    ) -> Result<Arrays<Self, N>, Error> {
        let (mut next, mut moved) = (*q, *mu);
        let mut clock = Clock::at(t);
        for _ in 0..steps {
            self.drift_in_place(constants, clock.now(), &mut next, &mut moved, None)?;
            clock = clock.after_step(constants.h);
        }
        Ok((next, moved))
    }

    /// Moves all sites with their momenta, and with `kick` beside them, where they stand.
    ///
    /// # Errors
    /// Those of a step of a site.
    #[inline]
    fn drift_in_place(
        &self,
        constants: &Constants<Self, N>,
        t: Self::Scalar,
        q: &mut [Point<Self, N>; N],
        mu: &mut [SiteMomentum<Self, N>; N],
        kick: Option<&[SiteMomentum<Self, N>; N]>,
    ) -> Result<(), Error> {
        for i in 0..N {
            let n = match kick {
                Some(kick) => plus(&mu[i], &kick[i]),
                None => mu[i],
            };
            (q[i], mu[i]) = self.moved(constants, t, i, &q[i], &n)?;
        }
        Ok(())
    }

    /// As many steps, each half a kick, the move, half a kick.
    ///
    /// # Errors
    /// Those of a step of a site.
    #[inline]
    #[allow(clippy::type_complexity, reason = "what a step of the trait gives")]
    fn power_steps_of_second_order(
        &self,
        constants: &Constants<Self, N>,
        t: Self::Scalar,
        steps: usize,
        q: &[Point<Self, N>; N],
        mu: &[SiteMomentum<Self, N>; N],
        impulse: &[SiteMomentum<Self, N>; N],
    ) -> Result<([Point<Self, N>; N], [SiteMomentum<Self, N>; N], [SiteMomentum<Self, N>; N]), Error> {
        let (mut next, mut moved, mut kick) = (*q, *mu, *impulse);
        let (mut gradient, mut clock) = ([Space::origin(); N], Clock::at(t));
        for _ in 0..steps {
            self.drift_in_place(constants, clock.now(), &mut next, &mut moved, Some(&kick))?;
            clock = clock.after_step(constants.h);
            self.kick_into(clock.now(), &next, constants.part(-0.5), &mut gradient, &mut kick, &mut moved);
        }
        Ok((next, moved, kick))
    }

    /// A step into the place of another state: the move, with `kick` beside the momenta, and the kick after it, with this part of a step.
    ///
    /// # Errors
    /// Those of a step of a site.
    #[inline]
    #[allow(clippy::type_complexity, clippy::too_many_arguments, reason = "two states, and what is between")]
    fn power_step_into(
        &self,
        constants: &Constants<Self, N>,
        t: Self::Scalar,
        (q, mu, kick): (&[Point<Self, N>; N], &[SiteMomentum<Self, N>; N], Option<&[SiteMomentum<Self, N>; N]>),
        part: f64,
        (next, moved): (&mut [Point<Self, N>; N], &mut [SiteMomentum<Self, N>; N]),
        left: &mut [SiteMomentum<Self, N>; N],
    ) -> Result<(), Error> {
        self.drift_into(constants, t, q, mu, kick, next, moved).map_err(|(_, error)| error)?;
        let mut gradient = [Space::origin(); N];
        self.kick_into(t + constants.h, next, constants.part(part), &mut gradient, left, moved);
        Ok(())
    }

    /// As many steps, each the move, and a whole kick.
    ///
    /// # Errors
    /// Those of a step of a site.
    #[inline]
    #[allow(clippy::type_complexity, reason = "what a step of the trait gives")]
    fn power_steps_of_first_order(
        &self,
        constants: &Constants<Self, N>,
        t: Self::Scalar,
        steps: usize,
        q: &[Point<Self, N>; N],
        mu: &[SiteMomentum<Self, N>; N],
    ) -> Result<([Point<Self, N>; N], [SiteMomentum<Self, N>; N], ()), Error> {
        let (mut next, mut moved, mut kick) = (*q, *mu, [Space::origin(); N]);
        let (mut gradient, mut clock) = ([Space::origin(); N], Clock::at(t));
        for _ in 0..steps {
            self.drift_in_place(constants, clock.now(), &mut next, &mut moved, None)?;
            clock = clock.after_step(constants.h);
            self.kick_into(clock.now(), &next, constants.part(-1.0), &mut gradient, &mut kick, &mut moved);
        }
        Ok((next, moved, ()))
    }

    /// F⁻ℓd, where the kick at the start has the weight `part` of a step.
    #[inline]
    fn power_legendre(
        &self,
        h: Self::Scalar,
        t: Self::Scalar,
        q: &[Point<Self, N>; N],
        f: &[Motion<Self, N>; N],
        part: f64,
    ) -> [SiteMomentum<Self, N>; N] {
        let kick = self.power_kick(t, q, h * Scalar::from_f64(part));
        from_fn(|i| minus(&self.site(i).legendre(h, t, &q[i], &f[i]), &kick[i]))
    }

    /// F⁺ℓd, where the kick at the end has the weight `part` of a step.
    #[inline]
    fn power_legendre_next(
        &self,
        h: Self::Scalar,
        t: Self::Scalar,
        q: &[Point<Self, N>; N],
        f: &[Motion<Self, N>; N],
        part: f64,
    ) -> [SiteMomentum<Self, N>; N] {
        let kick = self.power_kick(t + h, &self.act_on_sites(f, q), h * Scalar::from_f64(part));
        from_fn(|i| plus(&self.site(i).legendre_next(h, t, &q[i], &f[i]), &kick[i]))
    }

    /// The elements with this F⁻ℓd, where the kick at the start has the weight `part` of a step.
    ///
    /// # Errors
    /// Those of a site.
    fn power_inverse_legendre(
        &self,
        constants: &Constants<Self, N>,
        t: Self::Scalar,
        q: &[Point<Self, N>; N],
        mu: &[SiteMomentum<Self, N>; N],
        part: f64,
    ) -> Result<[Motion<Self, N>; N], Error> {
        let kick = self.power_kick(t, q, constants.part(part));
        let mut elements = [Space::origin(); N];
        for (i, element) in elements.iter_mut().enumerate() {
            let n = plus(&mu[i], &kick[i]);
            *element = self.at_site(constants, i, |site, constants| {
                SiteScheme::<Self, N>::inverse_legendre(site, constants, t, &q[i], &n)
            })?;
        }
        Ok(elements)
    }

    /// ½ J(q, ∂(U₁ − U₀)) of kicks with these weights of a step.
    #[inline]
    fn power_stagger(
        &self,
        h: Self::Scalar,
        t: Self::Scalar,
        q: &[Point<Self, N>; N],
        start: f64,
        end: f64,
    ) -> [SiteMomentum<Self, N>; N] {
        match start == end {
            true => [Space::origin(); N],
            false => self.power_kick(t, q, h * Scalar::from_f64(0.5 * (end - start))),
        }
    }

    /// A step of (q, p), whose kicks have these weights of a step.
    ///
    /// # Errors
    /// Those of a step of a site.
    #[allow(clippy::type_complexity, reason = "what a step of the trait gives")]
    fn power_step_symmetric(
        &self,
        constants: &Constants<Self, N>,
        t: Self::Scalar,
        q: &[Point<Self, N>; N],
        p: &[Point<Self, N>; N],
        start: f64,
        end: f64,
    ) -> Result<([Point<Self, N>; N], [Point<Self, N>; N]), Error> {
        let kicked = |p: &[Point<Self, N>; N], t, q: &[Point<Self, N>; N], part: f64| {
            let (gradient, weight) = (self.slope(t, q), constants.part(part));
            from_fn::<_, N, _>(|i| p[i].zip_map(&gradient[i], |p, slope| p + weight * slope))
        };
        let (mut next, mut moved) = (*q, kicked(p, t, q, start));
        for (i, (q, p)) in next.iter_mut().zip(&mut moved).enumerate() {
            (*q, *p) = self.at_site(constants, i, |site, constants| {
                SiteScheme::<Self, N>::step_symmetric(site, constants, t, q, p)
            })?;
        }
        let p = kicked(&moved, t + constants.h, &next, end);
        Ok((next, p))
    }

    /// The kinetic energy of all sites.
    fn power_kinetic_energy(
        &self,
        constants: &Constants<Self, N>,
        t: Self::Scalar,
        q: &[Point<Self, N>; N],
        mu: &[SiteMomentum<Self, N>; N],
    ) -> Self::Scalar {
        let mut sum = <Self::Scalar as num_traits::Zero>::zero();
        for (i, (q, mu)) in q.iter().zip(mu).enumerate() {
            let energy = self.at_site(constants, i, |site, constants| {
                Ok(site.kinetic_energy(SiteScheme::<Self, N>::whole(constants), t, q, mu))
            });
            // by construction: the constants of all sites have been made once
            sum += energy.unwrap_or(Self::Scalar::from_f64(f64::INFINITY));
        }
        sum
    }

    /// The representing matrices, site by site.
    #[inline]
    fn matrices_of(mu: &[SiteMomentum<Self, N>; N]) -> [MomentumMatrix<Self, N>; N] {
        from_fn(|i| Self::Site::momentum_matrix(&mu[i]))
    }

    /// The components, site by site.
    #[inline]
    fn components_of(m: &[MomentumMatrix<Self, N>; N]) -> [SiteMomentum<Self, N>; N] {
        from_fn(|i| Self::Site::momentum_components(&m[i]))
    }

    /// The largest defect of a site.
    fn power_orbit_defect(&self, q: &[Point<Self, N>]) -> Self::Scalar {
        let zero = <Self::Scalar as num_traits::Zero>::zero();
        q.iter().enumerate().fold(zero, |most, (i, q)| larger(most, self.site(i).orbit_defect(q)))
    }

    /// The size of the defects of all sites together.
    fn power_isotropy_defect(&self, q: &[Point<Self, N>], mu: &[SiteMomentum<Self, N>]) -> Self::Scalar {
        let (zero, one) = (<Self::Scalar as num_traits::Zero>::zero(), <Self::Scalar as num_traits::One>::one());
        let defect =
            |(i, (q, mu)): (usize, (&Point<Self, N>, &SiteMomentum<Self, N>))| self.site(i).isotropy_defect(q, mu);
        let defects = || q.iter().zip(mu).enumerate().map(defect);
        let most = defects().fold(zero, larger);
        // squares of large ones are no numbers any more
        let scale = Self::Scalar::select(zero.below(most), most, one);
        let squares = defects().fold(zero, |sum, defect| sum + (defect / scale) * (defect / scale));
        scale * Scalar::sqrt(squares)
    }

    /// The momenta that motions of q can have, site by site.
    #[inline]
    fn projected(&self, q: &[Point<Self, N>; N], mu: &[SiteMomentum<Self, N>; N]) -> [SiteMomentum<Self, N>; N] {
        from_fn(|i| self.site(i).project_momentum(&q[i], &mu[i]))
    }
}

#[cfg(test)]
mod tests;
