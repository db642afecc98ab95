//! Chaplygin's multiplier, held against motions in numbers that share nothing with how it is decided.
//!
//! Over `r`, with `L_c(r, ṙ) = L` on the constraints and `p = ∂L_c/∂ṙ`, let `E_a = dp_a/dt − ∂L_c/∂r_a` along
//! Chetaev's motion, whose accelerations are those of Maggi's equations. With `dτ = f dt`, `P = f p` it is
//! Hamilton's iff `E_a = φ_a (p·ṙ) − (φ·ṙ) p_a` for all `ṙ`, where `φ_a = ∂_a log f`.

use integrals::{Multiplier, reversible_scene};
use nalgebra::{DMatrix, DVector};
use referees::maggi::Maggi;
use scene::Scene;
use symbolic::{SplitMix, Symbol};

struct Reduced {
    scene: Scene,
    maggi: Maggi,
    /// Places of `r`.
    free: Vec<usize>,
}

impl Reduced {
    fn value(&self, expressions: &[symbolic::Expr], q: &[f64], v: &[f64]) -> Vec<f64> {
        let system = &self.scene.system;
        let mut values = system.parameter_values();
        let symbols: Vec<Symbol> = system.positions().into_iter().chain(system.velocities()).collect();
        values.extend(symbols.into_iter().zip(q.iter().chain(v).copied()));
        expressions.iter().map(|&e| system.graph.evaluate(e, &values).expect("a value")).collect()
    }

    /// The velocities of all coordinates from those of `r`.
    fn velocities(&self, q: &[f64], rates: &[f64]) -> Vec<f64> {
        let n = q.len();
        let (dependent, h): (Vec<usize>, usize) = {
            let others: Vec<usize> = (0..n).filter(|i| !self.free.contains(i)).collect();
            (others.clone(), others.len())
        };
        let a = DMatrix::from_row_slice(
            h,
            n,
            &self.value(self.scene.system.constraint_jacobian().entries(), q, &vec![0.0; n]),
        );
        let mut v = DVector::zeros(n);
        self.free.iter().zip(rates).for_each(|(&i, &x)| v[i] = x);
        let solved = a.select_columns(&dependent).lu().solve(&-(&a * &v)).expect("regular constraints");
        dependent.iter().zip(solved.iter()).for_each(|(&i, &x)| v[i] = x);
        v.as_slice().to_vec()
    }

    fn lagrangian(&self, q: &[f64], rates: &[f64]) -> f64 {
        self.value(&[self.scene.system.lagrangian], q, &self.velocities(q, rates))[0]
    }

    /// `∂L_c/∂ṙ`: `L_c` is quadratic in `ṙ`, so that differences over 1 are exact.
    fn momenta(&self, q: &[f64], rates: &[f64]) -> Vec<f64> {
        let along = |a: usize, by: f64| {
            let moved: Vec<f64> = (0..rates.len()).map(|i| rates[i] + if i == a { by } else { 0.0 }).collect();
            self.lagrangian(q, &moved)
        };
        (0..rates.len()).map(|a| (along(a, 1.0) - along(a, -1.0)) / 2.0).collect()
    }

    /// `φ` at a place by least squares over random `ṙ`, and the largest of what is left of `E`, in parts of
    /// it.
    fn slopes(&mut self, q: &[f64]) -> (Vec<f64>, f64) {
        let m = self.free.len();
        let mut random = SplitMix::new(5);
        let (mut rows, mut right) = (Vec::new(), Vec::new());
        for _ in 0..4 * m {
            let rates: Vec<f64> = (0..m).map(|_| 2.0 * random.unit() - 1.0).collect();
            let v = self.velocities(q, &rates);
            let acceleration = self.maggi.accelerations(0.0, q, &v).expect("accelerations");
            let later = |t: f64| {
                let moved: Vec<f64> =
                    q.iter().zip(&v).zip(&acceleration).map(|((q, v), a)| q + t * v + t * t * a / 2.0).collect();
                let rates: Vec<f64> = self.free.iter().map(|&i| v[i] + t * acceleration[i]).collect();
                self.momenta(&moved, &rates)
            };
            let h = f64::EPSILON.cbrt();
            let (after, before, p) = (later(h), later(-h), self.momenta(q, &rates));
            let work: f64 = p.iter().zip(&rates).map(|(p, r)| p * r).sum();
            for a in 0..m {
                let beside = |by: f64| {
                    let mut moved = q.to_vec();
                    moved[self.free[a]] += by;
                    self.lagrangian(&moved, &rates)
                };
                right.push((after[a] - before[a]) / (2.0 * h) - (beside(h) - beside(-h)) / (2.0 * h));
                rows.extend((0..m).map(|b| if a == b { work } else { 0.0 } - rates[b] * p[a]));
            }
        }
        let (matrix, right) = (DMatrix::from_row_slice(right.len(), m, &rows), DVector::from_vec(right));
        let phi = matrix.clone().svd(true, true).solve(&right, 1e-9).expect("least squares");
        let rest = (&matrix * &phi - &right).amax() / right.amax().max(1e-3);
        (phi.as_slice().to_vec(), rest)
    }

    /// Whether the motion is Hamilton's after a change of time: `φ` solves its equations and is a gradient.
    fn is_hamiltonian(&mut self, q: &[f64]) -> Result<(), String> {
        let (phi, rest) = self.slopes(q);
        if rest > 1e-5 {
            return Err(format!("{rest:.0e} of the forces is left"));
        }
        let step = 1e-2;
        let moved = |by: f64, a: usize| {
            let mut moved = q.to_vec();
            moved[self.free[a]] += by;
            moved
        };
        let places: Vec<[Vec<f64>; 2]> = (0..phi.len()).map(|a| [moved(step, a), moved(-step, a)]).collect();
        let slopes: Vec<Vec<f64>> = places
            .iter()
            .map(|[after, before]| {
                let (after, before) = (self.slopes(after).0, self.slopes(before).0);
                after.iter().zip(before).map(|(x, y)| (x - y) / (2.0 * step)).collect()
            })
            .collect();
        let pairs = (0..phi.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
        for (ab, ba) in pairs.map(|(a, b)| (slopes[a][b], slopes[b][a])) {
            if (ab - ba).abs() > 1e-2 * (ab.abs() + ba.abs() + 0.1) {
                return Err(format!("a curl of {:.0e}", ab - ba));
            }
        }
        Ok(())
    }
}

fn reduced(name: &str, set: &[(&str, f64)], over: &[&str]) -> Reduced {
    let set: Vec<_> = set.iter().map(|&(name, x)| (name.into(), scene::Number::from(x))).collect();
    let scene = scene::catalogue::find(name, &set).expect("a scene");
    let place = |name: &&str| scene.system.coordinates.iter().position(|c| c.name == *name).expect("a coordinate");
    let (maggi, free) = (Maggi::new(&scene.system).expect("a referee"), over.iter().map(place).collect());
    Reduced { scene, maggi, free }
}

#[test]
fn multipliers_are_those_of_motions_in_numbers() {
    for (name, set, over, is_hamiltonian) in [
        ("sleigh", &[][..], &["y", "phi"][..], false),
        ("sleigh", &[("a", 0.0)], &["y", "phi"], true),
        ("veselova", &[], &["theta", "phi"], true),
        ("suslov", &[], &["theta", "phi"], false),
        ("suslov", &[("K", 0.0)], &["theta", "phi"], true),
        ("chaplygin-sphere", &[], &["psi", "theta", "phi"], false),
        ("rubber-chaplygin-sphere", &[], &["theta", "phi"], true),
        ("routh-sphere", &[], &["psi", "theta", "phi"], false),
        ("snakeboard", &[], &["theta", "psi", "phi"], false),
        ("martinet", &[], &["y", "z"], true),
    ] {
        let mut reduced = reduced(name, set, over);
        let n = reduced.scene.system.dimension();
        let place: Vec<f64> = (0..n).map(|i| 0.7 + 0.11 * i as f64).collect();
        let by_motions = reduced.is_hamiltonian(&place);
        assert_eq!(by_motions.is_ok(), is_hamiltonian, "{name} {set:?}: {by_motions:?}");
        let found = reversible_scene(&reduced.scene, 0).expect("an answer").reductions;
        let mut over = reduced.free.clone();
        over.sort_unstable();
        let own = found.iter().flatten().find(|found| found.over == over).expect("a reduced motion");
        assert_eq!(own.multiplier != Multiplier::None, is_hamiltonian, "{name} {set:?}: {own:?}");
    }
}
