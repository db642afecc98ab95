//! Balls and particles on the inner side of a cone, a cylinder or a bowl at rest.

use crate::chain::{Maker, Part, Placed};
use crate::contact::Touch;
use crate::text::factor;
use crate::turn::{Turn, backwards, join, matrix, turned, written};
use crate::{Body, Contact, Fault, FaultKind, Law, Motion, Written};

impl Maker<'_> {
    /// The middle of a body on a surface with parameters `(u, v)`, in axes that go with the contact: `u`
    /// along the generator from the apex of a cone, or along the axis of a cylinder, `v` about the axis.
    pub(crate) fn on_surface(&self, body: &Body, [u, v]: &[Written; 2], under: &[Turn]) -> Result<Part, Fault> {
        let Some((letter, size, a)) = self.surface(body) else {
            let kind = FaultKind::Surface { name: body.name.text.clone() };
            return Err(Fault { place: body.joint.place.clone(), kind });
        };
        let u = factor(&u.text);
        let (turns, vector) = match letter {
            "z" => (vec![Turn::new("z", &v.text), Turn::new("y", &size)], format!("[-{a}, 0, {u}]")),
            _ => (vec![Turn::new("x", &v.text)], format!("[{u}, 0, {a} - {size}]")),
        };
        Ok(Part { turns: join(under, &turns), vector })
    }

    /// Of the cone or cylinder that a body is on: its axis, half-angle or radius, and the body's radius.
    fn surface(&self, body: &Body) -> Option<(&'static str, String, String)> {
        let (word, size) = self.body(self.machine.find(body.on.as_ref()?).ok()?).shape.as_ref()?;
        let letter = match word.text.as_str() {
            "cone" => "z",
            "cylinder" => "x",
            _ => return None,
        };
        let a = match &body.shape {
            Some((word, size)) if word.text == "ball" => factor(&size.first()?.text),
            Some((word, _)) if word.text != "point" => return None,
            _ => "0".into(),
        };
        Some((letter, factor(&size.first()?.text), a))
    }

    /// The contact of body `i` with the curved body `under`.
    pub(crate) fn curved(&mut self, c: &Contact, i: usize, under: usize) -> Result<Touch, Fault> {
        let on = self.body(under).name.text.clone();
        let fault = |why| {
            let kind = FaultKind::Support { on: on.clone(), why };
            Err(Fault { place: c.name.place.clone(), kind })
        };
        let Placed { at: origin, turns: axes, rotation, .. } = self.placed(under);
        if self.machine.moves(&self.meaning(&origin)) || axes.iter().any(|turn| !self.rate(&turn.angle).is_empty()) {
            return fault("a curved surface has to be at rest");
        }
        if c.law == Law::Blade {
            return fault("a blade needs a plane");
        }
        if c.along.is_some() {
            return fault("`along` is for planes");
        }
        let body = self.body(i).clone();
        if let (Motion::Surface(..), Some((letter, _, a))) = (&body.joint.motion, self.surface(&body)) {
            let Placed { parts, turns, .. } = self.placed(i);
            let frame = parts.last().map(|part| part.turns.clone()).unwrap_or_default();
            // the outward normal and the generator in these axes
            let (n, generator) = if letter == "z" { ("[1, 0, 0]", 'z') } else { ("[0, 0, -1]", 'x') };
            let is_about = |turns: &[Turn]| turns.first().map(|turn| turn.axis.clone());
            let omega = if turns.is_empty() {
                "[0, 0, 0]".into()
            } else if is_about(&turns) == is_about(&frame) {
                // the first turns cancel
                let own = written(&join(&backwards(&frame), &turns));
                format!("angular_velocity({own}) + body_angular_velocity({})", written(&frame))
            } else {
                turned(&matrix(&backwards(&frame)), &format!("angular_velocity({})", written(&turns)))
            };
            let omega = self.define(&c.name, "w", omega);
            let velocity = self.velocity(&parts, &frame);
            let slip = self.define(&c.name, "slip", format!("{velocity} + {a}*cross({omega}, {n})"));
            let middle = self.point(i, "[0, 0, 0]");
            let outwards = turned(&matrix(&frame), &format!("({a}*{n})"));
            return Ok(Touch {
                at: self.define(&c.name, "touch", format!("{middle} + {outwards}")),
                rows: Some([format!("{slip}.y"), format!("{slip}.{generator}")]),
                slip,
                height: "0".into(),
                normal: None,
                spin: format!("dot({omega}, {n})"),
            });
        }
        let Some((k, l)) = curvatures(self.body(under)) else {
            return fault("on a cone or cylinder a ball or point has a joint `surface`; points slide in bowls as well");
        };
        if c.law != Law::Slides || self.body(i).shape.as_ref().is_some_and(|(word, _)| word.text != "point") {
            return fault("points slide in bowls; other contacts are written by hand");
        }
        let middle = self.point(i, "[0, 0, 0]");
        let from = if origin.is_empty() { middle.clone() } else { format!("{middle} - {origin}") };
        let p = match rotation.is_empty() && origin.is_empty() {
            true => from,
            false => self.define(
                &c.name,
                "p",
                if rotation.is_empty() { from } else { format!("transpose({rotation})*({from})") },
            ),
        };
        let height = format!("{p}.z - ({k}*{p}.x^2 + {l}*{p}.y^2)/2");
        let none = || "0".to_string();
        Ok(Touch { at: middle, slip: none(), rows: Some([none(), none()]), height, normal: None, spin: none() })
    }
}

/// The curvatures of a bowl.
fn curvatures(body: &Body) -> Option<(String, String)> {
    let (_, size) = body.shape.as_ref().filter(|(word, _)| word.text == "bowl")?;
    Some((factor(&size.first()?.text), factor(&size.get(1)?.text)))
}
