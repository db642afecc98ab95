//! Springs, dampers, motors and loops.

use crate::chain::Maker;
use crate::text::{Sum, factor, is_zero};
use crate::{Between, Fault, FaultKind, Link, LinkKind, Motion, Row, Work, Written};

impl Maker<'_> {
    pub(crate) fn link(&mut self, link: &Link) -> Result<(), Fault> {
        let place = link.name.place.clone();
        let length = match &link.between {
            Between::Joint(joint) => self.coordinate(joint)?,
            Between::Points(ends) => {
                let gap = self.gap(ends)?;
                let gap = self.define(&link.name, "gap", gap);
                if let LinkKind::Loop = link.kind {
                    self.made.rows.extend(["x", "y", "z"].map(|axis| Row {
                        text: format!("{gap}.{axis}"),
                        height: None,
                        says: format!("loop {}: its points coincide along {axis}", link.name.text),
                        place: place.clone(),
                    }));
                    return Ok(());
                }
                let square = format!("dot({gap}, {gap})");
                // without a rest length no root is needed, which would be singular where the points meet
                if let LinkKind::Spring(stiffness, rest) = &link.kind
                    && rest.as_ref().is_none_or(|rest| is_zero(&rest.text))
                {
                    self.made.energies.push(format!("-{}/2*{square}", factor(&stiffness.text)));
                    return Ok(());
                }
                self.define(&link.name, "length", format!("sqrt({square})"))
            }
        };
        match &link.kind {
            LinkKind::Spring(stiffness, rest) => {
                let rest = rest.as_ref().map_or_else(Sum::default, |rest| Sum::read(&rest.text));
                let stretch = Sum::read(&length).plus(&rest.negative());
                self.made.energies.push(format!("-{}/2*({stretch})^2", factor(&stiffness.text)));
            }
            LinkKind::Damper(damping) => {
                let force = format!("-{}*({length})'", factor(&damping.text));
                self.made.works.push(Work { along: length, force, place });
            }
            LinkKind::Motor(force) => self.made.works.push(Work { along: length, force: force.text.clone(), place }),
            LinkKind::Loop => {}
        }
        Ok(())
    }

    /// The angle or shift of the joint that carries a body.
    fn coordinate(&self, joint: &Written) -> Result<String, Fault> {
        let i = self.machine.find(joint)?;
        match &self.body(i).joint.motion {
            Motion::Hinge(_, coordinate) | Motion::Slider(_, coordinate) | Motion::Plane([_, _, coordinate]) => {
                Ok(coordinate.text.clone())
            }
            Motion::Fixed | Motion::Turned(_) | Motion::Surface(..) => {
                let kind = FaultKind::NoJoint { name: joint.text.clone() };
                Err(Fault { place: joint.place.clone(), kind })
            }
        }
    }

    /// From the second point to the first, in space if they stand on different bases.
    fn gap(&self, [first, second]: &[(Written, Written); 2]) -> Result<String, Fault> {
        let place = |(name, point): &(Written, Written)| -> Result<(Option<usize>, String), Fault> {
            match self.machine.find(name) {
                Ok(i) => Ok((self.placed(i).base, self.point(i, &point.text))),
                Err(_) if name.text == "space" => Ok((None, crate::text::vector(&point.text))),
                Err(fault) => Err(fault),
            }
        };
        let (one, two) = (place(first)?, place(second)?);
        let seen = |(base, at)| if one.0 == two.0 { String::clone(at) } else { self.in_space(base, at) };
        Ok(format!("{} - ({})", seen((one.0, &one.1)), seen((two.0, &two.1))))
    }
}
