//! Steps against 60-digit integrations of the equations.

use clebsch::{Clebsch, Error};
use nalgebra::{Matrix3, SVector, Vector2, Vector3, Vector5};

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

use clebsch_tests::fixtures::suslov::Suslov;

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
        assert!(apart(state.configuration().diagonal(), diagonal) < 3e-14, "{steps} steps: {}", state.configuration());
        assert!(apart(state.momentum(), momentum) < 3e-14, "{steps} steps: {}", state.momentum());
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
