//! `HeavyTop` of the gallery as its derive macro is meant to expand it.

use nalgebra::{Matrix3, Vector3};

/// A rigid body turning about a fixed pivot in uniform gravity.
#[derive(Clone, Debug)]
pub struct HeavyTop {
    /// Nonstandard inertia 𝒥 = ½tr(J)I − J, kg·m².
    pub mass_matrix: Matrix3<f64>,
    /// m·g, newtons.
    pub weight: f64,
    /// Centre of mass in the body frame, metres.
    pub center: Vector3<f64>,
}

const _: () = {
    use ::clebsch::__private::{SMatrix, SVector, matrix, vector};

    /// Computed once per stepper.
    #[derive(Clone, Debug)]
    pub struct Constants {
        /// Step size h.
        h: f64,
        /// h / 2
        half_h: f64,
        /// 2J with J = tr(𝒥)I − 𝒥: Dρ at the identity.
        twice_inertia: SMatrix<f64, 3, 3>,
        /// Σ⁻¹ = J⁻¹
        inertia_inverse: SMatrix<f64, 3, 3>,
        /// (h/2)·weight·center
        moment: SVector<f64, 3>,
        /// Sign of det 2J, constant along the branch of solutions.
        orientation: ::clebsch::__private::Orientation,
    }

    #[automatically_derived]
    impl ::clebsch::Clebsch for HeavyTop {
        type Scalar = f64;
        type Configuration = SMatrix<f64, 3, 3>;
        type Element = SMatrix<f64, 3, 3>;
        type Momentum = SVector<f64, 3>;
        type MomentumMatrix = SMatrix<f64, 3, 3>;
        type Input = ();
        type Constants = Constants;
        type Scheme = ::clebsch::__private::KickDriftKick<::clebsch::__private::Shared>;
        type Time = ();
        const NAME: &'static str = "HeavyTop";
        const ORDER: u32 = 2;
        const DERIVATION: &'static str = "a hand expansion";

        /// Σ = J = tr(𝒥)I − 𝒥, 𝒥 = `self.mass_matrix`
        fn constants(&self, h: f64) -> ::core::result::Result<Constants, ::clebsch::Error> {
            ::clebsch::__private::check_finite("mass_matrix", &self.mass_matrix)?;
            ::clebsch::__private::check_finite("weight", &self.weight)?;
            ::clebsch::__private::check_finite("center", &self.center)?;
            ::clebsch::__private::check_symmetric("mass_matrix", &self.mass_matrix)?;
            let inertia = SMatrix::<f64, 3, 3>::identity() * self.mass_matrix.trace() - self.mass_matrix;
            let mut constants = Constants {
                h,
                half_h: h / 2.0,
                twice_inertia: inertia * 2.0,
                inertia_inverse: ::clebsch::__private::invert(&inertia)?,
                moment: self.center * (self.weight * h / 2.0),
                orientation: ::clebsch::__private::Orientation::POSITIVE,
            };
            constants.orientation = ::clebsch::__private::orientation(&Equation { constants: &constants })?;
            Ok(constants)
        }

        /// Φ_F(R) = R F
        #[inline]
        fn act(&self, f: &SMatrix<f64, 3, 3>, r: &SMatrix<f64, 3, 3>) -> SMatrix<f64, 3, 3> {
            r * f
        }

        /// J(R, P)_i = ⟨P, R E_i⟩ = ⟨RᵀP, E_i⟩
        #[inline]
        fn momentum_map(&self, r: &SMatrix<f64, 3, 3>, p: &SMatrix<f64, 3, 3>) -> SVector<f64, 3> {
            components(&r.tr_mul(p))
        }

        /// Ad*_F π = Fᵀπ
        #[inline]
        fn coadjoint(&self, f: &SMatrix<f64, 3, 3>, mu: &SVector<f64, 3>) -> SVector<f64, 3> {
            f.tr_mul(mu)
        }

        /// T*R_F ∂_F ℓd − J(R, ∂_R ℓd): N^ = (F𝒥 − 𝒥Fᵀ)/h + (h/2)(center × Γ)^·weight, Γ = Rᵀe₃
        fn legendre(&self, h: f64, _t: f64, r: &SMatrix<f64, 3, 3>, f: &SMatrix<f64, 3, 3>) -> SVector<f64, 3> {
            components(&(f * self.mass_matrix)) / h - torque(&(self.center * (self.weight * h / 2.0)), r)
        }

        /// T*L_F ∂_F ℓd: N⁺^ = (𝒥F − Fᵀ𝒥)/h − (h/2)(center × Γ⁺)^·weight, Γ⁺ = (R F)ᵀe₃
        fn legendre_next(&self, h: f64, _t: f64, r: &SMatrix<f64, 3, 3>, f: &SMatrix<f64, 3, 3>) -> SVector<f64, 3> {
            components(&(self.mass_matrix * f)) / h + torque(&(self.center * (self.weight * h / 2.0)), &(r * f))
        }

        /// V(R) = weight·(R center)₃
        #[inline]
        fn potential(&self, _t: f64, r: &SMatrix<f64, 3, 3>) -> f64 {
            self.weight * (r * self.center).z
        }

        /// ½ π·J⁻¹π
        #[inline]
        fn kinetic_energy(&self, constants: &Constants, _t: f64, _r: &SMatrix<f64, 3, 3>, mu: &SVector<f64, 3>) -> f64 {
            ::clebsch::__private::kinetic_energy(&constants.inertia_inverse, mu)
        }

        /// M = ½ π^
        #[inline]
        fn momentum_matrix(mu: &SVector<f64, 3>) -> SMatrix<f64, 3, 3> {
            hat(mu) * 0.5
        }

        /// π_i = ⟨M, E_i⟩
        #[inline]
        fn momentum_components(m: &SMatrix<f64, 3, 3>) -> SVector<f64, 3> {
            components(m)
        }

        /// Largest entry of |RᵀR − I|, infinite for det R < 0.
        fn orbit_defect(&self, r: &SMatrix<f64, 3, 3>) -> f64 {
            ::clebsch::__private::orthogonality_defect(r)
        }
    }

    #[automatically_derived]
    impl ::clebsch::Conserves for HeavyTop {
        type Conserved = ::clebsch::Conserved<f64, 1>;
        const CONSERVED_NAMES: &'static [&'static str] = &["about e3, spatial"];

        /// (R π)₃
        #[inline]
        fn conserved(&self, r: &SMatrix<f64, 3, 3>, mu: &SVector<f64, 3>) -> ::clebsch::Conserved<f64, 1> {
            ::clebsch::Conserved::new(["about e3, spatial"], [(r * mu).z])
        }
    }

    #[automatically_derived]
    impl ::clebsch::Variational<3> for HeavyTop {
        /// cay(η) − I, cay(−η) − I
        #[inline]
        fn retractions(&self, eta: &SVector<f64, 3>) -> [SMatrix<f64, 3, 3>; 2] {
            let c = eta * 0.5;
            [increment(&c), increment(&-c)]
        }

        /// F₁F₂ − I
        #[inline]
        fn compose(&self, first: &SMatrix<f64, 3, 3>, second: &SMatrix<f64, 3, 3>) -> SMatrix<f64, 3, 3> {
            first + second + first * second
        }

        /// R + RD
        #[inline]
        fn advance(&self, r: &SMatrix<f64, 3, 3>, d: &SMatrix<f64, 3, 3>) -> SMatrix<f64, 3, 3> {
            ::clebsch::__private::Parts::advance(self, r, d)
        }

        /// ξ_Q
        fn infinitesimal_motion(&self, r: &SMatrix<f64, 3, 3>, xi: &SVector<f64, 3>) -> SMatrix<f64, 3, 3> {
            r * hat(xi)
        }

        /// ⟨R E_i, R E_j⟩
        #[inline]
        fn orbit_metric(&self, _r: &SMatrix<f64, 3, 3>) -> SMatrix<f64, 3, 3> {
            SMatrix::<f64, 3, 3>::identity() * 2.0
        }

        /// ⟨target − R, R E_i⟩
        #[inline]
        fn approach(&self, r: &SMatrix<f64, 3, 3>, target: &SMatrix<f64, 3, 3>) -> SVector<f64, 3> {
            components(&r.tr_mul(&(target - r)))
        }
    }

    impl ::clebsch::__private::Parts for HeavyTop {
        type Sums = ::clebsch::__private::Plain;
        type Coordinates = SVector<f64, 3>;
        type Motion = SMatrix<f64, 3, 3>;
        const IS_SHORT: bool = true;

        #[inline(always)]
        fn motion(&self, _: &SVector<f64, 3>, increment: impl FnOnce() -> SMatrix<f64, 3, 3>) -> SMatrix<f64, 3, 3> {
            increment()
        }

        /// F − I
        #[inline]
        fn increment(&self, c: &SVector<f64, 3>) -> SMatrix<f64, 3, 3> {
            increment(c)
        }

        /// I + D
        #[inline]
        fn element(d: &SMatrix<f64, 3, 3>) -> SMatrix<f64, 3, 3> {
            ::clebsch::__private::from_increment(d)
        }

        /// R⁺ = R F = R + R(F − I)
        #[inline]
        fn advance(&self, r: &SMatrix<f64, 3, 3>, d: &SMatrix<f64, 3, 3>) -> SMatrix<f64, 3, 3> {
            r + r * d
        }

        /// P F⁻ᵀ = P + P(F − I)
        #[inline]
        fn lift(&self, _: &SMatrix<f64, 3, 3>, p: &SMatrix<f64, 3, 3>, d: &SMatrix<f64, 3, 3>) -> SMatrix<f64, 3, 3> {
            p + p * d
        }
    }

    impl ::clebsch::__private::Substep<0> for HeavyTop {
        /// −(h/2) J(R, ∇V) = (h/2)·weight·Γ × center, Γ = Rᵀe₃
        #[inline]
        fn start_kick(
            &self,
            constants: &Constants,
            _: f64,
            r: &SMatrix<f64, 3, 3>,
        ) -> ::core::option::Option<SVector<f64, 3>> {
            Some(torque(&constants.moment, r))
        }

        /// The same at R⁺.
        #[inline]
        fn end_kick(
            &self,
            constants: &Constants,
            _: f64,
            r: &SMatrix<f64, 3, 3>,
        ) -> ::core::option::Option<SVector<f64, 3>> {
            Some(torque(&constants.moment, r))
        }

        /// −(h/2) ∇V
        #[inline]
        fn start_gradient(
            &self,
            constants: &Constants,
            _: f64,
            _: &SMatrix<f64, 3, 3>,
        ) -> ::core::option::Option<SMatrix<f64, 3, 3>> {
            Some(-half_gradient(constants))
        }

        /// −(h/2) ∇V
        #[inline]
        fn end_gradient(
            &self,
            constants: &Constants,
            _: f64,
            _: &SMatrix<f64, 3, 3>,
        ) -> ::core::option::Option<SMatrix<f64, 3, 3>> {
            Some(-half_gradient(constants))
        }

        /// π^ = (F𝒥 − 𝒥Fᵀ)/h
        #[inline]
        fn solve(
            &self,
            constants: &Constants,
            _: f64,
            _: &SMatrix<f64, 3, 3>,
            mu: &SVector<f64, 3>,
            (): &(),
        ) -> ::core::result::Result<SVector<f64, 3>, ::clebsch::Error> {
            ::clebsch::__private::solve(&Equation { constants }, mu)
        }

        /// Fᵀπ = π + (F − I)ᵀπ
        #[inline]
        fn update(
            &self,
            _: &Constants,
            _: f64,
            _: &SMatrix<f64, 3, 3>,
            mu: &SVector<f64, 3>,
            d: &SMatrix<f64, 3, 3>,
        ) -> ::core::option::Option<SVector<f64, 3>> {
            Some(mu + d.tr_mul(mu))
        }
    }

    impl ::clebsch::__private::Varied<3> for HeavyTop {
        type Slopes = ();
    }

    impl ::clebsch::__private::VariedSubstep<0, 3> for HeavyTop {
        /// ℓd = tr(D𝒥Dᵀ)/(2h) − (h/2)(V(R) + V(R⁺)), A = F𝒥, m = (h/2)·weight·center:
        ///
        /// ∂N/∂η = (A − tr(A)I)/h − (Γ·m)I + Γmᵀ, ∂N/∂η′ = (tr(A)I − A)F/h
        ///
        /// ∂N⁺/∂η′ = (tr(A)I − Fᵀ𝒥)/h + (Γ⁺·m)I − Γ⁺mᵀ
        #[inline]
        fn edge(
            &self,
            constants: &Constants,
            _t: f64,
            (r, d, _next, _u): ::clebsch::Ends<'_, Self>,
        ) -> ::clebsch::Edge<f64, 3> {
            let (by_h, m) = (1.0 / constants.h, &constants.moment);
            let (turned, turning) = (d * self.mass_matrix, self.mass_matrix * d);
            let gamma = vector([r[(2, 0)], r[(2, 1)], r[(2, 2)]]);
            let gamma_next = gamma + d.tr_mul(&gamma);
            let identity = SMatrix::<f64, 3, 3>::identity();
            let trace = identity * (self.mass_matrix.trace() + turned.trace());
            let inertia = (trace - self.mass_matrix - turned) * by_h;
            let before_by_end = inertia + inertia * d;
            ::clebsch::Edge {
                lagrangian: d.dot(&turned) * (0.5 * by_h) - gamma.dot(m) - gamma_next.dot(m),
                before: components(&turned) * by_h - gamma.cross(m),
                after: components(&turning) * by_h + gamma_next.cross(m),
                before_by_start: gamma * m.transpose() - inertia - identity * gamma.dot(m),
                before_by_end,
                after_by_start: -before_by_end.transpose(),
                after_by_end: (trace - self.mass_matrix - turning.transpose()) * by_h + identity * gamma_next.dot(m)
                    - gamma_next * m.transpose(),
            }
        }

        /// ℓd, N and N⁺ of the edge.
        #[inline]
        fn momenta(
            &self,
            constants: &Constants,
            _t: f64,
            (r, d, next, _u): ::clebsch::Ends<'_, Self>,
        ) -> ::clebsch::Momenta<f64, 3> {
            let (by_h, m) = (1.0 / constants.h, &constants.moment);
            let turned = d * self.mass_matrix;
            let height = (r + next).row(2).transpose().dot(m);
            ::clebsch::Momenta {
                lagrangian: d.dot(&turned) * (0.5 * by_h) - height,
                before: components(&turned) * by_h - torque(m, r),
                after: components(&(self.mass_matrix * d)) * by_h + torque(m, next),
            }
        }

        /// η′ = Fᵀη, ∂N/∂η = Γmᵀ − (Γ·m)I, ∂N⁺/∂η = ((Γ⁺·m)I − Γ⁺mᵀ)Fᵀ
        #[inline]
        fn carried(
            &self,
            constants: &Constants,
            t: f64,
            (r, d, next, u): ::clebsch::Ends<'_, Self>,
        ) -> ::clebsch::Carried<f64, 3> {
            let m = &constants.moment;
            let gamma = vector([r[(2, 0)], r[(2, 1)], r[(2, 2)]]);
            let gamma_next = gamma + d.tr_mul(&gamma);
            let edge = ::clebsch::__private::VariedSubstep::<0, 3>::edge(self, constants, t, (r, d, next, u));
            let identity = SMatrix::<f64, 3, 3>::identity();
            let adjoint = identity + d.transpose();
            ::clebsch::Carried {
                momentum: edge.after,
                adjoint,
                before: gamma * m.transpose() - identity * gamma.dot(m),
                after: (identity * gamma_next.dot(m) - gamma_next * m.transpose()) * adjoint,
                before_by_end: edge.before_by_end,
                after_by_end: edge.after_by_end,
            }
        }

        fn slopes(&self, _: &Constants, _: f64, _: ::clebsch::Ends<'_, Self>) {}
    }

    /// The implicit equation h π^ = F𝒥 − 𝒥Fᵀ in the Cayley chart F = (I − Z)⁻¹(I + Z), Z = c^, c = tan(θ/2) n. Cleared
    /// of denominators it is (I − Z)(F𝒥 − 𝒥Fᵀ − hπ^)(I + Z) = ρ^ with
    ///
    /// ρ(c) = 2Jc − a + c×a − (a·c)c, a = hπ.
    struct Equation<'a> {
        constants: &'a Constants,
    }

    #[automatically_derived]
    impl ::clebsch::__private::Equation<f64, 3> for Equation<'_> {
        /// a = hπ
        type Terms = [f64; 3];
        type Jacobian = SMatrix<f64, 3, 3>;

        #[inline]
        fn prepare(&self, target: &SVector<f64, 3>) -> [f64; 3] {
            [self.constants.h * target.x, self.constants.h * target.y, self.constants.h * target.z]
        }

        /// c₀ = (h/2) J⁻¹π
        #[inline]
        fn predict(&self, target: &SVector<f64, 3>) -> SVector<f64, 3> {
            self.constants.inertia_inverse * target * self.constants.half_h
        }

        /// ρ(c) = 2Jc − a + c×a − (a·c)c
        ///
        /// Dρ(c) = 2J − a^ − c aᵀ − (a·c)I
        #[inline]
        fn linearize(&self, terms: &[f64; 3], xi: &SVector<f64, 3>) -> (SVector<f64, 3>, SMatrix<f64, 3, 3>) {
            let &[a1, a2, a3] = terms;
            let (c1, c2, c3) = (xi.x, xi.y, xi.z);
            let inertia = &self.constants.twice_inertia;
            let along = a1 * c1 + a2 * c2 + a3 * c3;
            let linear = inertia * xi;
            let residual = vector([
                linear.x - a1 + (c2 * a3 - c3 * a2) - along * c1,
                linear.y - a2 + (c3 * a1 - c1 * a3) - along * c2,
                linear.z - a3 + (c1 * a2 - c2 * a1) - along * c3,
            ]);
            let jacobian = matrix([
                [inertia[(0, 0)] - c1 * a1 - along, inertia[(0, 1)] + a3 - c1 * a2, inertia[(0, 2)] - a2 - c1 * a3],
                [inertia[(1, 0)] - a3 - c2 * a1, inertia[(1, 1)] - c2 * a2 - along, inertia[(1, 2)] + a1 - c2 * a3],
                [inertia[(2, 0)] + a2 - c3 * a1, inertia[(2, 1)] - a1 - c3 * a2, inertia[(2, 2)] - c3 * a3 - along],
            ]);
            (residual, jacobian)
        }

        #[inline]
        fn orientation(&self) -> ::core::option::Option<::clebsch::__private::Orientation> {
            ::core::option::Option::Some(self.constants.orientation)
        }
    }

    /// −J(R, ∇V) scaled: Γ × m, Γ = Rᵀe₃
    #[inline]
    fn torque(m: &SVector<f64, 3>, r: &SMatrix<f64, 3, 3>) -> SVector<f64, 3> {
        let (g1, g2, g3) = (r[(2, 0)], r[(2, 1)], r[(2, 2)]);
        vector([g2 * m.z - g3 * m.y, g3 * m.x - g1 * m.z, g1 * m.y - g2 * m.x])
    }

    /// (h/2) ∇V = e₃ mᵀ, m = (h/2)·weight·center
    #[inline]
    fn half_gradient(constants: &Constants) -> SMatrix<f64, 3, 3> {
        let m = &constants.moment;
        matrix([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [m.x, m.y, m.z]])
    }

    /// F − I = 2/(1 + |c|²) (Z + Z²) = 2/(1 + |c|²) (Z + c cᵀ − |c|²I), without cancellation for small c
    #[inline]
    fn increment(c: &SVector<f64, 3>) -> SMatrix<f64, 3, 3> {
        let (c1, c2, c3) = (c.x, c.y, c.z);
        let (s1, s2, s3) = (c1 * c1, c2 * c2, c3 * c3);
        let weight = 2.0 / (1.0 + s1 + s2 + s3);
        matrix([
            [-weight * (s2 + s3), weight * (c1 * c2 - c3), weight * (c1 * c3 + c2)],
            [weight * (c2 * c1 + c3), -weight * (s1 + s3), weight * (c2 * c3 - c1)],
            [weight * (c3 * c1 - c2), weight * (c3 * c2 + c1), -weight * (s1 + s2)],
        ])
    }

    /// x^ y = x × y
    #[inline]
    fn hat(x: &SVector<f64, 3>) -> SMatrix<f64, 3, 3> {
        matrix([[0.0, -x.z, x.y], [x.z, 0.0, -x.x], [-x.y, x.x, 0.0]])
    }

    /// ⟨A, E_i⟩, E_i = e_i^
    #[inline]
    fn components(a: &SMatrix<f64, 3, 3>) -> SVector<f64, 3> {
        vector([a[(2, 1)] - a[(1, 2)], a[(0, 2)] - a[(2, 0)], a[(1, 0)] - a[(0, 1)]])
    }
};
