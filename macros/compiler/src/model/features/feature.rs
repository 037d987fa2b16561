//! Features of a declaration that do not go with everything.

/// The features with their names in messages and docs.
macro_rules! features {
    ($($feature:ident $words:literal,)+) => {
        /// A feature: a key, a value of a dial, or a property that a stage finds in a declaration.
        #[derive(Copy, Clone, PartialEq, Eq, Debug)]
        pub(crate) enum Feature {
            $($feature,)+
        }

        impl Feature {
            /// As messages and docs call it.
            pub fn words(self) -> &'static str {
                [$($words,)+][self as usize]
            }

            /// Whether it is a key of this name.
            pub fn is_key(self, name: &str) -> bool {
                self.words().strip_prefix('`').and_then(|word| word.strip_suffix('`')) == Some(name)
            }

            /// Whether it is a key of this name, a value of one, or a declaration by one.
            pub fn belongs_to(self, name: &str) -> bool {
                match self {
                    Feature::OpaquePotential => name == "potential",
                    Feature::OtherDiscretization => name == "discretization",
                    Feature::Forces => ["force", "force_on"].contains(&name),
                    Feature::Inputs => ["controls", "dynamics", "effort"].contains(&name),
                    _ => {
                        let behind = self.words().strip_prefix('`').and_then(|words| words.strip_prefix(name));
                        behind.is_some_and(|behind| behind.starts_with(['`', ' ']))
                    }
                }
            }
        }
    };
}

features! {
    // keys
    Action "`action`",
    Cost "`cost`",
    Lagrangian "`lagrangian`",
    Potential "`potential`",
    Step "`step`",
    Force "`force`",
    ForceOn "`force_on`",
    Constraint "`constraint`",
    Symmetry "`symmetry`",
    Field "`space`",
    Controls "`controls`",
    Dynamics "`dynamics`",
    Effort "`effort`",
    Bounds "`bounds`",
    Endpoint "`endpoint`",
    Target "`target`",
    VelocityOfEnd "a velocity in `endpoint`",
    VelocityOfTarget "a velocity in `target`",
    ReferenceOfEnd "a reference in `endpoint`",
    Isotropy "`isotropy`",
    Signature "`signature`",
    Order "`order`",
    Discretization "`discretization`",
    Chart "`chart`",
    Tolerance "`tolerance`",
    Iterations "`iterations`",
    Summation "`summation`",
    Method "`method`",
    // values of keys
    OpaquePotential "an opaque potential",
    FreeIsotropy "`isotropy = free`",
    IndefiniteSignature "`signature = indefinite`",
    FirstOrder "`order = 1`",
    Composition "`order = 4`, `6` or `8`",
    Sixteenth "`order = 16`",
    ExactDiscretization "`discretization = exact`",
    MoserVeselov "`discretization = moser_veselov`",
    OtherDiscretization "another discretization than `exponential` and `cayley`",
    CayleyDiscretization "`discretization = cayley`",
    CayleyChart "`chart = cayley`",
    ExponentialChart "`chart = exponential`",
    Matrices "`code = matrices`",
    Tangent "`emit = [tangent]`",
    Boundary "`emit = [boundary]`",
    Momentum "`emit = [momentum]`",
    Connection "`emit = [connection]`",
    Midpoint "`emit = [midpoint]`",
    VelocityConstraint "a constraint with a velocity",
    Joints "joints between the sites of a power",
    StaticField "a field without a cost",
    EndsOfEdges "an energy of both ends of an edge",
    // groups and spaces
    Power "a power",
    Forces "forces",
    Quaternions "a system of quaternions",
    LargeGroup "rotations of unit vectors in more than 64 dimensions",
    NoCayleyMap "a group without a Cayley map",
    NoLogarithmSlope "a logarithm whose derivative has no formula",
    UnknownFreeMotion "a group whose free motion is not known",
    RotationsOfFourSpace "`SO<4>` with a potential or another factor",
    FreeMotionOfFourSpace "`discretization = exact` on `SO<4>`",
    UnmovedFactor "a factor that moves nothing",
    FixedConfigurations "an action with motions that fix a configuration",
    // the action
    BentAction "an action that is not affine in the configuration",
    UnliftedMomentum "an action for which no covector of a momentum is known",
    OtherSum "an action that is no sum of the configuration and a change",
    // the kinetic energy
    DependsOnConfiguration "a kinetic energy or a force that depends on the configuration",
    GeneralLagrangian "a non-quadratic Lagrangian",
    CoupledVelocities "a Lagrangian that is no quadratic form of the velocity of each factor",
    MovingInertia "an inertia that is not constant",
    VaryingEnergy "a kinetic energy that is no constant quadratic form of the velocity of each factor",
    OddVelocity "a velocity that is not odd in the group element",
    NoMassMatrix "a Lagrangian without a Moser–Veselov form",
    NoDistributionOfMass "a kinetic energy on `SO<4>` that no distribution of mass has",
    AdjointPair "a step that is composed of two",
    // the equation of a step
    ExplicitEquation "a step that is solved without iteration",
    FreeMotion "a free motion that is found once for all steps",
    FreeRotation "a free rotation",
    ExactDrifts "an exact drift",
    Collocation "`order = 16`",
    Poles "a momentum equation with poles in that chart",
    Inputs "a choice of inputs",
}
