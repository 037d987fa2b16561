//! The code that the derive macro writes for every power.

/// The formulas of a power: those of each site, one after the other.
#[doc(hidden)]
#[macro_export]
macro_rules! __formulas_of_sites {
    ($scalar:ty, $sites:tt, $start:expr, $end:expr) => {
        const MAY_LEAVE_ORBIT: ::core::primitive::bool =
            <<Self as $crate::__private::Power<$sites>>::Site as $crate::__private::Clebsch>::MAY_LEAVE_ORBIT;
        fn act(&self, f: &Self::Element, q: &Self::Configuration) -> Self::Configuration {
            $crate::__private::Power::each(self, |site, i| $crate::__private::Clebsch::act(site, &f[i], &q[i]))
        }
        fn momentum_map(&self, q: &Self::Configuration, p: &Self::Configuration) -> Self::Momentum {
            $crate::__private::Power::each(self, |site, i| $crate::__private::Clebsch::momentum_map(site, &q[i], &p[i]))
        }
        fn coadjoint(&self, f: &Self::Element, mu: &Self::Momentum) -> Self::Momentum {
            $crate::__private::Power::each(self, |site, i| $crate::__private::Clebsch::coadjoint(site, &f[i], &mu[i]))
        }
        /// The discrete Legendre transform: that of each site, less its kick at the start.
        fn legendre(&self, h: $scalar, t: $scalar, q: &Self::Configuration, f: &Self::Element) -> Self::Momentum {
            $crate::__private::Power::power_legendre(self, h, t, q, f, $start)
        }
        /// The discrete Legendre transform: that of each site, and its kick at the end.
        fn legendre_next(&self, h: $scalar, t: $scalar, q: &Self::Configuration, f: &Self::Element) -> Self::Momentum {
            $crate::__private::Power::power_legendre_next(self, h, t, q, f, $end)
        }
        fn stagger(&self, h: $scalar, t: $scalar, q: &Self::Configuration) -> Self::Momentum {
            $crate::__private::Power::power_stagger(self, h, t, q, $start, $end)
        }
        fn potential(&self, t: $scalar, q: &Self::Configuration) -> $scalar {
            $crate::__private::Power::potential_of_sites(self, t, q)
        }
        fn kinetic_energy(
            &self,
            constants: &Self::Constants,
            t: $scalar,
            q: &Self::Configuration,
            mu: &Self::Momentum,
        ) -> $scalar {
            $crate::__private::Power::power_kinetic_energy(self, constants, t, q, mu)
        }
        fn check_kinetic_energy(
            &self,
            t: $scalar,
            q: &Self::Configuration,
        ) -> $crate::__private::Result<(), $crate::__private::Error> {
            $crate::__private::Power::power_check_kinetic_energy(self, t, q)
        }
        fn momentum_matrix(mu: &Self::Momentum) -> Self::MomentumMatrix {
            <Self as $crate::__private::Power<$sites>>::matrices_of(mu)
        }
        fn momentum_components(m: &Self::MomentumMatrix) -> Self::Momentum {
            <Self as $crate::__private::Power<$sites>>::components_of(m)
        }
        /// By how much q violates the promise of the declaration, at the site where it does most.
        fn orbit_defect(&self, q: &Self::Configuration) -> $scalar {
            $crate::__private::Power::power_orbit_defect(self, q)
        }
        fn isotropy_defect(&self, q: &Self::Configuration, mu: &Self::Momentum) -> $scalar {
            $crate::__private::Power::power_isotropy_defect(self, q, mu)
        }
        fn project_momentum(&self, q: &Self::Configuration, mu: &Self::Momentum) -> Self::Momentum {
            $crate::__private::Power::each(self, |site, i| {
                $crate::__private::Clebsch::project_momentum(site, &q[i], &mu[i])
            })
        }
    };
}

/// The constraint of a power: the joints of all sites.
#[doc(hidden)]
#[macro_export]
macro_rules! __formulas_of_joints {
    ($scalar:ty, $sites:tt, $rows:tt, $dimension:tt) => {
        fn check_place(
            &self,
            t: $scalar,
            q: &Self::Configuration,
        ) -> $crate::__private::Result<(), $crate::__private::Error> {
            $crate::__private::Joined::<$sites, $rows, $dimension>::check_joints(self, t, q)
        }
        fn placed(
            &self,
            constants: &Self::Constants,
            t: $scalar,
            q: &Self::Configuration,
        ) -> $crate::__private::Result<Self::Configuration, $crate::__private::Error> {
            $crate::__private::Joined::<$sites, $rows, $dimension>::joined_places(self, constants, t, q)
        }
        fn constraint_defect(
            &self,
            constants: &Self::Constants,
            t: $scalar,
            q: &Self::Configuration,
            mu: &Self::Momentum,
        ) -> $crate::__private::Result<$crate::__private::Violation<$scalar>, $crate::__private::Error> {
            $crate::__private::Joined::<$sites, $rows, $dimension>::defect_of_joints(self, constants, t, q, mu)
        }
        fn constrained(
            &self,
            constants: &Self::Constants,
            t: $scalar,
            q: &Self::Configuration,
            mu: &Self::Momentum,
        ) -> $crate::__private::Result<Self::Momentum, $crate::__private::Error> {
            $crate::__private::Joined::<$sites, $rows, $dimension>::joined_momentum(self, constants, t, q, mu)
        }
    };
}
