//! Random problems that a declaration can hold and that have a motion.

use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::problem::Side;
use clebsch_tests::oracle::random::Random;

use crate::formula::Formula;
use crate::groups::{pick, random_group};
use crate::problem::{Acting, Declared, Discretization, Field, Kind, Kinetic, Leaf, NamedGroup};

/// The random problem of a seed.
pub fn problem(seed: u64) -> Declared {
    let random = &mut Random::new(seed.wrapping_mul(0x9e37_79b9).wrapping_add(17));
    let mut made = Declared {
        factors: Vec::new(),
        leaves: Vec::new(),
        fields: Vec::new(),
        kinetic: Kinetic::Cost(Formula::Number(0.0)),
        potential: None,
        order: if pick(random, 4) == 0 { 1 } else { 2 },
        dials: Vec::new(),
        array: false,
        constraint: Vec::new(),
    };
    // drawn apart, so that other problems stay as they are
    let is_natural = pick(&mut Random::new(seed.wrapping_mul(0x85eb_ca6b).wrapping_add(5)), 6) == 0;
    Generator { made: &mut made, random, is_natural, is_full: false }.fill();
    made
}

/// The random problem of a seed with a constraint. With `is_full` every configuration is a group or a vector space, and
/// most of them are without it.
pub fn constrained(seed: u64, is_full: bool) -> Declared {
    let random = &mut Random::new(seed.wrapping_mul(0xc2b2_ae35).wrapping_add(29));
    let mut made = Declared {
        factors: Vec::new(),
        leaves: Vec::new(),
        fields: Vec::new(),
        kinetic: Kinetic::Cost(Formula::Number(0.0)),
        potential: None,
        order: if pick(random, 8) == 0 { 1 } else { 2 },
        dials: Vec::new(),
        array: false,
        constraint: Vec::new(),
    };
    let is_full = is_full || pick(random, 8) > 0;
    Generator { made: &mut made, random, is_natural: false, is_full }.fill_constrained();
    made
}

pub struct Generator<'a> {
    pub made: &'a mut Declared,
    pub random: &'a mut Random,
    /// Whether the cost is to be one of displacements alone.
    is_natural: bool,
    /// Whether only the identity fixes a configuration.
    is_full: bool,
}

impl Generator<'_> {
    fn fill(&mut self) {
        match self.pick(10) {
            0..=5 => self.one_factor(),
            6 | 7 => self.two_factors(),
            8 => self.two_equal_factors(),
            _ => self.two_sides(),
        }
        self.kinetic();
        if self.pick(5) > 0 {
            self.made.potential = Some(self.potential());
        }
        self.dials();
    }

    fn fill_constrained(&mut self) {
        match self.pick(10) {
            0..=5 => self.one_factor(),
            6 | 7 => self.two_factors(),
            8 => self.two_equal_factors(),
            _ if self.is_full => self.two_equal_factors(),
            _ => self.two_sides(),
        }
        match self.pick(5) {
            0 => self.kinetic(),
            _ => self.quadratic(),
        }
        if self.pick(5) > 0 {
            self.made.potential = Some(self.potential());
        }
        self.constraint();
    }

    pub fn pick(&mut self, n: usize) -> usize {
        pick(self.random, n)
    }

    /// A number with few binary digits.
    pub fn number(&mut self) -> Formula {
        Formula::Number(f64::from(self.pick(63) as i32 - 31) / 32.0)
    }

    pub fn field(&mut self, attribute: &'static str, value: Matrix<f64>) -> Formula {
        self.made.fields.push(Field { attribute, value });
        Formula::Field(self.made.fields.len() - 1)
    }

    pub fn matrix(&mut self, rows: usize, columns: usize) -> Matrix<f64> {
        Matrix::from_fn(rows, columns, |_, _| self.random.number())
    }

    /// I and a little more; not symmetric where nobody promises it.
    fn weight(&mut self, n: usize, may_be_general: bool) -> Formula {
        let plain = self.matrix(n, n);
        let general = may_be_general && self.pick(3) == 0;
        let other = if general { plain.clone() } else { plain.transpose() };
        let value = Matrix::identity(n) + (plain + other) * (0.25 / n as f64);
        let promised = !general && n > 1 && self.pick(2) == 0;
        let attribute = if promised { "    #[clebsch(symmetric)]\n" } else { "" };
        self.field(attribute, value)
    }

    fn mass(&mut self) -> Formula {
        let value = self.random.between(0.6, 1.6);
        if self.pick(2) == 0 {
            self.field("", Matrix::vector(&[value]))
        } else {
            Formula::Number((value * 8.0).round() / 8.0)
        }
    }

    // ---- actions

    fn one_factor(&mut self) {
        let group = random_group(self.random);
        self.factor_with_leaf(group, 0);
        let group = self.made.factors[0].group.clone();
        // a second leaf that the same factor moves from the same side
        if self.pick(6) == 0
            && self.made.factors[0].side == Side::Left
            && group.kind == Kind::Matrix
            && !is_affine(&group)
        {
            let n = group.group.size();
            let start = self.matrix(n, 1);
            self.leaf(format!("SVector<{n}>"), Kind::Matrix, start, Formula::Element(0) * Formula::Point(1));
        }
    }

    fn two_factors(&mut self) {
        for k in 0..2 {
            let group = loop {
                let group = random_group(self.random);
                let declared_twice = k == 1 && group.declaration.is_some();
                if group.group.basis.len() <= 4 && !declared_twice {
                    break group;
                }
            };
            self.factor_with_leaf(group, k);
        }
    }

    fn two_equal_factors(&mut self) {
        let group = loop {
            let group = random_group(self.random);
            if group.group.basis.len() <= 3 {
                break group;
            }
        };
        self.factor_with_leaf(group.clone(), 0);
        let (side, leaf) = (self.made.factors[0].side, self.made.leaves[0].clone());
        self.made.factors.push(Acting { group: group.clone(), side });
        let start = self.element(&group, 0.5);
        // rotations are no projectors
        let is_point = leaf.start.shape() == start.shape() && !leaf.type_name.starts_with("Projector");
        let start = if is_point { start } else { leaf.start.clone() };
        let image = leaf.image.moved(&[1], 0);
        self.made.leaves.push(Leaf { start, image, ..leaf });
        self.made.array = true;
    }

    /// q ↦ G q F on one matrix.
    fn two_sides(&mut self) {
        let group = loop {
            let group = random_group(self.random);
            if group.kind == Kind::Matrix && group.group.basis.len() <= 4 {
                break group;
            }
        };
        let n = group.group.size();
        for side in [Side::Right, Side::Left] {
            self.made.factors.push(Acting { group: group.clone(), side });
        }
        let (typed, start) = match self.pick(2) {
            0 => (group.name.clone(), self.element(&group, 0.5)),
            _ => (format!("SMatrix<{n}, {n}>"), self.matrix(n, n)),
        };
        let image = Formula::Element(1) * Formula::Point(0) * Formula::Element(0);
        self.leaf(typed, Kind::Matrix, start, image);
    }

    fn leaf(&mut self, type_name: String, kind: Kind, start: Matrix<f64>, image: Formula) {
        self.made.leaves.push(Leaf { type_name, kind, start, image });
    }

    /// exp of something of this size.
    fn element(&mut self, group: &NamedGroup, size: f64) -> Matrix<f64> {
        element(self.random, group, size)
    }

    /// Factor k and its leaf k.
    fn factor_with_leaf(&mut self, group: NamedGroup, k: usize) {
        let (f, q) = (Formula::Element(k), Formula::Point(k));
        let n = group.group.size();
        let side = match group.kind {
            Kind::Vector => {
                let start = self.matrix(n - 1, 1);
                let named = self.pick(4) == 0;
                let typed = if named { group.name.clone() } else { format!("SVector<{}>", n - 1) };
                let image = if self.pick(2) == 0 { q + f } else { f + q };
                self.leaf(typed, Kind::Matrix, start, image);
                Side::Left
            }
            Kind::Quaternion => self.leaf_of_quaternions(&group, f, q),
            Kind::Matrix => self.leaf_of_matrices(&group, f, q),
        };
        self.made.factors.push(Acting { group, side });
    }

    fn leaf_of_quaternions(&mut self, group: &NamedGroup, f: Formula, q: Formula) -> Side {
        let on_itself = self.element(group, 1.0);
        let vector = self.matrix(3, 1);
        let choice = self.pick(4);
        let (typed, kind, start, image, side) = match if self.is_full { choice % 3 } else { choice } {
            0 => ("SU<2>", Kind::Quaternion, on_itself, q * f, Side::Right),
            1 => ("SU<2>", Kind::Quaternion, on_itself, f * q, Side::Left),
            2 => ("SU<2>", Kind::Quaternion, on_itself, q * f.method("conjugate"), Side::Left),
            _ => ("Vector3", Kind::Matrix, vector, f * q, Side::Left),
        };
        self.leaf(typed.into(), kind, start, image);
        side
    }

    fn leaf_of_matrices(&mut self, group: &NamedGroup, f: Formula, q: Formula) -> Side {
        let n = group.group.size();
        let name = group.name.clone();
        let (square, vector) = (format!("SMatrix<{n}, {n}>"), format!("SVector<{n}>"));
        let element = self.element(group, 0.5);
        let (any, column) = (self.matrix(n, n), self.matrix(n, 1));
        let small = group.group.basis.len() <= 4;
        let is_turned = name.starts_with("SO") && !name.contains(',') && n > 2;
        let choice = self.pick(10);
        let (typed, start, image, side) = match if self.is_full { choice % 5 } else { choice } {
            0..=2 => (name, element, q * f, Side::Right),
            3 | 4 => (name, element, f * q, Side::Left),
            5 if small => (name, element, q * f.method("inverse"), Side::Left),
            6 if small && self.is_natural => {
                let start = Matrix::identity(n) + (any.clone() + any.transpose()) * (0.25 / n as f64);
                let image = f.clone() * q * f.method("transpose");
                (format!("Symmetric<{square}>"), start, image, Side::Left)
            }
            6 if small => (square, any, f.clone() * q * f.method("transpose"), Side::Left),
            7 if small => (square, any, f.clone() * q * f.method("inverse"), Side::Left),
            _ if is_affine(group) => {
                let image = f.clone().method("rotation") * q + f.method("translation");
                (format!("SVector<{}>", n - 1), self.matrix(n - 1, 1), image, Side::Left)
            }
            8 if is_turned && self.is_natural => {
                let columns = element.block(0..n, 0..1 + self.pick(n - 1));
                let (k, start) = (columns.shape().1, columns.clone() * columns.transpose());
                let image = f.clone() * q * f.method("transpose");
                (format!("Projector<{square}, {k}>"), start, image, Side::Left)
            }
            9 if is_turned && self.is_natural => {
                let columns = element.block(0..n, 0..2 + self.pick(n - 2));
                (format!("Orthonormal<SMatrix<{n}, {}>>", columns.shape().1), columns, f * q, Side::Left)
            }
            8 => (vector, column, f.method("transpose") * q, Side::Right),
            _ if is_turned => {
                let length = column.norm_squared().sqrt();
                (format!("Unit<SVector<{n}>>"), column * (1.0 / length), f * q, Side::Left)
            }
            _ => (vector, column, f * q, Side::Left),
        };
        self.leaf(typed, Kind::Matrix, start, image);
        side
    }

    // ---- kinetic parts

    fn kinetic(&mut self) {
        // the displacement of a quaternion is no quaternion of length one
        if self.is_natural && self.made.leaves.iter().all(|leaf| leaf.kind != Kind::Quaternion) {
            return self.natural();
        }
        match self.pick(3) {
            0 => self.lagrangian(),
            _ => self.cost(),
        }
    }

    fn cost(&mut self) {
        let mut sum: Option<Formula> = None;
        for k in 0..self.made.factors.len() {
            let chord = self.chord(k);
            sum = Some(match sum {
                Some(sum) => sum + chord,
                None => chord,
            });
        }
        let mut sum = sum.expect("a factor");
        if self.pick(4) == 0 {
            sum = sum + self.displacement() * Formula::Number(0.25);
        }
        match self.pick(12) {
            0 => sum = sum * (Formula::Number(1.0) + Formula::Time * Formula::Time * Formula::Number(0.5)),
            1 => sum = sum * (Formula::Number(1.0) + self.variable().power(2) * Formula::Number(0.25)),
            _ => {}
        }
        let mut cost = sum / (Formula::Number(2.0) * Formula::Step);
        // a potential at the start alone, or at the mean of both ends
        match self.pick(10) {
            0 => cost = cost - Formula::Step * self.variable().power(2) * Formula::Number(0.5),
            1 => {
                let leaf = &self.made.leaves[0];
                let (image, kind) = (leaf.image.clone(), leaf.kind);
                if kind == Kind::Matrix {
                    let s = Formula::Entry(Box::new((image + Formula::Point(0)) / Formula::Number(2.0)), 0, 0);
                    let scale = if self.pick(2) == 0 { Formula::Time } else { Formula::Number(0.5) };
                    cost = cost - Formula::Step * s.power(2) * (Formula::Number(1.0) + scale);
                }
            }
            _ => {}
        }
        self.made.kinetic = Kinetic::Cost(cost);
    }

    /// |F − I|² with a weight.
    fn chord(&mut self, k: usize) -> Formula {
        let factor = self.made.factors[k].group.clone();
        let (f, n) = (Formula::Element(k), factor.group.size());
        match factor.kind {
            Kind::Vector => {
                let weight = self.weight(n - 1, true);
                f.clone().dot(weight * f)
            }
            Kind::Quaternion => {
                let (weight, v) = (self.weight(3, true), f.method("imag"));
                Formula::Number(4.0) * v.clone().dot(weight * v)
            }
            Kind::Matrix => {
                let chord = f - Formula::Identity(n);
                match self.pick(5) {
                    0 => (self.weight(n, true) * chord.clone() * chord.method("transpose")).method("trace"),
                    1 => (chord.clone() * self.weight(n, true) * chord.method("transpose")).method("trace"),
                    2 => chord.clone().dot(self.weight(n, true) * chord),
                    3 => {
                        let weight = self.matrix(n, n).map(|x| 1.0 + x * 0.5);
                        let weight = self.field("", weight);
                        chord.clone().dot(weight.component_mul(chord))
                    }
                    _ => self.mass() * chord.method("norm_squared"),
                }
            }
        }
    }

    /// |Φ_F q − q|² of a leaf.
    fn displacement(&mut self) -> Formula {
        let k = self.pick(self.made.leaves.len());
        let leaf = &self.made.leaves[k];
        let moved = leaf.image.clone() - Formula::Point(k);
        match leaf.kind {
            Kind::Quaternion => moved.method("imag").method("norm_squared"),
            _ => moved.method("norm_squared"),
        }
    }

    /// A cost of displacements alone: a function of q and Φ_F q. It does not fix the motions that leave q unchanged.
    fn natural(&mut self) {
        let displacement = |leaf: usize, leaves: &[Leaf]| leaves[leaf].image.clone() - Formula::Point(leaf);
        let mut sum: Option<Formula> = None;
        for k in 0..self.made.leaves.len() {
            let moved = displacement(k, &self.made.leaves);
            let rows = self.made.leaves[k].start.shape().0;
            let part = match self.pick(2) {
                0 => moved.clone().dot(self.weight(rows, false) * moved),
                _ => self.mass() * moved.method("norm_squared"),
            };
            sum = Some(match sum {
                Some(sum) => sum + part,
                None => part,
            });
        }
        let mut sum = sum.expect("a leaf");
        if let [one, other] = &self.made.leaves[..]
            && one.start.shape() == other.start.shape()
            && self.pick(2) == 0
        {
            let moved = [0, 1].map(|k| displacement(k, &self.made.leaves));
            let [one, other] = moved;
            sum = sum + one.dot(other) * Formula::Number(0.5);
        }
        self.made.kinetic = Kinetic::Cost(sum / (Formula::Number(2.0) * Formula::Step));
    }

    fn lagrangian(&mut self) {
        let factor = &self.made.factors[0].group;
        let alone = self.made.factors.len() == 1;
        if alone && factor.name == "SO<3>" && self.pick(2) == 0 {
            return self.moser_veselov();
        }
        let mut sum: Option<Formula> = None;
        for k in 0..self.made.factors.len() {
            let dimension = self.made.factors[k].group.group.basis.len();
            let (v, weight) = (Formula::Velocity(k), self.weight(dimension, true));
            let mut part = v.clone().dot(weight * v.clone());
            match self.pick(8) {
                0 => part = part + v.method("norm_squared").power(2) * Formula::Number(0.125),
                1 => {
                    let slope = self.matrix(dimension, 1) * 0.25;
                    let slope = self.field("", slope).dot(v);
                    let timed = self.pick(3) == 0;
                    part = part + if timed { slope * (Formula::Number(1.0) + Formula::Time) } else { slope };
                }
                _ => {}
            }
            sum = Some(match sum {
                Some(sum) => sum + part,
                None => part,
            });
        }
        let mut sum = sum.expect("a factor") / Formula::Number(2.0);
        // known shortfall: with the exponential, an inertia that changes with a point moved by SE(n), Sim(n) or Aff(n) expands
        // into formulas of megabytes
        let swells = self.made.factors.iter().any(|factor| is_affine(&factor.group));
        match self.pick(8) {
            0 if !swells => sum = sum * (Formula::Number(1.0) + self.variable().power(2) * Formula::Number(0.25)),
            1 => sum = sum * (Formula::Number(1.0) + Formula::Time * Formula::Number(0.5)),
            _ => {}
        }
        let discretization = match self.pick(3) {
            0 if !self.made.factors.iter().any(is_long) => Discretization::Cayley,
            1 => Discretization::Projection,
            _ => Discretization::Exponential,
        };
        self.made.kinetic = Kinetic::Lagrangian(sum, discretization);
    }

    /// A kinetic energy that is a quadratic form, and sometimes a linear one more.
    fn quadratic(&mut self) {
        let alone = self.made.factors.len() == 1;
        if alone && self.made.factors[0].group.name == "SO<3>" && self.pick(2) == 0 {
            return self.moser_veselov();
        }
        let mut parts = Vec::new();
        for k in 0..self.made.factors.len() {
            let dimension = self.made.factors[k].group.group.basis.len();
            let (v, weight) = (Formula::Velocity(k), self.weight(dimension, true));
            parts.push(v.clone().dot(weight * v.clone()));
            if self.pick(6) == 0 {
                let slope = self.matrix(dimension, 1) * 0.25;
                let slope = self.field("", slope).dot(v);
                let timed = self.pick(3) == 0;
                parts.push(if timed { slope * (Formula::Number(1.0) + Formula::Time) } else { slope });
            }
        }
        let mut sum = parts.into_iter().reduce(|a, b| a + b).expect("a factor") / Formula::Number(2.0);
        // formulas of megabytes, as of other Lagrangians
        let swells = self.made.factors.iter().any(|factor| is_affine(&factor.group));
        match self.pick(8) {
            0 | 1 if !swells => sum = sum * (Formula::Number(1.0) + self.variable().power(2) * Formula::Number(0.25)),
            2 => sum = sum * (Formula::Number(1.0) + Formula::Time * Formula::Number(0.5)),
            _ => {}
        }
        let discretization = match self.pick(4) {
            0 | 1 if !self.made.factors.iter().any(is_long) => Discretization::Cayley,
            0 => Discretization::LeftOut,
            2 => Discretization::Projection,
            _ => Discretization::Exponential,
        };
        self.made.kinetic = Kinetic::Lagrangian(sum, discretization);
    }

    /// ½ ω·Jω on SO(3) with J = ½tr(J)I − J the other way round.
    fn moser_veselov(&mut self) {
        let plain = self.matrix(3, 3);
        let inertia = Matrix::identity(3) + (&plain + plain.transpose()) * 0.1;
        let mass = Matrix::identity(3) * (inertia.trace() / 2.0) - &inertia;
        let field = self.field("    #[clebsch(symmetric)]\n", inertia);
        let v = Formula::Velocity(0);
        let lagrangian = v.clone().dot(field * v) / Formula::Number(2.0);
        // the mass matrix is no field: its entries are rounded, by 1e-16
        let chord = || Formula::Element(0) - Formula::Identity(3);
        let entry = |i: usize, j: usize| {
            let product = Formula::Entry(Box::new(chord().method("transpose") * chord()), i, j);
            product * Formula::Number(mass[(i, j)])
        };
        let entries = (0..9).map(|k| entry(k / 3, k % 3));
        let sum = entries.reduce(|a, b| a + b).expect("nine entries");
        let cost = sum / (Formula::Number(2.0) * Formula::Step);
        self.made.kinetic = Kinetic::MoserVeselov(lagrangian, cost);
    }

    // ---- potentials

    /// An entry of the configuration.
    pub fn variable(&mut self) -> Formula {
        let k = self.pick(self.made.leaves.len());
        let (kind, (rows, columns)) = (self.made.leaves[k].kind, self.made.leaves[k].start.shape());
        let leaf = Formula::Point(k);
        let (i, j) = (self.pick(rows), self.pick(columns));
        match kind {
            Kind::Quaternion if i == 3 => leaf.method("scalar"),
            Kind::Quaternion => Formula::Coordinate(Box::new(leaf.method("imag")), i),
            _ if columns == 1 && rows > 1 && rows <= 4 && self.pick(2) == 0 => Formula::Coordinate(Box::new(leaf), i),
            _ => Formula::Entry(Box::new(leaf), i, j),
        }
    }

    /// A polynomial of degree at most three in the entries of the configuration.
    fn potential(&mut self) -> Formula {
        let mut sum = self.monomial();
        for _ in 0..self.pick(4) {
            sum = if self.pick(2) == 0 { sum + self.monomial() } else { sum - self.monomial() };
        }
        sum
    }

    fn monomial(&mut self) -> Formula {
        let linear = |generator: &mut Self| {
            let (rows, columns) = generator.made.leaves[0].start.shape();
            let weight = generator.matrix(rows, columns) * 0.5;
            generator.field("", weight).dot(Formula::Point(0))
        };
        let whole = self.made.leaves[0].kind == Kind::Matrix;
        let mut product = match self.pick(6) {
            0 if whole => linear(self),
            1 if whole => linear(self).power(3) / Formula::Number(3.0),
            _ => {
                let degree = 1 + self.pick(3);
                let coefficient = if self.pick(2) == 0 { self.mass() } else { self.number() };
                (0..degree).fold(coefficient, |product, _| product * self.variable())
            }
        };
        if self.pick(10) == 0 {
            product = product * (Formula::Number(1.0) + Formula::Time);
        }
        product
    }

    fn dials(&mut self) {
        if self.pick(6) == 0 && !self.is_natural {
            self.made.dials.push("isotropy = free");
        }
        // in which Cayley's velocities have poles
        let has_poles = matches!(self.made.kinetic, Kinetic::Lagrangian(_, Discretization::Cayley));
        if self.pick(8) == 0 && !has_poles {
            self.made.dials.push("chart = exponential");
        }
    }
}

/// Whether points are moved by F.rotation() * x + F.translation().
fn is_affine(group: &NamedGroup) -> bool {
    ["SE", "Sim", "Aff"].iter().any(|name| group.name.starts_with(name))
}

/// Where the Cayley map leaves the group its projection makes long formulas.
fn is_long(factor: &Acting) -> bool {
    ["Sim", "U<2", "Own", "Aff", "GL"].iter().any(|name| factor.group.name.starts_with(name))
}

/// exp of something of this size.
pub fn element(random: &mut Random, group: &NamedGroup, size: f64) -> Matrix<f64> {
    let components: Vec<f64> = group.group.basis.iter().map(|_| size * random.number()).collect();
    let element = group.group.combination(&components).exponential();
    if group.kind == Kind::Vector { element.translation() } else { element }
}
