//! Contacts: what does not slip, and the height that stays.

use crate::chain::{Maker, Part, Placed};
use crate::energy::carrier;
use crate::text::{Sum, components, factor, is_zero, vector};
use crate::turn::{Axis, Turn, backwards, join, turned, written};
use crate::{Contact, Fault, FaultKind, Law, Made, Row, Written};

/// Of a contact: where it is, how it slips, its two directions and its height, each a formula.
pub(crate) struct Touch {
    pub(crate) at: String,
    /// `s` in space without what the support does.
    pub(crate) slip: String,
    /// `s` along and across the heading, where it has one; what the support does is subtracted.
    pub(crate) rows: Option<[String; 2]>,
    pub(crate) height: String,
    /// `s·n`, where it is simpler than the rate of that height.
    pub(crate) normal: Option<String>,
    /// `ω·n`.
    pub(crate) spin: String,
}

impl Maker<'_> {
    /// Constraints of a contact, and its place in the picture.
    pub(crate) fn contact(&mut self, contact: &Contact) -> Result<(), Fault> {
        let i = self.machine.find(&contact.of)?;
        let touch = match self.is_on_curved(contact)? {
            Some(under) => self.curved(contact, i, under)?,
            None => {
                let support = self.support(contact, i)?;
                let touch = self.touch(contact, i, support)?;
                let turn = support.and_then(|on| self.placed(on).turns.first().map(|turn| self.rate(&turn.angle)));
                match turn.filter(|rate| !rate.is_empty()) {
                    Some(rate) => Touch { spin: format!("{} - ({rate})", touch.spin), ..touch },
                    None => touch,
                }
            }
        };
        let [along, across] = match (&contact.along, &touch.rows) {
            (None, Some(rows)) => rows.clone(),
            (given, _) => {
                let slip = self.define(&contact.name, "slip", touch.slip.clone());
                let along = given.as_ref().map_or_else(|| "[1, 0, 0]".into(), |along| vector(&along.text));
                [format!("dot({slip}, {along})"), format!("dot({slip}, cross([0, 0, 1], {along}))")]
            }
        };
        let (rolls, is_rough) = (matches!(contact.law, Law::Rolls | Law::Rubber), contact.law != Law::Slides);
        let spins = contact.law == Law::Rubber;
        let (normal, height) = match touch.normal {
            Some(normal) => (normal, Some(touch.height)),
            None => (touch.height, None),
        };
        // which of them are constraints, and which the ground can exert: along a smooth surface nothing
        let rows = [
            (along, None, "no slip along", rolls, is_rough),
            (across, None, "no slip across", is_rough, is_rough),
            (normal, height, "height", true, true),
            (touch.spin, None, "no turn about the normal", spins, spins),
        ];
        for (text, height, says, is_constraint, acts) in rows {
            let (name, place) = (contact.name.text.clone(), contact.name.place.clone());
            let says = format!("contact {name}: {says}");
            self.made.slips.extend(acts.then(|| Made { name, text: text.clone(), place: place.clone() }));
            self.made.rows.extend(is_constraint.then_some(Row { text, height, says, place }));
        }
        let on = contact.on.as_ref().map_or("ground", |on| on.text.as_str()).to_owned();
        let machine = self.machine;
        let is_drawn = machine.drawn.contains(&on) || self.made.pictures.iter().any(|p| p.name == on);
        let at = self.in_space(self.placed(i).base, &touch.at);
        let name = &machine.bodies[i].name.text;
        if let Some(picture) = self.made.pictures.iter_mut().find(|p| p.name == *name).filter(|_| is_drawn) {
            picture.touches.push((on, at));
        }
        Ok(())
    }

    /// The body under a contact, where it moves: a table that turns about z.
    fn support(&self, contact: &Contact, i: usize) -> Result<Option<usize>, Fault> {
        let base = self.placed(i).base;
        let Some(on) = &contact.on else {
            let kind = FaultKind::Support { on: "ground".into(), why: "the body stands on one that is turned" };
            let fault = Fault { place: contact.name.place.clone(), kind };
            return if base.is_none() { Ok(None) } else { Err(fault) };
        };
        let fault = |kind| Err(Fault { place: on.place.clone(), kind });
        if self.machine.drawn.contains(&on.text) && self.machine.bodies.iter().all(|body| body.name.text != on.text) {
            return Ok(None);
        }
        let under = self.machine.find(on)?;
        if base == Some(under) {
            return Ok(None);
        }
        let body = self.body(under);
        if body.shape.as_ref().is_some_and(|(word, _)| !matches!(word.text.as_str(), "plane" | "table")) {
            let why = "contacts are on planes and tables, in cones, cylinders and bowls";
            return fault(FaultKind::Support { on: on.text.clone(), why });
        }
        let Placed { at, turns, .. } = self.placed(under);
        if base.is_some() || turns.iter().any(|turn| !turn.is_about('z')) {
            return fault(FaultKind::Apart { body: contact.of.text.clone(), on: on.text.clone() });
        }
        let moves = !turns.is_empty() || self.machine.moves(&at) || body.on.is_some();
        let level = |at: &str| at.is_empty() || components(&self.meaning(at)).is_some_and(|c| is_zero(&c[2]));
        match level(&at) {
            true => Ok(moves.then_some(under)),
            false => fault(FaultKind::Support { on: on.text.clone(), why: "the plane of contacts is z = 0" }),
        }
    }

    /// The cone, cylinder or bowl that a contact is on.
    fn is_on_curved(&self, contact: &Contact) -> Result<Option<usize>, Fault> {
        let machine = self.machine;
        let Some(on) = contact.on.as_ref().filter(|on| machine.bodies.iter().any(|body| body.name.text == on.text))
        else {
            return Ok(None);
        };
        let under = machine.find(on)?;
        let word = self.body(under).shape.as_ref().map(|(word, _)| word.text.as_str());
        Ok(matches!(word, Some("cone" | "cylinder" | "bowl")).then_some(under))
    }

    /// What a name that was made stands for.
    pub(crate) fn meaning(&self, name: &str) -> String {
        self.made.definitions.iter().find(|made| made.name == name).map_or(name, |made| &made.text).into()
    }

    /// The velocity of a support at a place.
    fn carried(&self, support: Option<usize>, at: &str) -> Option<String> {
        let Placed { at: origin, turns, .. } = self.placed(support?);
        let rate = turns.first().map(|turn| self.rate(&turn.angle)).filter(|rate| !rate.is_empty());
        let turned = |rate: Sum| match origin.as_str() {
            "" => format!("cross([0, 0, {rate}], {at})"),
            _ => format!("cross([0, 0, {rate}], {at} - {origin})"),
        };
        match (self.machine.moves(&self.meaning(&origin)), rate) {
            (false, None) => None,
            (false, Some(rate)) => Some(turned(rate)),
            (true, None) => Some(format!("{origin}'")),
            (true, Some(rate)) => Some(format!("{origin}' + {}", turned(rate))),
        }
    }

    fn touch(&mut self, contact: &Contact, i: usize, support: Option<usize>) -> Result<Touch, Fault> {
        let shape = self.body(i).shape.clone();
        let size = |k: usize| shape.as_ref().and_then(|(_, size)| size.get(k)).map(|size| factor(&size.text));
        let word = shape.as_ref().map_or("point", |(word, _)| word.text.as_str());
        let cannot = |cannot| {
            let kind = FaultKind::Shape { shape: word.into(), cannot };
            Err(Fault { place: contact.name.place.clone(), kind })
        };
        let round = matches!(word, "disc" | "wheel" | "ball" | "ellipsoid");
        if round && contact.at.is_some() {
            return cannot("touches where its shape says: leave out `at`");
        }
        if matches!(word, "ball" | "ellipsoid") && contact.law == Law::Blade {
            return cannot("has no heading, which the law blade needs");
        }
        match (word, [size(0), size(1), size(2)]) {
            ("disc" | "wheel", [Some(a), tyre, _]) => Ok(self.wheel(contact, i, support, &a, tyre.as_deref())),
            ("ball", [Some(a), ..]) => Ok(self.ball(contact, i, support, &a)),
            ("ellipsoid", [Some(a), Some(b), Some(c)]) => Ok(self.ellipsoid(contact, i, support, [&a, &b, &c])),
            _ if round => cannot("needs its sizes to touch anything"),
            _ => match self.edge(contact, i, support) {
                Some(touch) => Ok(touch),
                None => cannot("has a heading only where its first turn is about z"),
            },
        }
    }

    /// `velocity` without that of the support.
    fn against(&self, support: Option<usize>, velocity: String, at: &str) -> String {
        match self.carried(support, at) {
            Some(carried) => format!("({velocity} - {carried})"),
            None => velocity,
        }
    }

    /// A point of the body, and its heading: its x axis before it leans.
    fn edge(&mut self, contact: &Contact, i: usize, support: Option<usize>) -> Option<Touch> {
        let own = contact.at.as_ref().map_or_else(|| "[0, 0, 0]".into(), |at| vector(&at.text));
        let point = self.point(i, &own);
        let at = self.named(&contact.name, "touch", point);
        let turns = self.placed(i).turns;
        let heading = heading(&turns);
        let velocity = self.against(support, format!("{at}'"), &at);
        let rows = match heading {
            Some(heading) => {
                let mut parts = self.placed(i).parts;
                parts.push(Part { turns: turns.clone(), vector: own });
                let seen = self.seen(contact, support, i, (&parts, &heading), &at);
                Some([format!("{seen}.x"), format!("{seen}.y")])
            }
            None if contact.law == Law::Blade => return None,
            None => None,
        };
        let spin = if turns.is_empty() || contact.law != Law::Rubber {
            "0".into()
        } else {
            let (axes, omega) = self.turning(i, None);
            self.upward(&axes, &omega)
        };
        Some(Touch { slip: velocity, rows, height: format!("{at}.z"), normal: None, spin, at })
    }

    /// The velocity of a place against the support, along and across a heading, by name.
    fn seen(
        &mut self,
        c: &Contact,
        on: Option<usize>,
        i: usize,
        (parts, heading): (&[Part], &Sum),
        at: &str,
    ) -> String {
        let frame = join(&[], &[Turn { axis: Axis::Letter('z'), angle: heading.clone() }]);
        let text = match on.map(|on| (self.stands_on(i, on), self.placed(on))) {
            // the axes of a support that carries the body do not turn for what is on it
            Some((true, Placed { parts: below, turns, .. })) => {
                let against = |turns_of: &[Turn]| join(&backwards(&turns), turns_of);
                let own = parts.iter().skip(below.len());
                let own: Vec<Part> = own.map(|part| Part { turns: against(&part.turns), ..part.clone() }).collect();
                self.velocity(&own, &against(&frame))
            }
            _ => {
                let velocity = self.velocity(parts, &frame);
                match self.carried(on, at) {
                    Some(carried) => {
                        format!("{velocity} - {}", turned(&written(&backwards(&frame)), &format!("({carried})")))
                    }
                    None => velocity,
                }
            }
        };
        self.define(&c.name, "v", text)
    }

    /// Whether a chain of joints leads from body `i` to another one.
    fn stands_on(&self, i: usize, other: usize) -> bool {
        let mut under = self.body(i).on.as_ref().and_then(|on| self.machine.find(on).ok());
        while let Some(body) = under.filter(|&body| body != other) {
            under = self.body(body).on.as_ref().and_then(|on| self.machine.find(on).ok());
        }
        under == Some(other)
    }

    /// A name for a formula that is used more than once.
    fn named(&mut self, owner: &Written, part: &str, text: String) -> String {
        let is_name = text.chars().all(|c| c.is_alphanumeric() || c == '_');
        if is_name { text } else { self.define(owner, part, text) }
    }

    /// The component along z of a vector in axes.
    fn upward(&self, axes: &str, omega: &str) -> String {
        if axes.is_empty() { format!("{omega}.z") } else { format!("dot({axes}*{omega}, [0, 0, 1])") }
    }

    fn wheel(&mut self, c: &Contact, i: usize, support: Option<usize>, a: &str, tyre: Option<&str>) -> Touch {
        let (middle, turns) = (self.point(i, "[0, 0, 0]"), self.placed(i).turns);
        let (carried_by, own) = carrier(&turns, Some('y'));
        let upright = match carried_by {
            [] => true,
            [one] => one.is_about('z') || one.is_about('x'),
            [first, second] => first.is_about('z') && second.is_about('x'),
            _ => false,
        };
        let (axes, omega) = self.turning(i, Some('y'));
        let tyre = tyre.filter(|b| !is_zero(b));
        let spin = self.upward(&axes, &omega);
        if !upright {
            return self.leaning(c, support, [a, tyre.unwrap_or("0")], [&middle, &axes, &omega], spin);
        }
        // from the middle to the contact along the wheel's own z axis: s = ṗ − a ψ̇ (heading), p the contact
        let down = turned(&axes, &format!("[0, 0, {a}]"));
        let leans = carried_by.iter().any(|turn| turn.is_about('x'));
        let down = if leans { down } else { format!("[0, 0, {a}]") };
        let below = tyre.map_or_else(String::new, |b| format!(" - [0, 0, {b}]"));
        let at = self.define(&c.name, "touch", format!("{middle} - {down}{below}"));
        let [along, across] = directions(&heading(carried_by).unwrap_or_default());
        let own = self.rate(&own);
        let wide = tyre.map_or_else(String::new, |b| {
            let omega = if axes.is_empty() { omega.clone() } else { format!("{axes}*{omega}") };
            format!(" - {b}*cross({omega}, [0, 0, 1])")
        });
        let velocity = match wide.is_empty() {
            true => self.against(support, format!("{at}'"), &at),
            false => format!("({}{wide})", self.against(support, format!("{at}'"), &at)),
        };
        let rolls = if own.is_empty() { String::new() } else { format!(" - {a}*{}", factor(&own.to_string())) };
        let slip = if own.is_empty() { velocity.clone() } else { format!("{velocity}{rolls}*{along}") };
        let rows = match tyre {
            Some(_) => [format!("dot({velocity}, {along}){rolls}"), format!("dot({velocity}, {across})")],
            None => {
                let mut parts = self.placed(i).parts;
                let turns = if leans { carried_by.to_vec() } else { Vec::new() };
                parts.push(Part { turns, vector: format!("-[0, 0, {a}]") });
                let heading = heading(carried_by).unwrap_or_default();
                let seen = self.seen(c, support, i, (&parts, &heading), &at);
                [format!("{seen}.x{rolls}"), format!("{seen}.y")]
            }
        };
        Touch { slip, rows: Some(rows), height: format!("{at}.z"), normal: None, spin, at }
    }

    /// A wheel in any position: `r = −a d/|d|`, `d = n − (n·e) e`, in the axes that carry it.
    fn leaning(
        &mut self,
        c: &Contact,
        support: Option<usize>,
        [a, tyre]: [&str; 2],
        [middle, axes, omega]: [&str; 3],
        spin: String,
    ) -> Touch {
        let up = self.define(&c.name, "up", format!("transpose({axes})*[0, 0, 1]"));
        let rho = self.define(&c.name, "rho", format!("sqrt({up}.x^2 + {up}.z^2)"));
        let (mut r, mut height) = (format!("-{a}/{rho}*[{up}.x, 0, {up}.z]"), format!("{middle}.z - {a}*{rho}"));
        if !is_zero(tyre) {
            r += &format!(" - {tyre}*{up}");
            height += &format!(" - {tyre}");
        }
        let r = self.define(&c.name, "r", r);
        let at = self.define(&c.name, "touch", format!("{middle} + {axes}*{r}"));
        let velocity = self.against(support, format!("{middle}'"), &at);
        let own = self.define(&c.name, "slip", format!("transpose({axes})*{velocity} + cross({omega}, {r})"));
        let along = format!("({up}.z*{own}.x - {up}.x*{own}.z)/{rho}");
        // with s·n = 0, what is across is what is along the axle
        let rows = Some([along, format!("{own}.y")]);
        Touch { slip: format!("{axes}*{own}"), rows, height, normal: Some(format!("dot({own}, {up})")), spin, at }
    }

    fn ball(&mut self, c: &Contact, i: usize, support: Option<usize>, a: &str) -> Touch {
        let (middle, rotation) = (self.point(i, "[0, 0, 0]"), self.placed(i).rotation);
        let omega = match rotation.as_str() {
            "" => "[0, 0, 0]".into(),
            _ => self.define(&c.name, "w", format!("angular_velocity({rotation})")),
        };
        let at = self.define(&c.name, "touch", format!("{middle} - [0, 0, {a}]"));
        let velocity = format!("{middle}' - {a}*cross({omega}, [0, 0, 1])");
        let slip = self.against(support, velocity, &at);
        let spin = if rotation.is_empty() { "0".into() } else { format!("{omega}.z") };
        Touch { slip, rows: None, height: format!("{at}.z"), normal: None, spin, at }
    }

    /// `r = −R D²ν/√(ν·D²ν)`, `ν = Rᵀn`.
    fn ellipsoid(&mut self, c: &Contact, i: usize, support: Option<usize>, d: [&str; 3]) -> Touch {
        let (middle, rotation) = (self.point(i, "[0, 0, 0]"), self.placed(i).rotation);
        if rotation.is_empty() {
            let at = self.define(&c.name, "touch", format!("{middle} - [0, 0, {}]", d[2]));
            let slip = self.against(support, format!("{middle}'"), &at);
            return Touch { slip, rows: None, height: format!("{at}.z"), normal: None, spin: "0".into(), at };
        }
        let (_, omega) = self.turning(i, None);
        let up = self.define(&c.name, "up", format!("transpose({rotation})*[0, 0, 1]"));
        let [x, y, z] = ["x", "y", "z"].map(|k| format!("{up}.{k}"));
        let square = format!("{}^2*{x}^2 + {}^2*{y}^2 + {}^2*{z}^2", d[0], d[1], d[2]);
        let reach = self.define(&c.name, "reach", format!("sqrt({square})"));
        let r = format!("-1/{reach}*[{}^2*{x}, {}^2*{y}, {}^2*{z}]", d[0], d[1], d[2]);
        let r = self.define(&c.name, "r", r);
        let at = self.define(&c.name, "touch", format!("{middle} + {rotation}*{r}"));
        let slip = self.against(support, format!("{middle}' + {rotation}*cross({omega}, {r})"), &at);
        let spin = self.upward(&rotation, &omega);
        let Placed { parts, turns, .. } = self.placed(i);
        let carries = support.is_some_and(|on| self.stands_on(i, on));
        let first = turns.first().filter(|turn| turn.is_about('z') && !carries).cloned();
        let rows = first.map(|first| {
            let seen = self.seen(c, support, i, (&parts, &first.angle), &at);
            let turns = written(&join(&backwards(&[first]), &turns));
            let slip =
                self.define(&c.name, "slip", format!("{seen} + {}", turned(&turns, &format!("cross({omega}, {r})"))));
            [format!("{slip}.x"), format!("{slip}.y")]
        });
        Touch { slip, rows, height: format!("{middle}.z - {reach}"), normal: None, spin, at }
    }
}

/// The angle of the first turn, if that is about z and the others leave the heading level.
fn heading(turns: &[Turn]) -> Option<Sum> {
    match turns {
        [] => Some(Sum::default()),
        [first] if first.is_about('x') => Some(Sum::default()),
        [first, rest @ ..] if first.is_about('z') && rest.iter().all(|turn| turn.axis == Axis::Letter('x')) => {
            Some(first.angle.clone())
        }
        _ => None,
    }
}

/// Along and across a heading.
fn directions(heading: &Sum) -> [String; 2] {
    match heading.is_empty() {
        true => ["[1, 0, 0]".into(), "[0, 1, 0]".into()],
        false => [format!("[cos({heading}), sin({heading}), 0]"), format!("[-sin({heading}), cos({heading}), 0]")],
    }
}
