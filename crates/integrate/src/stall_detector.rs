//! Detects runs that stall.

/// A run stalls where `MANY_STEPS` steps move the time by less than this part of the way so far: the rest
/// would take more than a thousand million steps.
const FEW: f64 = 1e-6;
const MANY_STEPS: usize = 3_000;

/// It stalls, too, where at the pace of each of the last `STRETCHES` windows of `STRETCH` attempts the rest
/// needs more than `TIMES_ALLOWED` times the limit and more than `TO_GO` attempts, and the windows shrink
/// smoothly: each moves the time by half to twice as much as the one before, the last by less than `MOST` of
/// the first. Towards a singularity, steps that round-off limits shrink as 1/n, without end. Steps that
/// follow the motion shrink by the same factor in every window, and far more, until they are too short or
/// past it.
const TIMES_ALLOWED: f64 = 10.0;
const TO_GO: f64 = 1e7;
const STRETCHES: usize = 4;
/// Attempts of a window.
pub const STRETCH: usize = 500;
const MOST: f64 = 0.8;

/// Also stalled: at the pace of the last `LONG` attempts the rest needs as many, and that pace is below
/// `SLOWER` of the average pace.
const LONG: usize = 8_000;
const SLOWER: f64 = 1e-2;

/// Near a loss of rank, one window of so many attempts that is too slow is enough, if at least this part of
/// them was refused: what is left there of the digits of the rates lets steps shrink for ever.
const REFUSALS: usize = 50;
const REFUSED: f64 = 0.7;

/// A point of a run: the time, and the number of steps or of attempts so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Mark {
    t: f64,
    count: usize,
}

/// How fast a run moves the time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StallDetector {
    start: f64,
    end: f64,
    many: Mark,
    stretch: Mark,
    long: Mark,
    refusals: Mark,
    /// Steps at the last of these marks.
    steps: usize,
    /// Start and number of the latest consecutive windows that are too slow; the time that the first of them
    /// and the last window moved.
    slow: Mark,
    stretches: usize,
    first: f64,
    last: f64,
    /// Attempts that the rest needs at the pace of the last window; 0 before the first window.
    ahead: f64,
}

impl StallDetector {
    pub fn new(start: f64, end: f64) -> Self {
        let mark = Mark { t: start, count: 0 };
        StallDetector {
            start,
            end,
            many: mark,
            stretch: mark,
            long: mark,
            refusals: mark,
            slow: mark,
            ..StallDetector::default()
        }
    }

    /// Of a run that goes on to `end`.
    pub(crate) fn on_to(self, end: f64) -> Self {
        StallDetector { end, ..self }
    }

    /// If the rest needs more than `patience` attempts: that number, and the time that the last window moved.
    pub(crate) fn is_over(&self, patience: f64) -> Option<(f64, f64)> {
        (self.ahead > patience).then_some((self.ahead, self.last))
    }

    /// Checks a run for a stall at time `t`, after `steps` accepted steps out of `attempts`, at most `limit`
    /// of which are allowed, maybe `near` a loss of rank. If it stalls: the number of the last steps (or
    /// attempts), and how far they moved the time.
    pub fn look(
        &mut self,
        t: f64,
        [steps, attempts, limit]: [usize; 3],
        near: impl FnOnce() -> bool,
    ) -> Option<(usize, f64)> {
        let since = |mark: Mark, count: usize| (count - mark.count, (t - mark.t).abs());
        let (many, moved) = since(self.many, steps);
        if many >= MANY_STEPS {
            if moved < FEW * (t - self.start).abs() {
                return Some((many, moved));
            }
            self.many = Mark { t, count: steps };
        }
        let endless = |count: usize, moved: f64| {
            (self.end - t).abs() / moved * count as f64 >= TO_GO.max(TIMES_ALLOWED * limit as f64)
        };
        let (count, moved) = since(self.refusals, attempts);
        if count >= REFUSALS {
            let taken = (steps - self.steps) as f64;
            if taken < (1.0 - REFUSED) * count as f64 && endless(count, moved) && near() {
                return Some((count, moved));
            }
            (self.refusals, self.steps) = (Mark { t, count: attempts }, steps);
        }
        let (long, moved) = since(self.long, attempts);
        if long >= LONG {
            let pace = (t - self.start).abs() / attempts as f64;
            if endless(long, moved) && moved < SLOWER * pace * long as f64 {
                return Some((long, moved));
            }
            self.long = Mark { t, count: attempts };
        }
        let (count, moved) = since(self.stretch, attempts);
        if count < STRETCH {
            return None;
        }
        self.ahead = (self.end - t).abs() / moved * count as f64;
        if !endless(count, moved) {
            self.stretches = 0;
        } else if self.stretches > 0 && moved > 0.5 * self.last && moved < 2.0 * self.last {
            self.stretches += 1;
        } else {
            (self.stretches, self.first, self.slow) = (1, moved, self.stretch);
        }
        (self.last, self.stretch) = (moved, Mark { t, count: attempts });
        if self.stretches < STRETCHES || moved > MOST * self.first {
            return None;
        }
        Some(since(self.slow, attempts))
    }
}
