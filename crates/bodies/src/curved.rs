//! Contacts of balls and particles with the inner side of a cone, a cylinder or a bowl at rest.

use crate::chain::{Maker, Placed};
use crate::contact::Touch;
use crate::text::factor;
use crate::turn::turned;
use crate::{Contact, Fault, FaultKind, Law};

impl Maker<'_> {
    /// The contact of body `i` with the curved body `under`, in the axes of which its middle is `p`:
    /// `r = a n` with the outward normal `n` there, and the distance from the surface stays.
    pub(crate) fn curved(&mut self, c: &Contact, i: usize, under: usize) -> Result<Touch, Fault> {
        let on = self.body(under).name.text.clone();
        let fault = |why| {
            let kind = FaultKind::Support { on: on.clone(), why };
            Err(Fault { place: c.name.place.clone(), kind })
        };
        let Some((surface, size)) = self.body(under).shape.clone() else { return fault("it has no shape") };
        let size = |k: usize| size.get(k).map(|size| factor(&size.text));
        let (word, radius) = match &self.body(i).shape {
            Some((word, size)) => (word.text.clone(), size.first().map(|size| factor(&size.text))),
            None => ("point".into(), None),
        };
        let a = match (word.as_str(), radius) {
            ("ball", Some(a)) => a,
            ("point", _) if c.law == Law::Slides => "0".into(),
            _ => return fault("balls roll on curved surfaces, and points slide; other contacts are written by hand"),
        };
        let Placed { base, at: middle, rotation, .. } = self.placed(i);
        let Placed { base: other, at: origin, turns, rotation: axes } = self.placed(under);
        let meant = self.meaning(&origin);
        if self.machine.moves(&meant) || turns.iter().any(|turn| !self.rate(&turn.angle).is_empty()) {
            return fault("a curved surface has to be at rest");
        }
        if base != other && base != Some(under) || c.along.is_some() {
            return fault("the body stands on another one, or `along` is given, which is for planes");
        }
        let own = base == Some(under);
        let (origin, axes) = if own { Default::default() } else { (origin, axes) };
        let middle = if middle.is_empty() { "[0, 0, 0]".into() } else { middle };
        let from = if origin.is_empty() { middle.clone() } else { format!("{middle} - {origin}") };
        let back = if axes.is_empty() { String::new() } else { format!("transpose({axes})") };
        let p =
            if back.is_empty() && origin.is_empty() { from } else { self.define(&c.name, "p", turned(&back, &from)) };
        let (n, along, across, distance, height) = match (surface.text.as_str(), size(0), size(1)) {
            ("cone", Some(angle), _) => {
                // the distance from the axis where the ball touches: without a root, as the surface has it
                let rho = self.define(&c.name, "rho", format!("({p}.z*sin({angle}) - {a})/cos({angle})"));
                let (x, y) = (format!("{p}.x/{rho}"), format!("{p}.y/{rho}"));
                (
                    format!("[cos({angle})*{x}, cos({angle})*{y}, -sin({angle})]"),
                    format!("[sin({angle})*{x}, sin({angle})*{y}, cos({angle})]"),
                    format!("[-{y}, {x}, 0]"),
                    format!("sqrt({p}.x^2 + {p}.y^2)*cos({angle}) - {p}.z*sin({angle}) + {a}"),
                    format!("({p}.x^2 + {p}.y^2)*cos({angle})^2 - ({p}.z*sin({angle}) - {a})^2"),
                )
            }
            ("cylinder", Some(radius), _) => {
                let rho = format!("({radius} - {a})");
                let (y, z) = (format!("{p}.y/{rho}"), format!("{p}.z/{rho}"));
                (
                    format!("[0, {y}, {z}]"),
                    "[1, 0, 0]".into(),
                    format!("[0, -{z}, {y}]"),
                    format!("sqrt({p}.y^2 + {p}.z^2) - {rho}"),
                    format!("{p}.y^2 + {p}.z^2 - {rho}^2"),
                )
            }
            ("bowl", Some(k), Some(l)) if c.law == Law::Slides => {
                let zero = || "[0, 0, 0]".to_string();
                let distance = format!("{p}.z - ({k}*{p}.x^2 + {l}*{p}.y^2)/2");
                (zero(), zero(), zero(), distance.clone(), distance)
            }
            _ => return fault("balls roll in cones and cylinders, points slide in bowls as well"),
        };
        let n = self.define(&c.name, "n", n);
        let outwards = turned(&axes, &format!("{a}*{n}")).replace(&format!("*{a}*{n}"), &format!("*({a}*{n})"));
        let omega = match rotation.as_str() {
            "" => "[0, 0, 0]".into(),
            _ => self.define(&c.name, "w", format!("angular_velocity({rotation})")),
        };
        let slip = self.define(&c.name, "slip", format!("{middle}' + cross({omega}, {outwards})"));
        let slip = if back.is_empty() { slip } else { format!("{back}*{slip}") };
        let spin = if back.is_empty() { omega } else { format!("{back}*{omega}") };
        Ok(Touch {
            at: self.define(&c.name, "touch", format!("{middle} + {outwards}")),
            rows: Some([format!("dot({slip}, {along})"), format!("dot({slip}, {across})")]),
            slip,
            height,
            normal: Some(distance),
            spin: format!("dot({spin}, {n})"),
        })
    }
}
