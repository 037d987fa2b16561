//! The macro that makes systems and tests of one line for each group.

/// The checks of one group, as tests of its module. Some take systems with a Lagrangian too with the feature `heavy`. `right`, `continuous` and `exponential` make a system and its problem, with a
/// potential of some size; the argument makes the mirror image of the first.
macro_rules! checked {
    ($left:expr) => {
        #[test]
        fn oracle_of_a_cost() {
            let random = &mut Random::new(301);
            let (system, problem) = right(random, 0.3);
            checks::agrees_with_the_oracle(&system, &problem, random);
        }
        #[test]
        fn oracle_of_a_lagrangian() {
            let random = &mut Random::new(302);
            let (system, problem) = continuous(random, 0.3);
            checks::agrees_with_the_oracle(&system, &problem, random);
        }
        #[test]
        fn oracle_of_the_exponential() {
            let random = &mut Random::new(303);
            let (system, problem) = exponential(random, 0.3);
            checks::agrees_with_the_oracle(&system, &problem, random);
        }
        #[test]
        fn order() {
            let random = &mut Random::new(304);
            let (system, problem) = right(random, 0.3);
            checks::is_of_second_order(&system, &problem, random);
            let (system, problem) = continuous(random, 0.3);
            checks::is_of_second_order(&system, &problem, random);
            let (system, problem) = exponential(random, 0.3);
            checks::is_of_second_order(&system, &problem, random);
        }
        #[test]
        fn derivatives() {
            let random = &mut Random::new(305);
            let (system, problem) = right(random, 0.3);
            checks::derivatives_are_those_of_the_closures(&system, &problem, random);
            let (system, problem) = continuous(random, 0.3);
            checks::derivatives_are_those_of_the_closures(&system, &problem, random);
            let (system, problem) = exponential(random, 0.3);
            checks::derivatives_are_those_of_the_closures(&system, &problem, random);
        }
        #[test]
        fn representations() {
            let random = &mut Random::new(306);
            let (system, problem) = right(random, 0.3);
            checks::representations_agree(&system, &problem, random);
            #[cfg(feature = "heavy")]
            {
                let (system, problem) = continuous(random, 0.3);
                checks::representations_agree(&system, &problem, random);
            }
        }
        #[test]
        fn symplecticity() {
            let random = &mut Random::new(307);
            let (system, problem) = right(random, 0.3);
            checks::is_symplectic(&system, &problem, random);
            #[cfg(feature = "heavy")]
            {
                let (system, problem) = continuous(random, 0.3);
                checks::is_symplectic(&system, &problem, random);
            }
        }
        #[test]
        fn conservation() {
            let random = &mut Random::new(308);
            let (system, problem) = right(random, 0.0);
            checks::conserves_the_momentum_of_the_group(&system, &problem, random);
            #[cfg(feature = "heavy")]
            {
                let (system, problem) = continuous(random, 0.0);
                checks::conserves_the_momentum_of_the_group(&system, &problem, random);
            }
        }
        #[test]
        fn left_and_right() {
            let random = &mut Random::new(309);
            let (system, problem) = right(random, 0.3);
            checks::mirrors(&system, &$left(&system), &problem, random);
        }
    };
}

/// Matrix groups. A row has the name of the module, the group, the size of its matrices and its dimension. Then come
/// the discretisation of its Lagrangian, its basis for the oracle, and its declaration.
macro_rules! groups {
    ($($module:ident: [$($group:tt)+], $n:literal, $m:literal, $discretization:ident, $basis:expr $(, {$($declared:tt)*})?;)*) => { $(
        mod $module {
            use super::*;

            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                $($($declared)*)?
                action    = |F: $($group)+, q: $($group)+| q * F,
                cost      = |h, F| (self.weight * (F - I) * (F - I).transpose()).trace() / (2 * h),
                potential = |q| self.linear.dot(&q) + self.cubic.dot(&q).powi(3) / 3,
            )]
            pub struct Right {
                #[clebsch(symmetric)]
                pub weight: SMatrix<f64, $n, $n>,
                pub linear: SMatrix<f64, $n, $n>,
                pub cubic: SMatrix<f64, $n, $n>,
            }

            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                $($($declared)*)?
                action    = |F: $($group)+, q: $($group)+| F * q,
                cost      = |h, F| {
                    let chord = F.inverse() - I;
                    (self.weight * chord * chord.transpose()).trace() / (2 * h)
                },
                potential = |q| self.linear.dot(&q.inverse()) + self.cubic.dot(&q.inverse()).powi(3) / 3,
            )]
            pub struct Left {
                #[clebsch(symmetric)]
                pub weight: SMatrix<f64, $n, $n>,
                pub linear: SMatrix<f64, $n, $n>,
                pub cubic: SMatrix<f64, $n, $n>,
            }

            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                $($($declared)*)?
                action         = |F: $($group)+, q: $($group)+| q * F,
                lagrangian     = |xi| xi.dot(&(self.inertia * xi)) / 2,
                potential      = |q| self.linear.dot(&q) + self.cubic.dot(&q).powi(3) / 3,
                discretization = $discretization,
            )]
            pub struct Continuous {
                pub inertia: SMatrix<f64, $m, $m>,
                pub linear: SMatrix<f64, $n, $n>,
                pub cubic: SMatrix<f64, $n, $n>,
            }

            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                $($($declared)*)?
                action         = |F: $($group)+, q: $($group)+| q * F,
                lagrangian     = |xi| xi.dot(&(self.inertia * xi)) / 2,
                potential      = |q| self.linear.dot(&q) + self.cubic.dot(&q).powi(3) / 3,
                discretization = exponential,
            )]
            pub struct Exponential {
                pub inertia: SMatrix<f64, $m, $m>,
                pub linear: SMatrix<f64, $n, $n>,
                pub cubic: SMatrix<f64, $n, $n>,
            }

            fn problem(kinetic: Kinetic, linear: &SMatrix<f64, $n, $n>, cubic: &SMatrix<f64, $n, $n>) -> OnItself {
                OnItself { group: $basis, kind: Kind::Matrix, kinetic, linear: Matrix::from(linear), cubic: Matrix::from(cubic) }
            }
            fn right(random: &mut Random, size: f64) -> (Right, OnItself) {
                let (linear, cubic) = (random.matrix() * size, random.matrix() * size);
                let weight = random.inertia();
                (Right { weight, linear, cubic }, problem(Kinetic::Chord(Matrix::from(&weight)), &linear, &cubic))
            }
            fn continuous(random: &mut Random, size: f64) -> (Continuous, OnItself) {
                let (linear, cubic) = (random.matrix() * size, random.matrix() * size);
                let inertia = random.inertia();
                let kinetic = Kinetic::of(stringify!($discretization), Matrix::from(&inertia));
                (Continuous { inertia, linear, cubic }, problem(kinetic, &linear, &cubic))
            }
            fn exponential(random: &mut Random, size: f64) -> (Exponential, OnItself) {
                let (linear, cubic) = (random.matrix() * size, random.matrix() * size);
                let inertia = random.inertia();
                let kinetic = Kinetic::Exponential(Matrix::from(&inertia));
                (Exponential { inertia, linear, cubic }, problem(kinetic, &linear, &cubic))
            }
            checked!(|right: &Right| Left { weight: right.weight, linear: right.linear, cubic: right.cubic });
        }
    )* };
}
