//! Rotations as turns one after the other, each about an axis as the turns before have left it.

use crate::Machine;
use crate::text::{Sum, is_zero, split, vector, within};

/// An axis: x, y, z, or along a vector.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Axis {
    Letter(char),
    Along(String),
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Turn {
    pub(crate) axis: Axis,
    pub(crate) angle: Sum,
}

impl Axis {
    /// The axis along a vector, and whether it is turned round.
    pub(crate) fn read(text: &str) -> (Axis, bool) {
        let parts = crate::text::components(text);
        let number = |i: usize| parts.as_ref().and_then(|parts| parts[i].parse::<f64>().ok());
        for (i, letter) in "xyz".chars().enumerate() {
            let others = (0..3).filter(|&j| j != i).all(|j| number(j) == Some(0.0));
            match number(i) {
                Some(1.0) if others => return (Axis::Letter(letter), false),
                Some(-1.0) if others => return (Axis::Letter(letter), true),
                _ => {}
            }
        }
        match text.trim() {
            "x" | "y" | "z" => (Axis::Letter(text.trim().chars().next().unwrap_or('z')), false),
            _ => (Axis::Along(vector(text)), false),
        }
    }

    /// As a vector of length `length`.
    pub(crate) fn vector(&self, length: &str) -> String {
        match self {
            Axis::Letter('x') => format!("[{length}, 0, 0]"),
            Axis::Letter('y') => format!("[0, {length}, 0]"),
            Axis::Letter(_) => format!("[0, 0, {length}]"),
            Axis::Along(axis) => format!("({length})/sqrt(dot({axis}, {axis}))*{axis}"),
        }
    }
}

impl Turn {
    pub(crate) fn new(axis: &str, angle: &str) -> Turn {
        let (axis, round) = Axis::read(axis);
        let angle = Sum::read(angle);
        Turn { axis, angle: if round { angle.negative() } else { angle } }
    }

    /// Whether it is a quarter turn, and which way: its sine and cosine are exact.
    fn quarter(&self) -> Option<f64> {
        match (&self.axis, &self.angle.0[..]) {
            (Axis::Letter(_), [(negative, angle)]) if angle.replace(' ', "") == "pi/2" => {
                Some(if *negative { -1.0 } else { 1.0 })
            }
            _ => None,
        }
    }

    pub(crate) fn is_about(&self, letter: char) -> bool {
        self.axis == Axis::Letter(letter)
    }
}

/// The matrix of a turn by `sign` π/2.
fn quarter_turn(letter: char, sign: f64) -> String {
    match letter {
        'x' => format!("[[1, 0, 0], [0, 0, {}], [0, {sign}, 0]]", -sign),
        'y' => format!("[[0, 0, {sign}], [0, 1, 0], [{}, 0, 0]]", -sign),
        _ => format!("[[0, {}, 0], [{sign}, 0, 0], [0, 0, 1]]", -sign),
    }
}

/// One after the other; turns about one axis are one turn.
pub(crate) fn join(first: &[Turn], then: &[Turn]) -> Vec<Turn> {
    let mut turns = first.to_vec();
    for turn in then {
        match turns.pop() {
            Some(last) if last.axis == turn.axis => {
                turns.push(Turn { angle: last.angle.plus(&turn.angle), ..last });
            }
            last => turns.extend(last.into_iter().chain([turn.clone()])),
        }
        if turns.last().is_some_and(|last| last.angle.is_empty()) {
            turns.pop();
        }
    }
    turns
}

pub(crate) fn backwards(turns: &[Turn]) -> Vec<Turn> {
    turns.iter().rev().map(|turn| Turn { angle: turn.angle.negative(), ..turn.clone() }).collect()
}

/// [`written`] as a matrix, of quarter turns with exact sines and cosines.
pub(crate) fn matrix(turns: &[Turn]) -> String {
    let quarter = turns.iter().position(|turn| turn.quarter().is_some());
    let Some((i, turn, sign)) = quarter.and_then(|i| Some((i, &turns[i], turns[i].quarter()?))) else {
        return written(turns);
    };
    let letter = if let Axis::Letter(letter) = turn.axis { letter } else { 'z' };
    let factors = [written(&turns[..i]), quarter_turn(letter, sign), matrix(&turns[i + 1..])];
    factors.into_iter().filter(|factor| !factor.is_empty()).collect::<Vec<_>>().join("*")
}

/// The formula; none for no turn.
pub(crate) fn written(turns: &[Turn]) -> String {
    let mut factors: Vec<String> = Vec::new();
    let (mut word, mut angles) = (String::new(), String::new());
    let mut end = |word: &mut String, angles: &mut String, next: Option<String>| {
        if !word.is_empty() {
            factors.push(format!("rotation({word}{angles})"));
        }
        factors.extend(next);
        word.clear();
        angles.clear();
    };
    for turn in turns {
        match &turn.axis {
            Axis::Letter(letter) => {
                word.push(*letter);
                angles += &format!(", {}", turn.angle);
            }
            Axis::Along(axis) => {
                end(&mut word, &mut angles, Some(format!("rotation({axis}, {})", turn.angle)));
            }
        }
    }
    end(&mut word, &mut angles, None);
    factors.join("*")
}

/// The turns of a formula: a product of rotations, their transposes, and definitions of such.
pub(crate) fn read(machine: &Machine, text: &str, depth: usize) -> Option<Vec<Turn>> {
    let (text, depth) = (text.trim(), depth.checked_sub(1)?);
    if let [_, _, ..] = split(text, '*')[..] {
        let factors = split(text, '*').into_iter().map(|part| read(machine, part, depth));
        return factors.collect::<Option<Vec<_>>>().map(|parts| parts.iter().fold(Vec::new(), |a, b| join(&a, b)));
    }
    if let Some(inner) = within(text, "(") {
        return read(machine, inner, depth);
    }
    if let Some(inner) = within(text, "transpose(") {
        return read(machine, inner, depth).map(|turns| backwards(&turns));
    }
    if let Some(inner) = within(text, "rotation(") {
        let arguments = split(inner, ',');
        let (axes, angles) = arguments.split_first()?;
        let letters = axes.trim_matches('"');
        if letters.chars().all(|c| "xyz".contains(c)) && letters.chars().count() == angles.len() {
            let turn = |(letter, angle): (char, &&str)| Turn { axis: Axis::Letter(letter), angle: Sum::read(angle) };
            return Some(join(&[], &letters.chars().zip(angles).map(turn).collect::<Vec<_>>()));
        }
        return match angles {
            [angle] => Some(join(&[], &[Turn::new(axes, angle)])),
            _ => None,
        };
    }
    read(machine, machine.definitions.get(text)?, depth)
}

/// `turns*vector`; nothing for no vector.
pub(crate) fn turned(rotation: &str, vector: &str) -> String {
    let sum = Sum::read(vector);
    match (rotation, &sum.0[..]) {
        ("", _) => vector.into(),
        _ if is_zero(vector) => String::new(),
        (_, [_]) => format!("{rotation}*{vector}"),
        _ => format!("{rotation}*({vector})"),
    }
}
