//! `[body]`, `[contact]`, `[spring]`, `[damper]`, `[motor]` and `[loop]`: read, and made formulas of.

use std::cell::RefCell;
use std::collections::HashMap;

use bodies::{
    Between, Body, Contact, FaultKind, Formulas, Inertia, Joint, Law, Link, LinkKind, Machine, Motion, Written,
};

use super::section::{Entry, Section, Source, Value};
use crate::format::{self, Key};
use crate::{SceneError, SceneErrorKind};

/// The keys of a scene that are about bodies.
pub(super) const KEYS: [&str; 7] = ["gravity", "body", "contact", "spring", "damper", "motor", "loop"];

/// What a formula has to be.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Number,
    Vector,
    Any,
}

/// What follows from bodies, and the formulas of the user that it is made of.
#[derive(Default)]
pub(super) struct Follows {
    pub(super) made: Formulas,
    pub(super) texts: Vec<(Written, Kind)>,
}

/// Reads the bodies of a scene, if there are any.
pub(super) fn read(source: Source, root: &Section) -> Result<Option<Follows>, SceneError> {
    if KEYS.iter().all(|key| root.get(key).is_none()) {
        return Ok(None);
    }
    let reader = Reader { source, texts: RefCell::default() };
    let mut machine = reader.names(root);
    if let Some(entry) = root.get("gravity") {
        machine.gravity = source.note(reader.vector(&entry));
    }
    machine.bodies = reader.each(root, "body", format::MACHINE, Reader::body);
    machine.contacts = reader.each(root, "contact", format::CONTACT, Reader::contact);
    machine.links = reader.each(root, "spring", format::SPRING, |reader, name, section| {
        let rest = section.get("rest").map(|entry| reader.number(&entry)).transpose()?;
        let stiffness = reader.required(section, "stiffness", "a number or an expression in quotes")?;
        reader.link(name, section, LinkKind::Spring(stiffness, rest))
    });
    machine.links.extend(reader.each(root, "damper", format::DAMPER, |reader, name, section| {
        let damping = reader.required(section, "damping", "a number or an expression in quotes")?;
        reader.link(name, section, LinkKind::Damper(damping))
    }));
    machine.links.extend(reader.each(root, "motor", format::MOTOR, |reader, name, section| {
        let force = reader.required(section, "force", "a number or an expression in quotes")?;
        reader.link(name, section, LinkKind::Motor(force))
    }));
    machine.links.extend(reader.each(root, "loop", format::LOOP, |reader, name, section| {
        section.require("between", "two bodies with a point of each")?;
        reader.link(name, section, LinkKind::Loop)
    }));
    source.no_fault()?;
    let made = machine.formulas();
    let made = made.map_err(|fault| source.error(&fault.place, SceneErrorKind::Bodies(fault.kind)))?;
    Ok(Some(Follows { made, texts: reader.texts.into_inner() }))
}

struct Reader<'s> {
    source: Source<'s>,
    texts: RefCell<Vec<(Written, Kind)>>,
}

impl Reader<'_> {
    /// What a scene says beside its bodies.
    fn names(&self, root: &Section) -> Machine {
        let keys = |section: &str| -> Vec<String> {
            let section = root.section(section).ok().flatten();
            section.iter().flat_map(|section| section.entries()).map(|entry| entry.key.to_owned()).collect()
        };
        let definitions = root.section("definitions").ok().flatten();
        let entries = definitions.iter().flat_map(|section| section.entries());
        let written = entries.filter_map(|entry| Some((entry.key.to_owned(), entry.text("").ok()?.text)));
        let definitions: HashMap<String, String> = written.collect();
        let mut taken = [keys("parameters"), keys("coordinates"), keys("definitions")].concat();
        let removals = root.section("removal").ok().flatten();
        for entry in removals.iter().flat_map(|removals| removals.entries()) {
            let memory = entry.section().ok().and_then(|removal| removal.section("memory").ok().flatten());
            taken.extend(memory.iter().flat_map(|memory| memory.entries()).map(|entry| entry.key.to_owned()));
        }
        let moving = keys("coordinates").into_iter().chain(["t".to_owned()]).collect();
        Machine { definitions, moving, taken, drawn: keys("view"), ..Machine::default() }
    }

    fn each<T>(
        &self,
        root: &Section,
        key: &str,
        keys: &[Key],
        read: impl Fn(&Self, Written, &Section) -> Result<T, SceneError>,
    ) -> Vec<T> {
        let section = self.source.note(root.section(key)).flatten();
        let one = |entry: Entry| {
            let section = entry.section()?;
            section.check_keys(keys);
            read(self, Written { text: entry.key.to_owned(), place: entry.key_span.clone() }, &section)
        };
        let entries = section.iter().flat_map(|section| section.entries());
        entries.filter_map(|entry| self.source.note(one(entry))).collect()
    }

    fn remember(&self, text: &Written, kind: Kind) {
        self.texts.borrow_mut().push((text.clone(), kind));
    }

    /// A number, or an expression.
    fn number(&self, entry: &Entry) -> Result<Written, SceneError> {
        let text = match entry.value()? {
            Value::Expression(written) => written.text,
            Value::Number(x) => {
                let raw = self.source.text.get(entry.span.clone()).unwrap_or_default();
                if raw.parse() == Ok(x) { raw.to_owned() } else { format!("{x:?}") }
            }
        };
        let written = Written { text, place: entry.span.clone() };
        self.remember(&written, Kind::Number);
        Ok(written)
    }

    fn numbers<const N: usize>(&self, entry: &Entry, expected: &'static str) -> Result<[Written; N], SceneError> {
        let numbers = entry.elements(expected)?.iter().map(|e| self.number(e)).collect::<Result<Vec<_>, _>>()?;
        let found = numbers.len();
        <[Written; N]>::try_from(numbers)
            .map_err(|_| entry.error(SceneErrorKind::WrongLength { what: "numbers", found, expected: N }))
    }

    fn vector(&self, entry: &Entry) -> Result<Written, SceneError> {
        const EXPECTED: &str = "a vector: a list of two or three numbers or expressions, or an expression in quotes";
        if let Ok(written) = entry.text(EXPECTED) {
            self.remember(&written, Kind::Vector);
            return Ok(written);
        }
        let elements = entry.elements(EXPECTED)?;
        if !matches!(elements.len(), 2 | 3) {
            let found = elements.len();
            return Err(entry.error(SceneErrorKind::WrongLength { what: "numbers", found, expected: 3 }));
        }
        let parts = elements.iter().map(|e| Ok(self.number(e)?.text)).collect::<Result<Vec<_>, _>>()?;
        Ok(Written { text: format!("[{}]", parts.join(", ")), place: entry.span.clone() })
    }

    /// An axis by its letter, or a vector.
    fn axis(&self, entry: &Entry) -> Result<Written, SceneError> {
        let letter = entry.text("").ok().filter(|text| matches!(text.text.trim(), "x" | "y" | "z"));
        letter.map_or_else(|| self.vector(entry), Ok)
    }

    fn rotation(&self, entry: &Entry) -> Result<Written, SceneError> {
        let written = entry.text("a rotation in quotes, as in \"rotation(z, phi)\"")?;
        self.remember(&written, Kind::Any);
        Ok(written)
    }

    fn required(&self, s: &Section, key: &'static str, expected: &'static str) -> Result<Written, SceneError> {
        self.number(&s.require(key, expected)?)
    }

    fn body(&self, name: Written, section: &Section) -> Result<Body, SceneError> {
        let vector = |key: &str| section.get(key).map(|entry| self.vector(&entry)).transpose();
        let shape = match (section.get("shape"), section.get("size")) {
            (Some(word), size) => {
                let sizes = match size {
                    Some(size) => size.elements("a list of numbers")?,
                    None => Vec::new(),
                };
                let sizes = sizes.iter().map(|size| self.number(size)).collect::<Result<_, _>>()?;
                Some((word.text(format::SHAPES)?, sizes))
            }
            (None, Some(_)) => {
                section.require("shape", format::SHAPES)?;
                None
            }
            (None, None) => None,
        };
        let joint = match (section.section("joint")?, section.get("joint")) {
            (Some(joint), Some(entry)) => {
                joint.check_keys(format::JOINT);
                if let Some(entry) = ["at", "rotation"].iter().find_map(|key| section.get(key)) {
                    let kind = FaultKind::Twice { key: entry.key.to_owned() };
                    return Err(entry.error_at_key(SceneErrorKind::Bodies(kind)));
                }
                self.joint(&entry, &joint)?
            }
            _ => {
                let rotation = section.get("rotation").map(|entry| self.rotation(&entry)).transpose()?;
                let motion = rotation.map_or(Motion::Fixed, Motion::Turned);
                Joint { place: name.place.clone(), at: vector("at")?, motion, ..Joint::default() }
            }
        };
        Ok(Body {
            shape,
            mass: section.get("mass").map(|entry| self.number(&entry)).transpose()?,
            inertia: section.get("inertia").map(|entry| self.inertia(&entry)).transpose()?,
            centre: vector("mass-centre")?,
            on: section.get("on").map(|on| on.text("the name of a body")).transpose()?,
            joint,
            name,
        })
    }

    fn inertia(&self, entry: &Entry) -> Result<Inertia, SceneError> {
        const EXPECTED: &str = "moments [A, B, C] about the body's axes, or three rows of the matrix";
        let elements = entry.elements(EXPECTED)?;
        match &elements[..] {
            [first, ..] if first.elements("").is_ok() => {
                let rows =
                    elements.iter().map(|row| self.numbers::<3>(row, EXPECTED)).collect::<Result<Vec<_>, _>>()?;
                let found = rows.len();
                let rows = <[[Written; 3]; 3]>::try_from(rows)
                    .map_err(|_| entry.error(SceneErrorKind::WrongLength { what: "rows", found, expected: 3 }))?;
                Ok(Inertia::Full(Box::new(rows)))
            }
            _ => Ok(Inertia::Diagonal(self.numbers(entry, EXPECTED)?)),
        }
    }

    fn joint(&self, entry: &Entry, s: &Section) -> Result<Joint, SceneError> {
        let vector = |key: &str| s.get(key).map(|entry| self.vector(&entry)).transpose();
        let kinds: Vec<Entry> =
            ["hinge", "slider", "plane", "ball", "surface", "fixed"].iter().filter_map(|kind| s.get(kind)).collect();
        let motion = match &kinds[..] {
            [kind] => match kind.key {
                "hinge" => Motion::Hinge(self.axis(kind)?, self.required(s, "angle", "the angle of the hinge")?),
                "slider" => Motion::Slider(self.axis(kind)?, self.required(s, "shift", "the shift of the slider")?),
                "plane" => Motion::Plane(self.numbers(kind, "a list of x, y and the angle")?),
                "ball" => Motion::Turned(self.rotation(kind)?),
                "surface" => {
                    let rotation = s.get("rotation").map(|entry| self.rotation(&entry)).transpose()?;
                    Motion::Surface(Box::new(self.numbers(kind, "a list of two coordinates of the surface")?), rotation)
                }
                _ if kind.boolean()? => Motion::Fixed,
                _ => return Err(kind.error(SceneErrorKind::WrongWord { found: "false".into(), expected: "true" })),
            },
            several => {
                let found: Vec<&str> = several.iter().map(|kind| kind.key).collect();
                let found = if found.is_empty() { "none".into() } else { found.join(" and ") };
                return Err(entry.error(SceneErrorKind::Bodies(FaultKind::Joint { found })));
            }
        };
        for (kind, key) in [("hinge", "angle"), ("slider", "shift"), ("surface", "rotation")] {
            if let Some(entry) = s.get(key).filter(|_| s.get(kind).is_none()) {
                return Err(entry.error_at_key(SceneErrorKind::Bodies(FaultKind::GoesWith { key, kind })));
            }
        }
        let axes = s.get("axes").map(|entry| self.rotation(&entry)).transpose()?;
        Ok(Joint { place: entry.span.clone(), at: vector("at")?, own: vector("own")?, axes, motion })
    }

    fn contact(&self, name: Written, s: &Section) -> Result<Contact, SceneError> {
        let vector = |key: &str| s.get(key).map(|entry| self.vector(&entry)).transpose();
        let law = s.require("law", format::LAWS)?;
        let found = law.text(format::LAWS)?.text;
        let law = match found.as_str() {
            "rolls" => Law::Rolls,
            "blade" => Law::Blade,
            "slides" => Law::Slides,
            "rubber" => Law::Rubber,
            _ => return Err(law.error(SceneErrorKind::WrongWord { found, expected: format::LAWS })),
        };
        Ok(Contact {
            name,
            of: s.require("of", "the name of a body")?.text("the name of a body")?,
            on: s.get("on").map(|on| on.text("the name of a body")).transpose()?,
            law,
            at: vector("at")?,
            along: vector("along")?,
        })
    }

    fn link(&self, name: Written, s: &Section, kind: LinkKind) -> Result<Link, SceneError> {
        let fault = || Err(self.source.error(&name.place, SceneErrorKind::Bodies(FaultKind::Between)));
        let between = match (s.get("joint"), s.section("between")?) {
            (Some(joint), None) => Between::Joint(joint.text("the name of a body")?),
            (None, Some(ends)) => {
                let end = |entry: Entry| {
                    let name = Written { text: entry.key.to_owned(), place: entry.key_span.clone() };
                    Ok((name, self.vector(&entry)?))
                };
                let ends = ends.entries().map(end).collect::<Result<Vec<_>, SceneError>>()?;
                match <[(Written, Written); 2]>::try_from(ends) {
                    Ok(ends) => Between::Points(ends),
                    Err(_) => return fault(),
                }
            }
            _ => return fault(),
        };
        Ok(Link { name, between, kind })
    }
}
