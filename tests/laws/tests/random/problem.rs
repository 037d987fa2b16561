//! A problem as data: its declaration as text, and the same for the oracle.

use clebsch_tests::oracle::precise::group::Group;
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::problem::{Factor, Problem, Side};
use clebsch_tests::oracle::precise::real::Real;

use crate::formula::{Formula, Names, Place};

/// The kind of an element in a declaration, if it is not a square matrix.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The matrix itself, or any matrix or vector of a configuration.
    Matrix,
    /// A vector a, for the oracle (I a; 0 1).
    Vector,
    /// A unit quaternion, for the oracle the matrix of multiplication by it from the left.
    Quaternion,
}

/// A group with its name in a declaration.
#[derive(Clone, Debug)]
pub struct NamedGroup {
    /// `SO<3>`, or the name of a declared one.
    pub name: String,
    /// `group NAME = …` of a declared one.
    pub declaration: Option<String>,
    pub group: Group,
    pub kind: Kind,
}

/// A factor of the group with its side.
#[derive(Clone, Debug)]
pub struct Acting {
    pub group: NamedGroup,
    pub side: Side,
}

/// A leaf of the configuration: its type, and how it is made of numbers.
#[derive(Clone, Debug)]
pub struct Leaf {
    pub type_name: String,
    pub kind: Kind,
    /// A point to start from.
    pub start: Matrix<f64>,
    /// Φ_F of it.
    pub image: Formula,
}

/// A field of the struct.
#[derive(Clone, Debug)]
pub struct Field {
    pub attribute: &'static str,
    pub value: Matrix<f64>,
}

/// How the velocity of a Lagrangian is made.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Discretization {
    Cayley,
    Projection,
    Exponential,
    /// The key is left out: Cayley's.
    LeftOut,
}

/// The kinetic part.
#[derive(Clone, Debug)]
pub enum Kinetic {
    Cost(Formula),
    Lagrangian(Formula, Discretization),
    /// Moser and Veselov on one factor: the Lagrangian and the cost that it stands for.
    MoserVeselov(Formula, Formula),
}

impl Kinetic {
    /// The keys of the kinetic part, from the text of the closure of a key.
    pub fn keys(&self, closure: impl Fn(&str, &Formula) -> String) -> Vec<String> {
        match self {
            Kinetic::Cost(cost) => vec![closure("cost", cost)],
            Kinetic::Lagrangian(lagrangian, Discretization::LeftOut) => vec![closure("lagrangian", lagrangian)],
            Kinetic::Lagrangian(lagrangian, discretization) => {
                let discretization = format!("{discretization:?}").to_lowercase();
                vec![closure("lagrangian", lagrangian), format!("discretization = {discretization}")]
            }
            Kinetic::MoserVeselov(lagrangian, _) => {
                vec![closure("lagrangian", lagrangian), "discretization = moser_veselov".into()]
            }
        }
    }
}

/// A declaration.
#[derive(Clone, Debug)]
pub struct Declared {
    pub factors: Vec<Acting>,
    pub leaves: Vec<Leaf>,
    pub fields: Vec<Field>,
    pub kinetic: Kinetic,
    pub potential: Option<Formula>,
    pub order: usize,
    /// Further keys, `isotropy = free`.
    pub dials: Vec<&'static str>,
    /// Whether two equal factors are an array.
    pub array: bool,
    /// The closures of the constraint.
    pub constraint: Vec<Equations>,
}

/// A closure of a constraint.
#[derive(Clone, Debug)]
pub struct Equations {
    /// Whether they are of the velocity; else they are of the configuration.
    pub of_velocity: bool,
    pub all: Vec<Equation>,
}

/// `a == b`, of scalars or of vectors.
#[derive(Clone, Debug)]
pub struct Equation {
    pub sides: [Formula; 2],
    /// Whether it is one of the first element of an array, and repeated for each: `(0..2).map(|i| a == b)`.
    pub each: bool,
}

impl Declared {
    /// The struct with its attribute.
    pub fn text(&self) -> String {
        let names = self.names();
        let pattern =
            |names: &[String]| if names.len() == 1 { names[0].clone() } else { format!("({})", names.join(", ")) };
        let typed = |letter: &str, names: &[String], types: &[String]| match self.array {
            true => format!("{letter}: [{}; {}]", types[0], types.len()),
            false => format!("{}: {}", pattern(names), pattern(types)),
        };
        let bare = |letter: &str, names: &[String]| if self.array { letter.into() } else { pattern(names) };
        let groups: Vec<String> = self.factors.iter().map(|factor| factor.group.name.clone()).collect();
        let types: Vec<String> = self.leaves.iter().map(|leaf| leaf.type_name.clone()).collect();
        let images: Vec<String> = self.leaves.iter().map(|leaf| leaf.image.text(&names)).collect();
        let image = if self.array { format!("[{}]", images.join(", ")) } else { pattern(&images) };
        let mut keys: Vec<String> = self.factors.iter().filter_map(|factor| factor.group.declaration.clone()).collect();
        keys.sort();
        keys.dedup();
        keys.push(format!(
            "action = |{}, {}| {image}",
            typed("F", &names.elements, &groups),
            typed("q", &names.points, &types)
        ));
        let closure = |key: &str, formula: &Formula| {
            let letters = [bare("q", &names.points), bare("F", &names.elements), bare("v", &names.velocities)];
            format!("{key} = |{}| {}", head(key, formula, letters), formula.text(&names))
        };
        keys.extend(self.kinetic.keys(closure));
        keys.extend(self.potential.iter().map(|potential| closure("potential", potential)));
        keys.extend(self.constraint_text(&names));
        if self.order == 1 {
            keys.push("order = 1".into());
        }
        keys.extend(self.dials.iter().map(|dial| dial.to_string()));
        let scalar = if self.mentions_field() { "" } else { "    scalar = f64,\n" };
        let fields: String =
            self.fields.iter().zip(&names.fields).map(|(field, name)| field.text(name, None)).collect();
        format!("#[clebsch(\n    {},\n{scalar})]\npub struct Problem {{\n{fields}}}\n", keys.join(",\n    "))
    }

    /// The key of the constraint.
    fn constraint_text(&self, names: &Names) -> Option<String> {
        let bare = |letter: &str, names: &[String]| match (self.array, names) {
            (true, _) => letter.into(),
            (false, [only]) => only.clone(),
            (false, names) => format!("({})", names.join(", ")),
        };
        let indexed = Names {
            points: vec!["q[i]".into()],
            velocities: vec!["v[i]".into()],
            elements: vec!["F[i]".into()],
            ..names.clone()
        };
        let equation = |Equation { sides: [a, b], each }: &Equation| match each {
            true => format!("(0..{}).map(|i| {} == {})", self.factors.len(), a.text(&indexed), b.text(&indexed)),
            false => format!("{} == {}", a.text(names), b.text(names)),
        };
        let closure = |Equations { of_velocity, all }: &Equations| {
            let sides = all.iter().flat_map(|equation| equation.sides.clone());
            let mentioned = sides.reduce(|a, b| a + b)?;
            let letters = [bare("q", &names.points), bare("F", &names.elements), bare("v", &names.velocities)];
            let arguments = head(if *of_velocity { "lagrangian" } else { "constraint" }, &mentioned, letters);
            let equations: Vec<String> = all.iter().map(equation).collect();
            Some(format!("|{arguments}| [{}]", equations.join(", ")))
        };
        match &self.constraint.iter().filter_map(closure).collect::<Vec<String>>()[..] {
            [] => None,
            [only] => Some(format!("constraint = {only}")),
            all => Some(format!("constraint = [{}]", all.join(", "))),
        }
    }

    /// Leaves out an equation.
    pub fn without_equation(&mut self, (closure, at): (usize, usize)) {
        self.constraint[closure].all.remove(at);
        self.constraint.retain(|closure| !closure.all.is_empty());
    }

    /// The equations of one kind as differences of both sides, one for each element of an array.
    pub fn differences(&self, of_velocity: bool) -> Vec<Formula> {
        let mut all = Vec::new();
        for closure in self.constraint.iter().filter(|closure| closure.of_velocity == of_velocity) {
            for Equation { sides: [a, b], each } in &closure.all {
                let difference = a.clone() - b.clone();
                match each {
                    true => all.extend((0..self.factors.len()).map(|k| difference.moved(&[k], 0))),
                    false => all.push(difference),
                }
            }
        }
        all
    }

    fn mentions_field(&self) -> bool {
        !self.fields.is_empty()
    }

    pub fn names(&self) -> Names {
        let numbered = |letters: &str, letter: &str, count: usize| -> Vec<String> {
            let name = |k: usize| if self.array { format!("{letter}[{k}]") } else { letters[k..=k].to_string() };
            (0..count).map(name).collect()
        };
        Names {
            fields: (0..self.fields.len()).map(|k| format!("field_{k}")).collect(),
            points: numbered("qxy", "q", self.leaves.len()),
            elements: numbered("FGH", "F", self.factors.len()),
            velocities: numbered("vw", "v", self.factors.len()),
        }
    }

    pub fn place<'a, R: Real>(&self, values: &'a Seen<R>, t: R, h: R, fields: &'a [Matrix<f64>]) -> Place<'a, R> {
        Place { fields, t, h, q: &values.q, f: &values.f, xi: &values.xi }
    }

    pub fn values(&self) -> Vec<Matrix<f64>> {
        self.fields.iter().map(|field| field.value.clone()).collect()
    }

    pub fn seen<R: Real>(&self, q: &[Matrix<R>], f: &[Matrix<R>]) -> Seen<R> {
        let shown = |(factor, f): (&Acting, &Matrix<R>)| match factor.group.kind {
            Kind::Vector => f.translation(),
            _ => f.clone(),
        };
        Seen { q: q.to_vec(), f: self.factors.iter().zip(f).map(shown).collect(), xi: Vec::new() }
    }
}

/// The arguments of the closure of a key: those of its formula, and the velocity of each Lagrangian.
pub fn head(key: &str, formula: &Formula, [q, f, v]: [String; 3]) -> String {
    let mentions = |which: &dyn Fn(&Formula) -> bool| formula.mentions(which);
    let arguments = [
        ("t".to_string(), mentions(&|part| matches!(part, Formula::Time))),
        ("h".to_string(), mentions(&|part| matches!(part, Formula::Step))),
        (q, mentions(&|part| matches!(part, Formula::Point(_)))),
        (f, mentions(&|part| matches!(part, Formula::Element(_)))),
        (v, key == "lagrangian"),
    ];
    let taken: Vec<String> = arguments.into_iter().filter_map(|(name, is_taken)| is_taken.then_some(name)).collect();
    taken.join(", ")
}

impl Field {
    /// The line of the struct; with a length that of an array.
    pub fn text(&self, name: &str, length: Option<&str>) -> String {
        let type_name = match self.value.shape() {
            (1, 1) => "f64".into(),
            (n, 1) => format!("SVector<f64, {n}>"),
            (n, m) => format!("SMatrix<f64, {n}, {m}>"),
        };
        let type_name = length.map_or(type_name.clone(), |length| format!("[{type_name}; {length}]"));
        format!("{}    pub {name}: {type_name},\n", self.attribute)
    }
}

/// The values that a declaration sees.
pub struct Seen<R> {
    pub q: Vec<Matrix<R>>,
    pub f: Vec<Matrix<R>>,
    pub xi: Vec<Matrix<R>>,
}

/// The coordinates of a velocity with F = exp(hξ) to first order.
pub fn velocity<R: Real>(factor: &Acting, discretization: Discretization, h: R, f: &Matrix<R>) -> Matrix<R> {
    let one = Matrix::identity(f.shape().0);
    let matrix = match (discretization, factor.group.kind) {
        // tan(θ/2) is the vector part over the scalar part
        (Discretization::Cayley | Discretization::LeftOut, Kind::Quaternion) => {
            return f.block(0..3, 3..4) * (R::of(2.0) / (h * f[(3, 3)]));
        }
        (Discretization::Cayley | Discretization::LeftOut, Kind::Matrix) => {
            (f - &one) * (f + &one).inverse() * R::of(2.0)
        }
        (Discretization::Exponential, _) => f.logarithm(),
        _ => f - &one,
    };
    let basis = &factor.group.group.basis;
    let gram = Matrix::from_fn(basis.len(), basis.len(), |i, j| basis[i].dot(&basis[j]));
    let components: Vec<R> = basis.iter().map(|e| e.lift().dot(&matrix)).collect();
    gram.lift().solve(&Matrix::vector(&components)) * (R::one() / h)
}

impl Problem for Declared {
    fn factors(&self) -> Vec<Factor> {
        self.factors.iter().map(|factor| Factor { group: factor.group.group.clone(), side: factor.side }).collect()
    }
    fn act<R: Real>(&self, f: &[Matrix<R>], q: &[Matrix<R>]) -> Vec<Matrix<R>> {
        let (seen, fields) = (self.seen(q, f), self.values());
        let place = self.place(&seen, R::zero(), R::zero(), &fields);
        self.leaves.iter().map(|leaf| leaf.image.value(&place)).collect()
    }
    fn cost<R: Real>(&self, t: R, h: R, q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        let (mut seen, fields) = (self.seen(q, f), self.values());
        match &self.kinetic {
            Kinetic::Cost(cost) | Kinetic::MoserVeselov(_, cost) => {
                cost.value(&self.place(&seen, t, h, &fields))[(0, 0)]
            }
            Kinetic::Lagrangian(lagrangian, discretization) => {
                seen.xi =
                    self.factors.iter().zip(f).map(|(factor, f)| velocity(factor, *discretization, h, f)).collect();
                let start = lagrangian.value(&self.place(&seen, t, h, &fields))[(0, 0)];
                seen.q = self.act(f, q);
                let end = lagrangian.value(&self.place(&seen, t + h, h, &fields))[(0, 0)];
                h * (start + end) * 0.5
            }
        }
    }
    fn potential<R: Real>(&self, t: R, q: &[Matrix<R>]) -> R {
        let Some(potential) = &self.potential else { return R::zero() };
        let (seen, fields) = (self.seen(q, &[]), self.values());
        potential.value(&self.place(&seen, t, R::zero(), &fields))[(0, 0)]
    }
    fn lagrangian<R: Real>(&self, t: R, h: R, q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        let end = self.potential(t + h, &self.act(f, q));
        let potential = if self.order == 1 { end } else { (self.potential(t, q) + end) * 0.5 };
        self.cost(t, h, q, f) - h * potential
    }
}
