//! Where bodies are, one joined to the other.

use std::ops::Range;
use symbolic::limits::DEPTH;

use crate::text::{Sum, is_zero_vector, vector};
use crate::turn::{Axis, Turn, backwards, join, matrix, read, turned, written};
use crate::{Body, Fault, FaultKind, Formulas, Machine, Made, Motion, Picture, Written};

/// A body against its base: space, or a body at rest that is turned in space.
#[derive(Clone, Debug, Default)]
pub(crate) struct Placed {
    pub(crate) base: Option<usize>,
    /// `c`, empty for the origin.
    pub(crate) at: String,
    /// What `c` is the sum of.
    pub(crate) parts: Vec<Part>,
    pub(crate) turns: Vec<Turn>,
    /// `R`, empty for none.
    pub(crate) rotation: String,
}

/// `R v`, a part of a place.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub(crate) turns: Vec<Turn>,
    pub(crate) vector: String,
}

/// Formulas while they are made.
pub(crate) struct Maker<'m> {
    pub(crate) machine: &'m Machine,
    pub(crate) placed: Vec<Option<Placed>>,
    pub(crate) rates: std::collections::HashMap<(usize, Option<char>), (String, String)>,
    pub(crate) made: Formulas,
    taken: Vec<String>,
}

impl Machine {
    /// All that follows from the bodies.
    ///
    /// # Errors
    /// [`Fault`] with the first that is wrong.
    pub fn formulas(&self) -> Result<Formulas, Fault> {
        let mut maker = Maker {
            machine: self,
            placed: vec![None; self.bodies.len()],
            rates: Default::default(),
            made: Formulas::default(),
            taken: self.taken.clone(),
        };
        for i in 0..self.bodies.len() {
            maker.place(i, &mut Vec::new())?;
        }
        for i in 0..self.bodies.len() {
            maker.energy(i)?;
        }
        for i in 0..self.bodies.len() {
            maker.draw(i);
        }
        for contact in &self.contacts {
            maker.contact(contact)?;
        }
        for link in &self.links {
            maker.link(link)?;
        }
        Ok(maker.made)
    }

    /// The body of that name.
    pub(crate) fn find(&self, name: &Written) -> Result<usize, Fault> {
        let names = || self.bodies.iter().map(|body| body.name.text.as_str());
        names().position(|known| known == name.text).ok_or_else(|| {
            let suggestion = symbolic::nearest(&name.text, names());
            let kind = FaultKind::NoBody { name: name.text.clone(), suggestion };
            Fault { place: name.place.clone(), kind }
        })
    }

    /// Whether a formula contains a coordinate or time.
    pub(crate) fn moves(&self, text: &str) -> bool {
        let mut seen: Vec<String> = Vec::new();
        let mut open = vec![text.to_owned()];
        while let Some(text) = open.pop() {
            for (name, place) in symbolic::names_in(&text) {
                let is_axes =
                    text[..place].trim_end().ends_with("rotation(") && name.chars().all(|c| "xyz".contains(c));
                if is_axes {
                    continue;
                }
                if self.moving.iter().any(|q| q == name) {
                    return true;
                }
                if let Some(meant) = self.definitions.get(name).filter(|_| !seen.iter().any(|s| s == name)) {
                    seen.push(name.into());
                    open.push(meant.clone());
                }
            }
        }
        false
    }

    /// A body that only something else stands on, at rest and turned.
    fn is_base(&self, body: &Body) -> bool {
        let Motion::Turned(rotation) = &body.joint.motion else { return false };
        let at = body.joint.at.as_ref().is_some_and(|at| self.moves(&at.text));
        body.on.is_none() && body.mass.is_none() && body.inertia.is_none() && !at && !self.moves(&rotation.text)
    }
}

impl Maker<'_> {
    pub(crate) fn placed(&self, i: usize) -> Placed {
        self.placed[i].clone().unwrap_or_default()
    }

    pub(crate) fn body(&self, i: usize) -> &Body {
        &self.machine.bodies[i]
    }

    pub(crate) fn rate(&self, angle: &Sum) -> Sum {
        angle.rate(|term| self.machine.moves(term))
    }

    /// A definition, by a name that is free; what is defined already has its name.
    pub(crate) fn define(&mut self, owner: &Written, part: &str, text: String) -> String {
        if let Some(known) = self.made.definitions.iter().find(|made| made.text == text) {
            return known.name.clone();
        }
        let mut name: String = owner.text.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
        if !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
            name.insert(0, 'b');
        }
        name = format!("{name}_{part}");
        while self.taken.contains(&name) {
            name.push('_');
        }
        self.taken.push(name.clone());
        self.made.definitions.push(Made { name: name.clone(), text, place: owner.place.clone() });
        name
    }

    pub(crate) fn turns(&self, text: &Written) -> Result<Vec<Turn>, Fault> {
        read(self.machine, &text.text, DEPTH).ok_or_else(|| {
            let kind = FaultKind::Rotation { found: text.text.clone() };
            Fault { place: text.place.clone(), kind }
        })
    }

    /// Finds where body `i` is, and before it those that it stands on.
    fn place(&mut self, i: usize, path: &mut Vec<usize>) -> Result<(), Fault> {
        if self.placed[i].is_some() {
            return Ok(());
        }
        let body = &self.machine.bodies[i];
        if let Some(first) = path.iter().position(|&above| above == i) {
            let names = path[first..].iter().chain([&i]).map(|&b| self.body(b).name.text.clone()).collect();
            return Err(Fault { place: body.name.place.clone(), kind: FaultKind::Circle { names } });
        }
        let mut under = Placed::default();
        if let Some(on) = &body.on {
            let parent = self.machine.find(on)?;
            path.push(i);
            self.place(parent, path)?;
            path.pop();
            let base = Placed { base: Some(parent), ..Placed::default() };
            let is_on_surface = matches!(body.joint.motion, Motion::Surface(..));
            let stands_on_base = self.machine.is_base(self.body(parent)) && !is_on_surface;
            under = if stands_on_base { base } else { self.placed(parent) };
        }
        let placed = self.join(body, &under)?;
        self.placed[i] = Some(placed);
        Ok(())
    }

    /// `R = R_p A T Aᵀ`, `c = c_p + R_p (at + A d) − R own`.
    fn join(&mut self, body: &Body, under: &Placed) -> Result<Placed, Fault> {
        let joint = &body.joint;
        let axes = joint.axes.as_ref().map_or(Ok(Vec::new()), |axes| self.turns(axes))?;
        let (turn, shift) = match &joint.motion {
            Motion::Fixed => (Vec::new(), None),
            Motion::Hinge(axis, angle) => (vec![Turn::new(&axis.text, &angle.text)], None),
            Motion::Slider(axis, shift) => {
                let (axis, round) = Axis::read(&axis.text);
                let shift = Sum::read(&shift.text);
                (Vec::new(), Some(axis.vector(&if round { shift.negative() } else { shift }.to_string())))
            }
            Motion::Plane([x, y, angle]) => {
                (vec![Turn::new("z", &angle.text)], Some(format!("[{}, {}, 0]", x.text, y.text)))
            }
            Motion::Turned(rotation) => (self.turns(rotation)?, None),
            Motion::Surface(..) => (Vec::new(), None),
        };
        let before = join(&under.turns, &axes);
        let turns = match &joint.motion {
            // the orientation of a ball on a surface is that in space
            Motion::Surface(_, rotation) => {
                rotation.as_ref().map_or(Ok(Vec::new()), |rotation| self.turns(rotation))?
            }
            _ => join(&join(&before, &turn), &backwards(&axes)),
        };
        let rotation = if turns.is_empty() {
            String::new()
        } else if turns == under.turns {
            under.rotation.clone()
        } else {
            self.define(&body.name, "R", written(&turns))
        };
        let given = |text: &Option<Written>| {
            let text = text.as_ref().filter(|v| !is_zero_vector(&v.text));
            text.map(|v| vector(&v.text))
        };
        let mut added: Vec<Part> = Vec::new();
        added.extend(given(&joint.at).map(|vector| Part { turns: under.turns.clone(), vector }));
        added.extend(shift.map(|vector| Part { turns: before.clone(), vector }));
        if let Motion::Surface(coordinates, _) = &joint.motion {
            added.push(self.on_surface(body, coordinates, &under.turns)?);
        }
        let terms = added.iter().map(|part| match part.turns == under.turns {
            true => turned(&under.rotation, &part.vector),
            false => turned(&matrix(&part.turns), &part.vector),
        });
        let sum = (!under.at.is_empty()).then(|| under.at.clone()).into_iter().chain(terms).collect::<Vec<_>>();
        let sum = sum.join(" + ");
        let text = match given(&joint.own) {
            Some(own) if sum.is_empty() => format!("-{}", turned(&rotation, &own)),
            Some(own) => format!("{sum} - {}", turned(&rotation, &own)),
            None => sum,
        };
        added.extend(given(&joint.own).map(|own| Part { turns: turns.clone(), vector: format!("-{own}") }));
        let parts = [under.parts.clone(), added].concat();
        let at = if text.is_empty() || text == under.at { text } else { self.define(&body.name, "at", text) };
        Ok(Placed { base: under.base, at, parts, turns, rotation })
    }

    /// A point of a body against its base.
    pub(crate) fn point(&self, i: usize, own: &str) -> String {
        let Placed { at, rotation, .. } = self.placed(i);
        match (at.as_str(), is_zero_vector(own)) {
            ("", true) => "[0, 0, 0]".into(),
            (_, true) => at,
            ("", false) => turned(&rotation, &vector(own)),
            (_, false) => format!("{at} + {}", turned(&rotation, &vector(own))),
        }
    }

    /// The velocity of a place that is the sum of `parts`, along the axes that `frame` turns to.
    pub(crate) fn velocity(&self, parts: &[Part], frame: &[Turn]) -> String {
        let mut sum = String::new();
        for Part { turns, vector } in parts.iter().filter(|part| !is_zero_vector(&part.vector)) {
            let mut terms = Vec::new();
            terms.extend(self.machine.moves(vector).then(|| format!("({vector})'")));
            let rates = turns.iter().map(|turn| (turn, self.rate(&turn.angle))).collect::<Vec<_>>();
            let rate = match &rates[..] {
                [(Turn { axis: axis @ Axis::Letter(_), .. }, rate)] => axis.vector(&rate.to_string()),
                _ => format!("body_angular_velocity({})", written(turns)),
            };
            terms.extend(rates.iter().any(|(_, rate)| !rate.is_empty()).then(|| format!("cross({rate}, {vector})")));
            if !terms.is_empty() {
                let seen = matrix(&join(&backwards(frame), turns));
                sum += &format!("{}{}", if sum.is_empty() { "" } else { " + " }, turned(&seen, &terms.join(" + ")));
            }
        }
        if sum.is_empty() { "[0, 0, 0]".into() } else { sum }
    }

    /// A place against a base, in space.
    pub(crate) fn in_space(&self, base: Option<usize>, at: &str) -> String {
        let Some(base) = base else { return if at.is_empty() { "[0, 0, 0]".into() } else { at.into() } };
        let base = self.placed(base);
        let turned = if at.is_empty() { String::new() } else { turned(&base.rotation, at) };
        match (base.at.as_str(), turned.as_str()) {
            ("", "") => "[0, 0, 0]".into(),
            ("", _) => turned,
            (_, "") => base.at,
            _ => format!("{} + {turned}", base.at),
        }
    }

    /// The picture of a body.
    fn draw(&mut self, i: usize) {
        let body = self.body(i);
        let is_drawn = self.machine.drawn.contains(&body.name.text);
        let none = (Written::default(), Vec::new());
        let Some((word, size)) = body.shape.as_ref().or(is_drawn.then_some(&none)) else { return };
        let Placed { base, at, rotation, .. } = self.placed(i);
        let sizes: Vec<String> = size.iter().map(|size| size.text.clone()).collect();
        let (shape, size) = match (word.text.as_str(), &sizes[..]) {
            ("wheel" | "disc", [radius, tyre]) => ("disc".into(), vec![format!("{radius} + {tyre}")]),
            ("wheel", _) => ("disc".into(), sizes),
            (other, _) => (other.into(), sizes),
        };
        let rotation = match base {
            Some(base) if rotation.is_empty() => self.placed(base).rotation,
            Some(base) => format!("{}*{rotation}", self.placed(base).rotation),
            None => rotation,
        };
        let (name, place): (String, Range<usize>) = (body.name.text.clone(), body.name.place.clone());
        let at = self.in_space(base, &at);
        self.made.pictures.push(Picture { name, shape, size, at, rotation, touches: Vec::new(), place });
    }
}
