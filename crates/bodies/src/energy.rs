//! `L = Σ m |ċ_G|²/2 + ω·Jω/2 + m g·c_G`.

use crate::chain::{Maker, Part, Placed};
use crate::text::{Sum, components, factor, is_zero, is_zero_vector, vector};
use crate::turn::{Axis, Turn, written};
use crate::{Body, Fault, Inertia, Written};

impl Maker<'_> {
    /// Kinetic energy of body `i`, and what its weight does.
    pub(crate) fn energy(&mut self, i: usize) -> Result<(), Fault> {
        let body = self.body(i).clone();
        let mut terms: Vec<String> = Vec::new();
        if let Some(mass) = body.mass.as_ref().filter(|mass| !is_zero(&mass.text)) {
            let mass = factor(&mass.text);
            let (centre, parts) = self.centre(i, &body);
            if !centre.is_empty() {
                // along axes that turn with the first moving part: no sines and cosines of their turn
                let turns = |part: &Part| part.turns.iter().any(|turn| !self.rate(&turn.angle).is_empty());
                let first = parts.iter().find(|part| turns(part) || self.machine.moves(&part.vector));
                let rate = match first.filter(|part| turns(part)).map(|part| part.turns.clone()) {
                    None => format!("{centre}'"),
                    Some(frame) => {
                        let velocity = self.velocity(&parts, &frame);
                        self.define(&body.name, "V", velocity)
                    }
                };
                terms.push(format!("{mass}/2*dot({rate}, {rate})"));
                terms.extend(self.weight(i, &mass, &centre));
            }
        }
        if let Some(moments) = moments(&body) {
            terms.extend(self.spin(i, &moments));
        }
        if !terms.is_empty() {
            let energy = self.define(&body.name, "L", terms.join(" + ").replace("+ -", "- "));
            self.made.energies.push(energy);
        }
        Ok(())
    }

    /// The mass centre against the base, by name, and its parts; empty for the origin.
    fn centre(&mut self, i: usize, body: &Body) -> (String, Vec<Part>) {
        let of_rod = || match &body.shape {
            Some((word, size)) if word.text == "rod" => {
                size.first().map(|length| format!("[{}/2, 0, 0]", factor(&length.text)))
            }
            _ => None,
        };
        let own = body.centre.as_ref().map(|centre| centre.text.clone()).or_else(of_rod);
        let Placed { at, mut parts, turns, .. } = self.placed(i);
        match own.filter(|own| !is_zero_vector(own)) {
            None => (at, parts),
            Some(own) => {
                let centre = self.point(i, &own);
                parts.push(Part { turns, vector: vector(&own) });
                (self.define(&body.name, "G", centre), parts)
            }
        }
    }

    /// `m g·c`.
    fn weight(&self, i: usize, mass: &str, centre: &str) -> Option<String> {
        let gravity = &self.machine.gravity.as_ref()?.text;
        let Some(base) = self.placed(i).base.map(|base| self.placed(base)) else {
            let upright = components(gravity).filter(|g| is_zero(&g[0]) && is_zero(&g[1]));
            let height = |g: [String; 3]| match &Sum::read(&g[2]).0[..] {
                [(true, g)] => format!("-{mass}*{}*{centre}.z", factor(g)),
                _ => format!("{mass}*{}*{centre}.z", factor(&g[2])),
            };
            return Some(upright.map_or_else(|| format!("{mass}*dot({gravity}, {centre})"), height));
        };
        Some(format!("{mass}*dot(transpose({})*{gravity}, {centre})", base.rotation))
    }

    /// `ω·Jω/2`.
    fn spin(&mut self, i: usize, moments: &Inertia) -> Option<String> {
        let placed = self.placed(i);
        if placed.turns.is_empty() {
            return None;
        }
        if let [Turn { axis: Axis::Letter(letter), angle }] = &placed.turns[..] {
            let k = "xyz".find(*letter)?;
            let moment = match moments {
                Inertia::Diagonal(moments) => &moments[k],
                Inertia::Full(rows) => &rows[k][k],
            };
            let rate = self.rate(angle);
            let turns = !is_zero(&moment.text) && !rate.is_empty();
            return turns.then(|| format!("{}/2*{}^2", factor(&moment.text), factor(&rate.to_string())));
        }
        match moments {
            Inertia::Full(rows) => {
                let (_, omega) = self.turning(i, None);
                let row = |row: &[Written; 3]| format!("[{}, {}, {}]", row[0].text, row[1].text, row[2].text);
                Some(format!("dot({omega}, [{}]*{omega})/2", rows.iter().map(row).collect::<Vec<_>>().join(", ")))
            }
            Inertia::Diagonal(moments) => {
                let m = moments.each_ref().map(|moment| moment.text.trim());
                if m.iter().all(|m| is_zero(m)) {
                    return None;
                }
                let last = placed.turns.last().and_then(|turn| match turn.axis {
                    Axis::Letter(letter) => Some(letter),
                    Axis::Along(_) => None,
                });
                // of revolution about its last turn
                let cut = last.filter(|&letter| {
                    let k = "xyz".find(letter).unwrap_or(0);
                    m[(k + 1) % 3] == m[(k + 2) % 3]
                });
                let (_, omega) = self.turning(i, cut);
                Some(match m[0] == m[1] && m[1] == m[2] {
                    true => format!("{}/2*dot({omega}, {omega})", factor(m[0])),
                    false => format!("dot({omega}, diag({}, {}, {})*{omega})/2", m[0], m[1], m[2]),
                })
            }
        }
    }

    /// Axes that carry body `i`, and its turning rate along them: its own axes, or, with `cut`, those without
    /// its last turn about that axis. Both by name, the axes empty where they do not turn.
    pub(crate) fn turning(&mut self, i: usize, cut: Option<char>) -> (String, String) {
        if let Some(known) = self.rates.get(&(i, cut)) {
            return known.clone();
        }
        let Placed { turns, rotation, .. } = self.placed(i);
        let (carrier, own) = carrier(&turns, cut);
        let name = self.body(i).name.clone();
        let axes = match carrier.len() {
            n if n == turns.len() => rotation,
            0 => String::new(),
            _ => self.define(&name, "C", written(carrier)),
        };
        let rate = self.rate(&own);
        let own = cut.filter(|_| !rate.is_empty()).map(|c| Axis::Letter(c).vector(&rate.to_string()));
        let of_carrier = (!axes.is_empty()).then(|| format!("body_angular_velocity({axes})"));
        let text = of_carrier.into_iter().chain(own).collect::<Vec<_>>().join(" + ");
        let omega = self.define(&name, "W", if text.is_empty() { "[0, 0, 0]".into() } else { text });
        self.rates.insert((i, cut), (axes.clone(), omega.clone()));
        (axes, omega)
    }
}

/// Turns without the last one about `cut`, and that one's angle.
pub(crate) fn carrier(turns: &[Turn], cut: Option<char>) -> (&[Turn], Sum) {
    match (turns.split_last(), cut) {
        (Some((last, before)), Some(letter)) if last.is_about(letter) => (before, last.angle.clone()),
        _ => (turns, Sum::default()),
    }
}

/// The moments that are given, or those of a homogeneous body of its shape; none of a mass point.
fn moments(body: &Body) -> Option<Inertia> {
    if body.inertia.is_some() {
        return body.inertia.clone();
    }
    let (word, size) = body.shape.as_ref()?;
    let mass = body.mass.as_ref().filter(|mass| !is_zero(&mass.text))?;
    let m = factor(&mass.text);
    let a: Vec<String> = size.iter().map(|size| factor(&size.text)).collect();
    let squares = |part: &str, x: &str, y: &str| format!("{m}*({x}^2 + {y}^2)/{part}");
    let (x, y, z) = match (word.text.as_str(), &a[..]) {
        ("disc" | "wheel", [a]) => (format!("{m}*{a}^2/4"), format!("{m}*{a}^2/2"), format!("{m}*{a}^2/4")),
        ("ball", [a]) => {
            let moment = format!("2*{m}*{a}^2/5");
            (moment.clone(), moment.clone(), moment)
        }
        ("ellipsoid", [a, b, c]) => (squares("5", b, c), squares("5", a, c), squares("5", a, b)),
        ("box", [a, b, c]) => (squares("12", b, c), squares("12", a, c), squares("12", a, b)),
        ("rod", [a]) => ("0".into(), format!("{m}*{a}^2/12"), format!("{m}*{a}^2/12")),
        ("cylinder", [r, l]) => {
            let across = format!("{m}*(3*{r}^2 + {l}^2)/12");
            (format!("{m}*{r}^2/2"), across.clone(), across)
        }
        _ => return None,
    };
    let place = mass.place.clone();
    Some(Inertia::Diagonal([x, y, z].map(|text| Written { text, place: place.clone() })))
}
