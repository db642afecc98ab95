//! What two writings of a page say differently: words to the letter, numbers to the digits that are sure.

use std::iter::Peekable;
use std::str::CharIndices;

use motion::CERTAINTY;
use symbolic::limits::NOTHING;

/// Numbers under [`NOTHING`] in size are round-off wherever they are written with a decimal point or an
/// exponent: two of them are the same up to this factor, for the last digits of sines differ among machines.
/// A number of fewer units of its last digit has none that is not sure: `0.3` is cut from `0.300`, and `1e-8`
/// is a bound.
const FEW: f64 = 9.5;

/// What was compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Compared {
    /// Pages.
    pub pages: usize,
    /// Numbers that are the same to the last digit.
    pub same: usize,
    /// Numbers of two digits or more, with a decimal point, whose last digit differs by one.
    pub last_digit: usize,
    /// Numbers that are round-off in both, and the same up to a factor of ten.
    pub round_off: usize,
}

impl Compared {
    /// The first difference of two writings of a page, with its line in the first of them; what is the
    /// same is counted. Of a picture (SVG), words and numbers are what is written in it; where lines run
    /// is not asked.
    ///
    /// # Errors
    /// Line and both writings.
    pub fn page(&mut self, old: &str, new: &str) -> Result<(), String> {
        self.pages += 1;
        let [old, new] = [old, new].map(|text| {
            if text.trim_start().starts_with("<svg") { written(text) } else { text.replace('\u{2212}', "-") }
        });
        let (mut olds, mut news) = (old.lines(), new.lines());
        let mut line = 0;
        loop {
            line += 1;
            match (olds.next(), news.next()) {
                (None, None) => return Ok(()),
                (Some(a), Some(b)) => self.line(a, b).map_err(|what| format!("line {line}: {what}"))?,
                (a, b) => return Err(format!("line {line}: {}, now {}", quoted(a), quoted(b))),
            }
        }
    }

    fn line(&mut self, old: &str, new: &str) -> Result<(), String> {
        if old == new {
            self.same += Tokens::of(old).filter(|token| token.number).count();
            return Ok(());
        }
        let (mut olds, mut news) = (Tokens::of(old), Tokens::of(new));
        loop {
            match (olds.next(), news.next()) {
                (None, None) => return Ok(()),
                (Some(a), Some(b)) if a.number && b.number && self.number(a.text, b.text) => {}
                (Some(a), Some(b)) if a == b => {}
                (a, b) => {
                    let [a, b] = [a, b].map(|token| quoted(token.map(|token| token.text)));
                    return Err(format!("{a}, now {b}, in {}", quoted(Some(old))));
                }
            }
        }
    }

    /// Whether two numbers are the same to the digits that are sure.
    fn number(&mut self, old: &str, new: &str) -> bool {
        let is_counted = |text: &str| !text.contains(['.', 'e']);
        let [Ok(a), Ok(b)] = [old, new].map(str::parse::<f64>) else { return false };
        let count = if old == new {
            &mut self.same
        } else if is_counted(old) || is_counted(new) {
            return false;
        } else if ulp(old) == ulp(new) && (a - b).abs() < 1.5 * ulp(old) && a.min(b) > FEW * ulp(old) {
            &mut self.last_digit
        } else if a.max(b) < NOTHING && a.max(b) <= CERTAINTY * a.min(b) {
            &mut self.round_off
        } else {
            return false;
        };
        *count += 1;
        true
    }
}

/// What the last digit of a number is worth.
fn ulp(text: &str) -> f64 {
    let (digits, exponent) = text.split_once('e').unwrap_or((text, "0"));
    let behind = digits.split_once('.').map_or(0, |(_, behind)| behind.len() as i32);
    10_f64.powi(exponent.parse::<i32>().unwrap_or(0) - behind)
}

fn quoted(text: Option<&str>) -> String {
    text.map_or("nothing".into(), |text| format!("`{text}`"))
}

/// The texts of a picture, one per line.
fn written(picture: &str) -> String {
    let texts = picture.split("<text").skip(1).filter_map(|rest| rest.split_once('>')?.1.split_once("</text>"));
    texts.map(|(text, _)| format!("{text}\n")).collect()
}

/// A number without its sign, or what is between two numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Token<'a> {
    text: &'a str,
    number: bool,
}

struct Tokens<'a> {
    text: &'a str,
    chars: Peekable<CharIndices<'a>>,
}

impl<'a> Tokens<'a> {
    fn of(text: &'a str) -> Self {
        Tokens { text, chars: text.char_indices().peekable() }
    }

    fn digits(&mut self) {
        while self.chars.next_if(|(_, c)| c.is_ascii_digit()).is_some() {}
    }

    /// Whether these characters follow; the last is a digit.
    fn follows(&self, ahead: &[fn(char) -> bool]) -> bool {
        let mut chars = self.chars.clone();
        ahead.iter().all(|is| chars.next().is_some_and(|(_, c)| is(c)))
    }
}

impl<'a> Iterator for Tokens<'a> {
    type Item = Token<'a>;

    fn next(&mut self) -> Option<Token<'a>> {
        let digit: fn(char) -> bool = |c| c.is_ascii_digit();
        let &(start, first) = self.chars.peek()?;
        let number = first.is_ascii_digit();
        if number {
            self.digits();
            if self.follows(&[|c| c == '.', digit]) {
                self.chars.next();
                self.digits();
            }
            if self.follows(&[|c| c == 'e', |c| c == '-', digit]) {
                self.chars.next();
                self.chars.next();
                self.digits();
            } else if self.follows(&[|c| c == 'e', digit]) {
                self.chars.next();
                self.digits();
            }
        } else {
            while self.chars.next_if(|(_, c)| !c.is_ascii_digit()).is_some() {}
        }
        let end = self.chars.peek().map_or(self.text.len(), |&(end, _)| end);
        Some(Token { text: &self.text[start..end], number })
    }
}
