//! Newton's and Euler's equations body by body, reactions eliminated by Gauss' principle.

use nalgebra::{DMatrix, DVector, Matrix3};

use super::frame::{Between, Force, Frame, Law, Shape, Step, V, Value};
use super::machine::Machine;

impl Machine {
    pub(super) fn frames(&self, now: (f64, &[f64], &[f64])) -> Vec<Frame> {
        let mut frames: Vec<Frame> = Vec::new();
        for body in &self.bodies {
            let under = body.parent.map_or_else(|| Frame::space(now.1.len()), |parent| frames[parent].clone());
            frames.push(body.steps.iter().fold(under, |frame, step| frame.step(step, now)));
        }
        frames
    }

    /// `q''`, and the largest violation of places and velocities that are constrained.
    pub(super) fn accelerations(&self, t: f64, q: &[f64], v: &[f64]) -> (DVector<f64>, f64) {
        let n = q.len();
        let frames = self.frames((t, q, v));
        let (mut mass, mut force) = (DMatrix::zeros(n, n), DVector::zeros(n));
        for (body, frame) in self.bodies.iter().zip(&frames) {
            let Frame { r, of_v, of_w, w, a, alpha, .. } = frame.point(body.centre);
            let moments = r * body.moments * r.transpose();
            mass += of_v.transpose() * &of_v * body.mass + of_w.transpose() * moments * &of_w;
            force -= of_v.transpose() * (a - self.gravity) * body.mass;
            force -= of_w.transpose() * (moments * alpha + w.cross(&(moments * w)));
        }
        let (mut rows, mut biases, mut off): (Vec<DVector<f64>>, Vec<f64>, f64) = (Vec::new(), Vec::new(), 0.0);
        let place =
            |&(i, own): &(Option<usize>, V)| i.map_or_else(|| Frame::space(n).point(own), |i| frames[i].point(own));
        for (between, kind) in &self.forces {
            let (length, gradient, rate) = match between {
                Between::Joint(arg) => {
                    let Value { now, gradient, rate, .. } = arg.at(t, q, v);
                    let mut row = DVector::zeros(n);
                    gradient.iter().for_each(|&(k, c)| row[k] += c);
                    (now, row, rate)
                }
                Between::Points(ends) => {
                    let [one, two] = ends.each_ref().map(place);
                    let (gap, slip) = (one.p - two.p, one.v - two.v);
                    if let Force::Loop = kind {
                        rows.extend((&one.of_v - &two.of_v).row_iter().map(|row| row.transpose()));
                        biases.extend((one.a - two.a).iter());
                        off = off.max(gap.amax()).max(slip.amax());
                        continue;
                    }
                    let e = gap.normalize();
                    (gap.norm(), (&one.of_v - &two.of_v).transpose() * e, slip.dot(&e))
                }
            };
            force += gradient
                * match kind {
                    Force::Spring(k, rest) => -k * (length - rest),
                    Force::Damper(c) => -c * rate,
                    Force::Motor(k) => k * t.cos(),
                    Force::Loop => 0.0,
                };
        }
        for contact in &self.contacts {
            let (body, under) =
                (&frames[contact.of], contact.on.map_or_else(|| Frame::space(n), |on| frames[on].clone()));
            let Frame { r: axes, w, .. } = *body;
            if let Shape::Bowl(k, l) = contact.shape {
                let [p, rate] = [body.p - under.p, body.v].map(|x| under.r.transpose() * x);
                let gradient = under.r * V::new(-k * p.x, -l * p.y, 1.0);
                rows.push(body.of_v.transpose() * gradient);
                biases.push(gradient.dot(&body.a) - k * rate.x * rate.x - l * rate.y * rate.y);
                let height = p.z - (k * p.x * p.x + l * p.y * p.y) / 2.0;
                off = off.max(height.abs()).max(gradient.dot(&body.v).abs());
                continue;
            }
            if let (Shape::Inside(a), Some((steps, normal))) = (contact.shape, &self.bodies[contact.of].surface) {
                let axes = steps.iter().fold(under, |frame, step| frame.step(step, (t, q, v)));
                let out = axes.r * normal;
                let (x, rate) = (out * a, axes.w.cross(&out) * a);
                let slip = body.v + w.cross(&x);
                let row = &body.of_v - x.cross_matrix() * &body.of_w;
                let bias = body.a + body.alpha.cross(&x) + w.cross(&rate);
                for e in axes.r.column_iter().filter(|e| contact.law != Law::Slides && e.dot(&out).abs() < 0.5) {
                    rows.push(row.transpose() * e);
                    biases.push(e.dot(&bias));
                    off = off.max(slip.amax());
                }
                if contact.law == Law::Rubber {
                    rows.push(body.of_w.transpose() * out);
                    biases.push(out.dot(&body.alpha) + axes.w.cross(&out).dot(&w));
                    off = off.max(out.dot(&w).abs());
                }
                continue;
            }
            let up = under.r.column(2).into_owned();
            // from the middle to the contact, and the rate of that; for a blade, what is across
            let axle = axes.column(1).into_owned();
            let flat = |e: V| e - up * up.dot(&e);
            let (x, rate, across) = match contact.shape {
                Shape::Point(own) => (axes * own, w.cross(&(axes * own)), up.cross(&(axes.column(0).into_owned()))),
                Shape::Inside(_) | Shape::Bowl(..) => (V::zeros(), V::zeros(), axle),
                Shape::Ball(a) => (-a * up, V::zeros(), axle),
                Shape::Wheel(a, tyre) => {
                    let turning = w.cross(&axle);
                    let (d, turned) = (up - axle * up.dot(&axle), -turning * up.dot(&axle) - axle * up.dot(&turning));
                    let size = d.norm();
                    (-a / size * d - tyre * up, -a * (turned / size - d * d.dot(&turned) / size.powi(3)), flat(axle))
                }
                Shape::Ellipsoid(s) => {
                    let squares = Matrix3::from_diagonal(&s.component_mul(&s));
                    let (nu, own) = (axes.transpose() * up, axes.transpose() * w);
                    let (turned, reach) = (-own.cross(&nu), nu.dot(&(squares * nu)).sqrt());
                    let (x, reached) = (-squares * nu / reach, nu.dot(&(squares * turned)) / reach);
                    let rate = -squares * turned / reach - x * (reached / reach);
                    (axes * x, axes * (own.cross(&x) + rate), axle)
                }
            };
            let rho = body.p + x - under.p;
            let rho_rate = body.v + rate - under.v;
            let slip = body.v + w.cross(&x) - under.v - under.w.cross(&rho);
            let row = &body.of_v - x.cross_matrix() * &body.of_w - (&under.of_v - rho.cross_matrix() * &under.of_w);
            let change = body.a + body.alpha.cross(&x) + w.cross(&rate);
            let bias = change - under.a - under.alpha.cross(&rho) - under.w.cross(&rho_rate);
            let mut add = |e: V, turned: V| {
                rows.push(row.transpose() * e);
                biases.push(e.dot(&bias) + turned.dot(&slip));
                off = off.max(e.dot(&slip).abs());
            };
            add(up, V::zeros());
            match contact.law {
                Law::Slides => {}
                Law::Rolls | Law::Rubber => {
                    [0, 1].into_iter().for_each(|k| add(under.r.column(k).into_owned(), V::zeros()))
                }
                Law::Blade => add(
                    across,
                    if let Shape::Point(_) = contact.shape { w.cross(&across) } else { flat(w.cross(&axle)) },
                ),
            }
            if contact.law == Law::Rubber {
                rows.push((&body.of_w - &under.of_w).transpose() * up);
                biases.push(up.dot(&(body.alpha - under.alpha)));
                off = off.max(up.dot(&(w - under.w)).abs());
            }
            off = off.max(up.dot(&rho).abs());
        }
        let mut found = mass.clone().cholesky().map(|mass| mass.solve(&force)).unwrap_or_else(|| DVector::zeros(0));
        if !rows.is_empty() && found.len() == n {
            let g = DMatrix::from_columns(&rows).transpose();
            let weight = mass.cholesky().map(|mass| mass.solve(&g.transpose())).unwrap_or_else(|| g.transpose());
            let missing = -DVector::from_vec(biases) - &g * &found;
            let inverse = (&g * &weight).pseudo_inverse(1e-9).unwrap_or_else(|e| panic!("{e}"));
            found += weight * (inverse * missing);
        }
        (found, off)
    }

    /// Whether a wheel leans by more than 90°: then its rows are those of its highest point.
    pub(super) fn leans_past_flat(&self, t: f64, q: &[f64]) -> bool {
        let still = vec![0.0; q.len()];
        self.contacts.iter().any(|contact| match (contact.shape, &self.bodies[contact.of].steps[..]) {
            (Shape::Wheel(..), [.., Step::Turn(z, _), Step::Turn(x, lean), Step::Turn(..)]) => {
                *z == V::z() && *x == V::x() && lean.at(t, q, &still).now.cos() < 0.0
            }
            _ => false,
        })
    }
}
