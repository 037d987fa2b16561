//! Steps against 60-digit integrations of the equations.

use clebsch::{Clebsch, Error};
use nalgebra::{Matrix3, Matrix4, SVector, Vector2, Vector3, Vector5};

mod cayley {
    use clebsch::Clebsch;

    /// The sleigh with velocities by Cayley's map.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |F: SE<2>, q: SE<2>| q * F,
        lagrangian = |xi| (self.inertia * xi.x.powi(2) + self.mass * (xi.y.powi(2) + (xi.z + self.offset * xi.x).powi(2))) / 2,
        constraint = |xi| [xi.z == 0],
    )]
    pub struct Sleigh {
        pub mass: f64,
        pub inertia: f64,
        pub offset: f64,
    }

    /// The ball on a turning table, in the same way.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |(a, W): (Translation<2>, SO<3>), x: Vector2| x + a,
        lagrangian = |(v, w)| self.mass * v.norm_squared() / 2 + self.inertia * w.norm_squared() / 2,
        constraint = |x, (v, w)| [
            v.x - self.radius * w.y == -self.table_rate * x.y,
            v.y + self.radius * w.x == self.table_rate * x.x,
        ],
    )]
    pub struct Ball {
        pub mass: f64,
        pub inertia: f64,
        pub radius: f64,
        pub table_rate: f64,
    }
}

use clebsch_tests::fixtures::{jointed_bodies::JointedBodies, suslov::Suslov};

/// The largest difference of entries.
fn apart<const N: usize>(found: SVector<f64, N>, expected: [f64; N]) -> f64 {
    (found - SVector::from(expected)).amax()
}

#[test]
fn the_sleigh_is_that_of_60_digits() -> Result<(), Error> {
    // (step, (x, y, sin), N)
    let known = [
        (
            1,
            [-0.071227898069074, -0.026541849795602077, 0.4017136671063137],
            [1.11177778356232, -1.0840413348402722, 1.0644680906447743],
        ),
        (
            10,
            [-0.2542255565836214, -0.13565683130051942, 0.9948556659417787],
            [1.3457663475085262, 0.512420298256087, 1.2884996944230571],
        ),
        (
            40,
            [-3.0531501997744357, 0.4576804378980943, -0.1521441620509191],
            [0.07145673435339764, 1.7687800963302815, 0.06841602225325306],
        ),
    ];
    let stepper = cayley::Sleigh { mass: 1.5, inertia: 0.4, offset: 0.6 }.into_stepper(0.1)?;
    let (sin, cos) = 0.3_f64.sin_cos();
    let q = Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0);
    let start = stepper.state(q, Vector3::new(1.034, -1.2, 0.99))?;
    for (steps, place, momentum) in known {
        let state = stepper.advance(&start, steps)?;
        let q = state.configuration();
        assert!(apart(Vector3::new(q[(0, 2)], q[(1, 2)], q[(1, 0)]), place) < 1e-14, "{steps} steps: {q}");
        assert!(apart(state.momentum(), momentum) < 1e-14, "{steps} steps: {}", state.momentum());
    }
    Ok(())
}

#[test]
fn suslovs_body_is_that_of_60_digits() -> Result<(), Error> {
    // (step, diagonal of R, N)
    let known = [
        (
            1,
            [0.9976291790963724, 0.995819066286814, 0.9934482453831865],
            [0.858373514464886, -0.8523209104873006, 0.4127468746594453],
        ),
        (
            10,
            [0.8579622151869625, 0.5395897348063068, 0.3986303707909351],
            [1.064809311660409, -0.4664865813717883, 0.4142503675151736],
        ),
        (
            40,
            [0.5167549143537948, -0.3841679020996294, 0.09029985736113921],
            [1.0691636135916511, 0.6684997858355138, 0.22782520808500603],
        ),
    ];
    let inertia = Matrix3::new(1.0, 0.1, 0.3, 0.1, 1.4, -0.2, 0.3, -0.2, 0.9);
    let stepper = Suslov { inertia }.into_stepper(0.1)?;
    let start = stepper.state(Matrix3::identity(), Vector3::new(0.83, -0.89, 0.41))?;
    for (steps, diagonal, momentum) in known {
        let state = stepper.advance(&start, steps)?;
        assert!(apart(state.configuration().diagonal(), diagonal) < 1e-14, "{steps} steps: {}", state.configuration());
        assert!(apart(state.momentum(), momentum) < 1e-14, "{steps} steps: {}", state.momentum());
    }
    Ok(())
}

#[test]
fn the_ball_is_that_of_60_digits() -> Result<(), Error> {
    // (step, x, N)
    let known = [
        (
            1,
            [0.3177579509349311, -0.17150334644511475],
            [0.21947438120834048, 0.377554889576301, -0.006222555211849489, 0.02026280939582976, 0.35],
        ),
        (
            10,
            [0.3915800146784136, 0.11762188268424031],
            [-0.011543728700871036, 0.43654051904548363, 0.023270259522741824, 0.1357718643504355, 0.35],
        ),
        (
            40,
            [-0.31600703650463363, 0.6250283013691555],
            [-0.4169738329964277, -0.12883879307053164, -0.2594193965352658, 0.3384869164982139, 0.35],
        ),
    ];
    let ball = cayley::Ball { mass: 1.3, inertia: 0.7, radius: 0.5, table_rate: 0.9 };
    let stepper = ball.into_stepper(0.1)?;
    let momentum =
        Vector5::from([0.24224390243902438, 0.3633658536585366, -0.013317073170731707, 0.008878048780487804, 0.35]);
    let start = stepper.state(Vector2::new(0.3, -0.2), momentum)?;
    for (steps, place, momentum) in known {
        let state = stepper.advance(&start, steps)?;
        assert!(apart(*state.configuration(), place) < 1e-14, "{steps} steps: {}", state.configuration());
        assert!(apart(state.momentum(), momentum) < 1e-14, "{steps} steps: {}", state.momentum());
    }
    Ok(())
}

fn placed(rows: [[f64; 3]; 3], place: [f64; 3]) -> Matrix4<f64> {
    let mut placed = Matrix3::from_fn(|i, j| rows[i][j]).to_homogeneous();
    placed.fixed_view_mut::<3, 1>(0, 3).copy_from(&Vector3::from(place));
    placed
}

#[test]
fn jointed_bodies_are_those_of_60_digits() -> Result<(), Error> {
    // (step, places of the centres of mass, momenta)
    let known = [
        (
            1,
            [
                [-0.09044313689534152, 0.3192959089879589, -0.37399219442667997],
                [-0.4786715659743828, 0.4877976432633083, -0.9684045254829601],
            ],
            [
                [
                    -0.01579385390026974,
                    -0.010063852929660742,
                    0.010000898686446533,
                    0.05919913488035731,
                    -0.08774363277927634,
                    -1.3177747429038154e-82,
                ],
                [
                    0.009969350458114505,
                    0.005453335442102435,
                    0.010000806161179257,
                    0.08338243039942968,
                    -0.007160808968924603,
                    -0.027745517346737247,
                ],
            ],
        ),
        (
            10,
            [
                [-0.07580607095420472, 0.2485053309862423, -0.4271984785528903],
                [-0.45179536857839053, 0.4573786581077149, -1.1157766324741258],
            ],
            [
                [
                    -0.1632730501007816,
                    0.017110443403259467,
                    0.01004069221095148,
                    -0.10064966707799687,
                    -0.9070725005598977,
                    -5.271098971615262e-82,
                ],
                [
                    0.1028192191566188,
                    -0.0839131413649545,
                    0.009464591821895185,
                    0.7885784886020704,
                    -0.4500698625466893,
                    -0.4848409367228303,
                ],
            ],
        ),
        (
            20,
            [
                [-0.12267878719967351, 0.024974215521431847, -0.4840725190819102],
                [-0.24327439920676522, 0.2878805413344049, -1.2896788175297385],
            ],
            [
                [
                    -0.13289844961527825,
                    0.11051145031543204,
                    0.007716503583229539,
                    -0.6500673547966591,
                    -0.7383247200848791,
                    2.635549485807631e-82,
                ],
                [
                    -0.03541776982353938,
                    -0.2156212654087432,
                    0.006204010176718573,
                    0.9288431585311087,
                    -1.1434633197652422,
                    0.811908830361333,
                ],
            ],
        ),
    ];
    let bodies = JointedBodies {
        second_moments: [Vector3::new(0.09, 0.085, 0.01), Vector3::new(0.04, 0.038, 0.005)]
            .map(|moments| Matrix3::from_diagonal(&(-moments).add_scalar(moments.sum() / 2.0))),
        mass: [1.0, 0.7],
        gravity: 9.81,
        near: [Vector3::z() * 0.5, Vector3::z() * 0.4],
        far: Vector3::z() * -0.5,
    };
    let stepper = bodies.into_stepper(0.02)?;
    let places = [
        placed(
            [
                [0.9808678746069344, 0.06696243887572978, 0.18279563546181693],
                [0.06696243887572978, 0.7656314639349457, -0.6397847241163593],
                [-0.18279563546181693, 0.6397847241163593, 0.7464993385418801],
            ],
            [-0.09139781773090846, 0.31989236205817967, -0.37324966927094005],
        ),
        placed(
            [
                [0.6224084788615689, -0.25022046481420857, 0.741618098774153],
                [-0.08132330984392601, 0.921718830983496, 0.37923728177283195],
                [-0.7784562959583902, -0.29635133810829833, 0.5533368591411242],
            ],
            [-0.47944287497147814, 0.4880898114072265, -0.9678340821983298],
        ),
    ];
    let momentum = [
        [
            -2.7198019883473563e-05,
            -0.007160397918177117,
            0.01,
            0.04211998775398304,
            -0.00015110011046374204,
            -1.3177747429038154e-82,
        ],
        [
            -0.0012900632946632616,
            0.008327535532983254,
            0.01,
            -0.017181161167541866,
            -0.016774841763341847,
            0.03828123039857194,
        ],
    ]
    .concat();
    let start = stepper.state(places, SVector::<f64, 12>::from_column_slice(&momentum))?;
    for (steps, places, momenta) in known {
        let state = stepper.advance(&start, steps)?;
        for i in 0..2 {
            let place = state.configuration()[i].fixed_view::<3, 1>(0, 3).into_owned();
            assert!(apart(place, places[i]) < 1e-14, "{steps} steps: {place}");
            let momentum = state.momentum().fixed_rows::<6>(6 * i).into_owned();
            assert!(apart(momentum, momenta[i]) < 1e-14, "{steps} steps: {momentum}");
        }
    }
    Ok(())
}
