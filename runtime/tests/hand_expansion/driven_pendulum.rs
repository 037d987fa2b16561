//! A pendulum on a driven pivot as its derive macro is meant to expand it: time, a closed form, and points of a sphere.

/// A spherical pendulum whose pivot shakes up and down.
#[derive(Clone, Debug)]
pub struct DrivenPendulum {
    /// Mass of the bob, kg.
    pub mass: f64,
    /// Length, m.
    pub length: f64,
    /// g, m/s².
    pub gravity: f64,
    /// Largest acceleration of the pivot, m/s².
    pub shake: f64,
    /// Its angular frequency, rad/s.
    pub rate: f64,
}

const _: () = {
    use ::clebsch::__private::{SMatrix, SVector, matrix, vector};

    /// Computed once per stepper.
    #[derive(Clone, Debug)]
    pub struct Constants {
        /// Step size h.
        h: f64,
        /// h/2
        half_h: f64,
        /// h / (mass·length²)
        h_by_inertia: f64,
    }

    #[automatically_derived]
    impl ::clebsch::Clebsch for DrivenPendulum {
        type Scalar = f64;
        type Configuration = SVector<f64, 3>;
        type Element = SMatrix<f64, 3, 3>;
        type Momentum = SVector<f64, 3>;
        type MomentumMatrix = SMatrix<f64, 3, 3>;
        type Input = ();
        type Constants = Constants;
        type Scheme = ::clebsch::__private::KickDriftKick<::clebsch::__private::Shared>;
        type Time = ::clebsch::Clock<f64>;
        const NAME: &'static str = "DrivenPendulum";
        const ORDER: u32 = 2;
        const DERIVATION: &'static str = "a hand expansion";

        fn constants(&self, h: f64) -> ::core::result::Result<Constants, ::clebsch::Error> {
            ::clebsch::__private::check_finite("mass", &self.mass)?;
            ::clebsch::__private::check_finite("length", &self.length)?;
            ::clebsch::__private::check_finite("gravity", &self.gravity)?;
            ::clebsch::__private::check_finite("shake", &self.shake)?;
            ::clebsch::__private::check_finite("rate", &self.rate)?;
            ::clebsch::__private::invert(&matrix([[inertia(self)]]))?;
            Ok(Constants { h, half_h: h / 2.0, h_by_inertia: h / inertia(self) })
        }

        /// Φ_F(q) = F q
        #[inline]
        fn act(&self, f: &SMatrix<f64, 3, 3>, q: &SVector<f64, 3>) -> SVector<f64, 3> {
            f * q
        }

        /// J(q, p) = q × p
        #[inline]
        fn momentum_map(&self, q: &SVector<f64, 3>, p: &SVector<f64, 3>) -> SVector<f64, 3> {
            q.cross(p)
        }

        /// Ad*_F μ = Fᵀμ
        #[inline]
        fn coadjoint(&self, f: &SMatrix<f64, 3, 3>, mu: &SVector<f64, 3>) -> SVector<f64, 3> {
            f.tr_mul(mu)
        }

        /// T*L_F ∂_F ℓd − J(q, ∂_q ℓd): N^ = mass·length² (F − Fᵀ)/(2h) + (h/2)(q × ∇V(t, q))^
        fn legendre(&self, h: f64, t: f64, q: &SVector<f64, 3>, f: &SMatrix<f64, 3, 3>) -> SVector<f64, 3> {
            components(f) * (inertia(self) / (2.0 * h)) + moment(self, t, q) * (h / 2.0)
        }

        /// T*R_F ∂_F ℓd: N⁺^ = mass·length² (F − Fᵀ)/(2h) − (h/2)(q⁺ × ∇V(t + h, q⁺))^
        fn legendre_next(&self, h: f64, t: f64, q: &SVector<f64, 3>, f: &SMatrix<f64, 3, 3>) -> SVector<f64, 3> {
            components(f) * (inertia(self) / (2.0 * h)) - moment(self, t + h, &(f * q)) * (h / 2.0)
        }

        /// V(t, q) = mass·length·(gravity + shake cos(rate t)) q₃
        #[inline]
        fn potential(&self, t: f64, q: &SVector<f64, 3>) -> f64 {
            gradient(self, t).dot(q)
        }

        /// |N|² / (2 mass·length²)
        #[inline]
        fn kinetic_energy(&self, _: &Constants, _t: f64, _q: &SVector<f64, 3>, mu: &SVector<f64, 3>) -> f64 {
            mu.norm_squared() / (2.0 * inertia(self))
        }

        /// M = ½ N^
        #[inline]
        fn momentum_matrix(mu: &SVector<f64, 3>) -> SMatrix<f64, 3, 3> {
            (mu * 0.5).cross_matrix()
        }

        /// N_i = ⟨M, E_i⟩
        #[inline]
        fn momentum_components(m: &SMatrix<f64, 3, 3>) -> SVector<f64, 3> {
            components(m)
        }

        /// ||q|² − 1|
        fn orbit_defect(&self, q: &SVector<f64, 3>) -> f64 {
            ::clebsch::__private::length_defect(q)
        }

        /// The component of N along q.
        fn isotropy_defect(&self, q: &SVector<f64, 3>, mu: &SVector<f64, 3>) -> f64 {
            ::clebsch::__private::annihilator_defect(&momenta(q), mu)
        }

        /// N without its component along q.
        fn project_momentum(&self, q: &SVector<f64, 3>, mu: &SVector<f64, 3>) -> SVector<f64, 3> {
            ::clebsch::__private::annihilator_projection(&momenta(q), mu)
        }
    }

    #[automatically_derived]
    impl ::clebsch::Conserves for DrivenPendulum {
        type Conserved = ::clebsch::Conserved<f64, 1>;
        const CONSERVED_NAMES: &'static [&'static str] = &["about e3"];

        /// N₃
        #[inline]
        fn conserved(&self, _q: &SVector<f64, 3>, mu: &SVector<f64, 3>) -> ::clebsch::Conserved<f64, 1> {
            ::clebsch::Conserved::new(["about e3"], [mu.z])
        }
    }

    #[automatically_derived]
    impl ::clebsch::Variational<3> for DrivenPendulum {
        /// cay(±η) − I = (±η^ + ½ η^²)/(1 + ¼|η|²)
        #[inline]
        fn retractions(&self, eta: &SVector<f64, 3>) -> [SMatrix<f64, 3, 3>; 2] {
            let a = eta.cross_matrix();
            let even = a * a * 0.5;
            [even + a, even - a].map(|a| a / (1.0 + 0.25 * eta.norm_squared()))
        }

        /// F₂F₁ − I
        #[inline]
        fn compose(&self, first: &SMatrix<f64, 3, 3>, second: &SMatrix<f64, 3, 3>) -> SMatrix<f64, 3, 3> {
            first + second + second * first
        }

        /// q + Dq
        #[inline]
        fn advance(&self, q: &SVector<f64, 3>, d: &SMatrix<f64, 3, 3>) -> SVector<f64, 3> {
            ::clebsch::__private::Parts::advance(self, q, d)
        }

        /// ξ_Q
        fn infinitesimal_motion(&self, q: &SVector<f64, 3>, xi: &SVector<f64, 3>) -> SVector<f64, 3> {
            xi.cross(q)
        }

        /// (e_i × q)·(e_j × q) = |q|²I − qqᵀ
        #[inline]
        fn orbit_metric(&self, q: &SVector<f64, 3>) -> SMatrix<f64, 3, 3> {
            SMatrix::<f64, 3, 3>::identity() * q.norm_squared() - q * q.transpose()
        }

        /// q × (target − q)
        #[inline]
        fn approach(&self, q: &SVector<f64, 3>, target: &SVector<f64, 3>) -> SVector<f64, 3> {
            q.cross(&(target - q))
        }
    }

    impl ::clebsch::__private::Parts for DrivenPendulum {
        type Sums = ::clebsch::__private::Plain;
        type Coordinates = SMatrix<f64, 3, 3>;
        type Motion = SMatrix<f64, 3, 3>;
        const IS_SHORT: bool = true;

        #[inline(always)]
        fn motion(&self, d: &SMatrix<f64, 3, 3>, _: impl FnOnce() -> SMatrix<f64, 3, 3>) -> SMatrix<f64, 3, 3> {
            *d
        }

        /// The solution is F − I itself.
        #[inline]
        fn increment(&self, d: &SMatrix<f64, 3, 3>) -> SMatrix<f64, 3, 3> {
            *d
        }

        /// I + D
        #[inline]
        fn element(d: &SMatrix<f64, 3, 3>) -> SMatrix<f64, 3, 3> {
            ::clebsch::__private::from_increment(d)
        }

        /// q⁺ = q + Dq
        #[inline]
        fn advance(&self, q: &SVector<f64, 3>, d: &SMatrix<f64, 3, 3>) -> SVector<f64, 3> {
            q + d * q
        }

        /// F p
        #[inline]
        fn lift(&self, _: &SVector<f64, 3>, p: &SVector<f64, 3>, d: &SMatrix<f64, 3, 3>) -> SVector<f64, 3> {
            p + d * p
        }
    }

    impl ::clebsch::__private::Substep<0> for DrivenPendulum {
        /// −(h/2) J(q, ∇V(t, q))
        #[inline]
        fn start_kick(
            &self,
            constants: &Constants,
            t: f64,
            q: &SVector<f64, 3>,
        ) -> ::core::option::Option<SVector<f64, 3>> {
            Some(moment(self, t, q) * -constants.half_h)
        }

        /// −(h/2) J(q⁺, ∇V(t + h, q⁺))
        #[inline]
        fn end_kick(
            &self,
            constants: &Constants,
            t: f64,
            q: &SVector<f64, 3>,
        ) -> ::core::option::Option<SVector<f64, 3>> {
            Some(moment(self, t + constants.h, q) * -constants.half_h)
        }

        /// −(h/2) ∇V(t)
        #[inline]
        fn start_gradient(
            &self,
            constants: &Constants,
            t: f64,
            q: &SVector<f64, 3>,
        ) -> ::core::option::Option<SVector<f64, 3>> {
            let _ = q;
            Some(gradient(self, t) * -constants.half_h)
        }

        /// −(h/2) ∇V(t + h)
        #[inline]
        fn end_gradient(
            &self,
            constants: &Constants,
            t: f64,
            q: &SVector<f64, 3>,
        ) -> ::core::option::Option<SVector<f64, 3>> {
            let _ = q;
            Some(gradient(self, t + constants.h) * -constants.half_h)
        }

        /// π^ = mass·length² (F − Fᵀ)/(2h)
        #[inline]
        fn solve(
            &self,
            constants: &Constants,
            _: f64,
            _: &SVector<f64, 3>,
            mu: &SVector<f64, 3>,
            (): &(),
        ) -> ::core::result::Result<SMatrix<f64, 3, 3>, ::clebsch::Error> {
            increment(constants, mu)
        }
    }

    impl ::clebsch::__private::Varied<3> for DrivenPendulum {
        type Slopes = ();
    }

    impl ::clebsch::__private::VariedSubstep<0, 3> for DrivenPendulum {
        /// ℓd = c|D|²/2 − (h/2)(V(t, q) + V(t + h, q⁺)), c = mass·length²/(2h), g = (h/2)∇V(t), g⁺ = (h/2)∇V(t + h):
        ///
        /// ∂N/∂η = −c(tr(F)I − Fᵀ) + qgᵀ − (q·g)I, ∂N/∂η′ = c(tr(F)I − F)
        ///
        /// ∂N⁺/∂η′ = c(tr(F)I − F) − q⁺g⁺ᵀ + (q⁺·g⁺)I
        #[inline]
        fn edge(
            &self,
            constants: &Constants,
            t: f64,
            (q, d, next, _u): ::clebsch::Ends<'_, Self>,
        ) -> ::clebsch::Edge<f64, 3> {
            let c = 0.5 / constants.h_by_inertia;
            let (g, g_next) =
                (gradient(self, t) * constants.half_h, gradient(self, t + constants.h) * constants.half_h);
            let identity = SMatrix::<f64, 3, 3>::identity();
            let turning = (identity * (2.0 + d.trace()) - d) * c;
            ::clebsch::Edge {
                lagrangian: d.norm_squared() * (0.5 * c) - g.dot(q) - g_next.dot(next),
                before: components(d) * c + q.cross(&g),
                after: components(d) * c - next.cross(&g_next),
                before_by_start: q * g.transpose() - turning.transpose() - identity * q.dot(&g),
                before_by_end: turning,
                after_by_start: -turning.transpose(),
                after_by_end: turning - next * g_next.transpose() + identity * next.dot(&g_next),
            }
        }

        /// ℓd, N and N⁺ of the edge.
        #[inline]
        fn momenta(
            &self,
            constants: &Constants,
            t: f64,
            (q, d, next, _u): ::clebsch::Ends<'_, Self>,
        ) -> ::clebsch::Momenta<f64, 3> {
            let (c, half_h) = (0.5 / constants.h_by_inertia, constants.half_h);
            let height = (gradient(self, t).dot(q) + gradient(self, t + constants.h).dot(next)) * half_h;
            ::clebsch::Momenta {
                lagrangian: d.norm_squared() * (0.5 * c) - height,
                before: components(d) * c + moment(self, t, q) * half_h,
                after: components(d) * c - moment(self, t + constants.h, next) * half_h,
            }
        }

        /// η′ = Fη, ∂N/∂η = qgᵀ − (q·g)I, ∂N⁺/∂η = ((q⁺·g⁺)I − q⁺g⁺ᵀ)F
        #[inline]
        fn carried(
            &self,
            constants: &Constants,
            t: f64,
            (q, d, next, u): ::clebsch::Ends<'_, Self>,
        ) -> ::clebsch::Carried<f64, 3> {
            let (g, g_next) =
                (gradient(self, t) * constants.half_h, gradient(self, t + constants.h) * constants.half_h);
            let edge = ::clebsch::__private::VariedSubstep::<0, 3>::edge(self, constants, t, (q, d, next, u));
            let identity = SMatrix::<f64, 3, 3>::identity();
            let adjoint = identity + d;
            ::clebsch::Carried {
                momentum: edge.after,
                adjoint,
                before: q * g.transpose() - identity * q.dot(&g),
                after: (identity * next.dot(&g_next) - next * g_next.transpose()) * adjoint,
                before_by_end: edge.before_by_end,
                after_by_end: edge.after_by_end,
            }
        }

        fn slopes(&self, _: &Constants, _: f64, _: ::clebsch::Ends<'_, Self>) {}
    }

    /// mass·length²
    #[inline]
    fn inertia(pendulum: &DrivenPendulum) -> f64 {
        pendulum.mass * pendulum.length * pendulum.length
    }

    /// ∇V(t)
    #[inline]
    fn gradient(pendulum: &DrivenPendulum, t: f64) -> SVector<f64, 3> {
        let acceleration = pendulum.gravity + pendulum.shake * ::clebsch::Scalar::cos(pendulum.rate * t);
        vector([0.0, 0.0, pendulum.mass * pendulum.length * acceleration])
    }

    /// J(q, ∇V(t))
    #[inline]
    fn moment(pendulum: &DrivenPendulum, t: f64, q: &SVector<f64, 3>) -> SVector<f64, 3> {
        q.cross(&gradient(pendulum, t))
    }

    /// F − I = A + A²/(1 + √(1 − |a|²)), A = a^, a = h π / (mass·length²)
    #[inline]
    fn increment(
        constants: &Constants,
        kicked: &SVector<f64, 3>,
    ) -> ::core::result::Result<SMatrix<f64, 3, 3>, ::clebsch::Error> {
        let a = kicked * constants.h_by_inertia;
        let sine_squared = a.norm_squared();
        let a = ::clebsch::__private::below_right_angle(a, sine_squared)?;
        let a = a.cross_matrix();
        Ok(a + a * a / (1.0 + ::clebsch::Scalar::sqrt(1.0 - sine_squared)))
    }

    /// The momenta J(q, p) of all p: rows J(q, e_i).
    #[inline]
    fn momenta(q: &SVector<f64, 3>) -> [[f64; 3]; 3] {
        [[0.0, q.z, -q.y], [-q.z, 0.0, q.x], [q.y, -q.x, 0.0]]
    }

    /// ⟨A, E_i⟩, E_i = e_i^
    #[inline]
    fn components(a: &SMatrix<f64, 3, 3>) -> SVector<f64, 3> {
        vector([a[(2, 1)] - a[(1, 2)], a[(0, 2)] - a[(2, 0)], a[(1, 0)] - a[(0, 1)]])
    }
};
