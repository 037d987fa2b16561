//! Systems with several methods, and for each method a struct that is declared with its dials.

/// One declaration with methods, in `together`, and one for each method, in `apart`.
macro_rules! both_ways {
    ($($(#[$doc:meta])* $module:ident $declared:tt $fields:tt [$($method:ident $dials:tt)*])*) => { $(
        $(#[$doc])*
        pub mod $module {
            both_ways!(@together $declared $fields [$($method $dials)*]);
            both_ways!(@apart $declared $fields [$($method $dials)*]);
        }
    )* };
    (@together {$($declared:tt)*} {$($field:ident: $ty:ty),*} [$($method:ident {$($dials:tt)*})*]) => {
        pub mod together {
            use clebsch::Clebsch;

            $(pub struct $method;)*

            #[derive(Clebsch, Clone, Debug)]
            #[clebsch($($declared)*, $(method $method = ($($dials)*)),*)]
            pub struct System {
                $(pub $field: $ty),*
            }
        }
    };
    (@apart $declared:tt $fields:tt [$($method:ident $dials:tt)*]) => {
        pub mod apart {
            use clebsch::Clebsch;

            $(both_ways!(@one $declared $fields $method $dials);)*
        }
    };
    (@one {$($declared:tt)*} {$($field:ident: $ty:ty),*} $method:ident {$($dials:tt)*}) => {
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch($($declared)*, $($dials)*)]
        pub struct $method {
            $(pub $field: $ty),*
        }
    };
}

both_ways! {
    /// A heavy top: every discretization, and every dial.
    top {
        action     = |F: SO<3>, R: SO<3>| R * F,
        lagrangian = |omega| omega.dot(&(nalgebra::Matrix3::from_diagonal(&self.moments) * omega)) / 2,
        potential  = |R| self.weight * (R * self.center).z
    } { moments: nalgebra::Vector3<f64>, weight: f64, center: nalgebra::Vector3<f64> } [
        Fine { order = 6, discretization = exact }
        Rough { order = 4, discretization = exact, tolerance = 1e-4 }
        First { order = 1, discretization = moser_veselov }
        Second { discretization = cayley, solver = fixed_point }
        Fourth { order = 4, discretization = moser_veselov, summation = compensated }
        Charted { discretization = exponential, chart = exponential, iterations = 8 }
        Tolerant { order = 8, discretization = projection, tolerance = 1e-8 }
        Sixteenth { order = 16, summation = compensated, tolerance = 1e-12 }
        Written { code = matrices, discretization = moser_veselov }
    ]
    /// A body that turns freely: motions that are found once.
    free {
        action     = |F: SO<3>, R: SO<3>| R * F,
        lagrangian = |omega| omega.dot(&(nalgebra::Matrix3::from_diagonal(&self.moments) * omega)) / 2
    } { moments: nalgebra::Vector3<f64> } [
        Exact { discretization = exact }
        Kept { discretization = exact, summation = compensated }
        Sixth { order = 6, discretization = cayley }
    ]
    /// A pendulum by a cost, which no method discretises anew.
    pendulum {
        action    = |F: SO<3>, q: Unit<Vector3>| F * q,
        cost      = |h, F| (F - I).norm_squared() / (4 * h),
        potential = |q| self.gravity * q.z
    } { gravity: f64 } [
        First { order = 1 }
        Second { order = 2 }
        Eighth { order = 8 }
    ]
    /// A pendulum whose steps are differentiated, by each method.
    varied {
        action    = |F: SO<3>, q: Unit<Vector3>| F * q,
        cost      = |h, F| (F - I).norm_squared() / (4 * h),
        potential = |q| self.gravity * q.z,
        emit      = [boundary, tangent]
    } { gravity: f64 } [
        First { order = 1 }
        Second { order = 2 }
    ]
    /// The same of a top, whose step is implicit.
    varied_top {
        action     = |F: SO<3>, R: SO<3>| R * F,
        lagrangian = |omega| omega.dot(&(nalgebra::Matrix3::from_diagonal(&self.moments) * omega)) / 2,
        potential  = |R| self.weight * (R * self.center).z,
        emit       = [tangent]
    } { moments: nalgebra::Vector3<f64>, weight: f64, center: nalgebra::Vector3<f64> } [
        First { order = 1, discretization = moser_veselov }
        Charted { discretization = exponential }
        Fourth { order = 4, discretization = moser_veselov }
    ]
    /// A point on a large sphere, in (q, w).
    sphere {
        action    = |F: SO<9>, q: Unit<SVector<9>>| F * q,
        cost      = |h, F| (F - I).norm_squared() / (4 * h),
        potential = |q| self.gravity * q[8]
    } { gravity: f64 } [
        First { order = 1 }
        Second { order = 2 }
        Fourth { order = 4 }
    ]
    /// A particle that is pushed by a potential of the time.
    driven {
        action    = |a: Translation<3>, x: Vector3| x + a,
        cost      = |h, a| a.norm_squared() / (2 * h),
        potential = |t, x| x.norm_squared() / 2 + self.amplitude * t.cos() * x.x
    } { amplitude: f64 } [
        First { order = 1 }
        Sixth { order = 6 }
    ]
}
