//! `FreeRigidBody` of the gallery as its derive macro is meant to expand it.

use nalgebra::Matrix3;

/// A free rigid body: the usual inertia tensor is enough.
#[derive(Clone, Debug)]
pub struct FreeRigidBody {
    /// Inertia tensor about the centre of mass, body frame, kg·m².
    pub inertia: Matrix3<f64>,
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
        /// 2J with J = tr(𝒥)I − 𝒥, here twice the inertia tensor: Dρ at the identity.
        twice_inertia: SMatrix<f64, 3, 3>,
        /// Σ⁻¹ = J⁻¹
        inertia_inverse: SMatrix<f64, 3, 3>,
        /// Sign of det 2J, kept along the branch of solutions.
        orientation: ::clebsch::__private::Orientation,
    }

    #[automatically_derived]
    impl ::clebsch::Clebsch for FreeRigidBody {
        type Scalar = f64;
        type Configuration = SMatrix<f64, 3, 3>;
        type Element = SMatrix<f64, 3, 3>;
        type Momentum = SVector<f64, 3>;
        type MomentumMatrix = SMatrix<f64, 3, 3>;
        type Impulse = ();
        type Constants = Constants;
        const NAME: &'static str = "FreeRigidBody";
        const ORDER: u32 = 2;
        const DERIVATION: &'static str = "a hand expansion";

        /// 𝒥 = ½tr(J)I − J, J = `self.inertia`; Σ = tr(𝒥)I − 𝒥 = J.
        fn constants(&self, h: f64) -> ::core::result::Result<Constants, ::clebsch::Error> {
            ::clebsch::__private::check_finite("inertia", &self.inertia)?;
            ::clebsch::__private::check_symmetric("inertia", &self.inertia)?;
            let mut constants = Constants {
                h,
                half_h: h / 2.0,
                twice_inertia: self.inertia * 2.0,
                inertia_inverse: ::clebsch::__private::invert(&self.inertia)?,
                orientation: ::clebsch::__private::Orientation::Positive,
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

        /// T*R_F ∂_F ℓd: π^ = (F𝒥 − 𝒥Fᵀ)/h
        fn legendre(&self, h: f64, _r: &SMatrix<f64, 3, 3>, f: &SMatrix<f64, 3, 3>) -> SVector<f64, 3> {
            components(&(f * mass_matrix(&self.inertia))) / h
        }

        /// T*L_F ∂_F ℓd: π⁺^ = (𝒥F − Fᵀ𝒥)/h
        fn legendre_next(&self, h: f64, _r: &SMatrix<f64, 3, 3>, f: &SMatrix<f64, 3, 3>) -> SVector<f64, 3> {
            components(&(mass_matrix(&self.inertia) * f)) / h
        }

        /// F with π^ = (F𝒥 − 𝒥Fᵀ)/h
        #[inline]
        fn inverse_legendre(
            &self,
            constants: &Constants,
            _r: &SMatrix<f64, 3, 3>,
            mu: &SVector<f64, 3>,
        ) -> ::core::result::Result<SMatrix<f64, 3, 3>, ::clebsch::Error> {
            let c = ::clebsch::__private::solve(&Equation { constants }, mu)?;
            Ok(SMatrix::<f64, 3, 3>::identity() + increment(&c))
        }

        #[inline]
        fn impulse(&self, _constants: &Constants, _r: &SMatrix<f64, 3, 3>) {}

        /// R⁺ = R F = R + R(F − I), π⁺ = Fᵀπ = π + (F − I)ᵀπ
        #[inline]
        fn step(
            &self,
            constants: &Constants,
            r: &SMatrix<f64, 3, 3>,
            mu: &SVector<f64, 3>,
            _impulse: &(),
        ) -> ::core::result::Result<(SMatrix<f64, 3, 3>, SVector<f64, 3>, ()), ::clebsch::Error> {
            let c = ::clebsch::__private::solve(&Equation { constants }, mu)?;
            let motion = increment(&c);
            Ok((r + r * motion, mu + motion.tr_mul(mu), ()))
        }

        /// R⁺ = R F, P⁺ = P F⁻ᵀ = P F
        #[inline]
        fn step_symmetric(
            &self,
            constants: &Constants,
            r: &SMatrix<f64, 3, 3>,
            p: &SMatrix<f64, 3, 3>,
        ) -> ::core::result::Result<(SMatrix<f64, 3, 3>, SMatrix<f64, 3, 3>), ::clebsch::Error> {
            let c = ::clebsch::__private::solve(&Equation { constants }, &self.momentum_map(r, p))?;
            let motion = increment(&c);
            Ok((r + r * motion, p + p * motion))
        }

        /// V = 0
        #[inline]
        fn potential(&self, _r: &SMatrix<f64, 3, 3>) -> f64 {
            0.0
        }

        /// ½ π·J⁻¹π
        #[inline]
        fn kinetic_energy(&self, constants: &Constants, mu: &SVector<f64, 3>) -> f64 {
            0.5 * mu.dot(&(constants.inertia_inverse * mu))
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
        fn orbit_defect(r: &SMatrix<f64, 3, 3>) -> f64 {
            if r.determinant() < 0.0 {
                return f64::INFINITY;
            }
            ::clebsch::Space::max_abs(&(r.tr_mul(r) - SMatrix::<f64, 3, 3>::identity()))
        }

        /// The action is free.
        #[inline]
        fn isotropy_defect(_r: &SMatrix<f64, 3, 3>, _mu: &SVector<f64, 3>) -> f64 {
            0.0
        }
    }

    /// The implicit equation h π^ = F𝒥 − 𝒥Fᵀ in the Cayley chart F = (I − Z)⁻¹(I + Z), Z = c^, c = tan(θ/2) n, cleared of
    /// denominators: (I − Z)(F𝒥 − 𝒥Fᵀ − hπ^)(I + Z) = ρ^ with
    ///
    /// ρ(c) = 2Jc − a + c×a − (a·c)c, a = hπ.
    struct Equation<'a> {
        constants: &'a Constants,
    }

    #[automatically_derived]
    impl ::clebsch::__private::Equation<f64, 3> for Equation<'_> {
        /// a = hπ
        type Terms = [f64; 3];

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

    /// 𝒥 = ½tr(J)I − J
    #[inline]
    fn mass_matrix(inertia: &SMatrix<f64, 3, 3>) -> SMatrix<f64, 3, 3> {
        SMatrix::<f64, 3, 3>::identity() * (0.5 * inertia.trace()) - inertia
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
