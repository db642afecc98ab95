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
const STRETCH: usize = 500;
const MOST: f64 = 0.8;

/// Also stalled: at the pace of the last `LONG` attempts the rest needs as many, and that pace is below
/// `SLOWER` of the average pace.
const LONG: usize = 8_000;
const SLOWER: f64 = 1e-2;

/// A point of a run: the time, and the number of steps or of attempts so far.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mark {
    t: f64,
    count: usize,
}

/// How fast a run moves the time.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Pace {
    start: f64,
    end: f64,
    many: Mark,
    stretch: Mark,
    long: Mark,
    /// Start and number of the latest consecutive windows that are too slow; the time that the first of them
    /// and the last window moved.
    slow: Mark,
    stretches: usize,
    first: f64,
    last: f64,
    /// Attempts that the rest needs at the pace of the last window; 0 before the first window.
    ahead: f64,
}

impl Pace {
    pub(crate) fn new(start: f64, end: f64) -> Self {
        let mark = Mark { t: start, count: 0 };
        let (stretches, first, last) = (0, 0.0, 0.0);
        Pace { start, end, many: mark, stretch: mark, long: mark, slow: mark, stretches, first, last, ahead: 0.0 }
    }

    /// Of a run that goes on to `end`.
    pub(crate) fn on_to(self, end: f64) -> Self {
        Pace { end, ..self }
    }

    /// If the rest needs more than `patience` attempts: that number, and the time that the last window moved.
    pub(crate) fn is_over(&self, patience: f64) -> Option<(f64, f64)> {
        (self.ahead > patience).then_some((self.ahead, self.last))
    }

    /// Checks a run for a stall at time `t`, after `steps` accepted steps out of `attempts`, at most `limit`
    /// of which are allowed. If it stalls: the number of the last steps (or attempts), and how far they moved
    /// the time.
    pub(crate) fn look(&mut self, t: f64, steps: usize, attempts: usize, limit: usize) -> Option<(usize, f64)> {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Number of steps after which a run is found to stall, within a million; `step(n, t)` is the length of
    /// step n.
    fn creeps(end: f64, step: impl Fn(f64, f64) -> f64) -> Option<usize> {
        let (mut pace, mut t) = (Pace::new(0.0, end), 0.0);
        (1..1_000_000).find(|&n| {
            t += step(n as f64, t);
            // one attempt in four is rejected
            t.abs() < end.abs() && pace.look(t, n - n / 4, n, 1_000_000).is_some()
        })
    }

    #[test]
    fn steps_that_shrink_without_end_creep() {
        for direction in [1.0, -1.0] {
            // the falling bicycle: 3e-8 after 2,000 steps, then as 1/n
            let found = creeps(direction * 20.0, |n, _| direction * if n < 1700.0 { 2.4e-3 } else { 6e-5 / n });
            assert!(found.is_some_and(|n| n > 3_000 && n < 6_000), "{found:?}");
            // fast, then at a steady pace that would take 3e8 steps
            let found = creeps(direction * 20.0, |n, _| direction * if n < 700.0 { 2e-3 } else { 6e-8 });
            assert!(found.is_some_and(|n| n > 8_000 && n <= 16_000), "{found:?}");
            // all at once
            let found = creeps(direction * 20.0, |n, _| direction * if n < 100.0 { 0.1 } else { 1e-12 });
            assert!(found.is_some_and(|n| n > 2_000 && n <= 8_000), "{found:?}");
        }
    }

    #[test]
    fn short_steps_and_steps_that_shrink_on_the_way_do_not() {
        // equal steps, even too many; ever faster turns, as g t/k; a layer of 1e-9 that is passed
        assert_eq!(creeps(1.0, |_, _| 1e-6), None);
        assert_eq!(creeps(1.0, |n, _| 1e-8 * (1.0 + 0.1 * n.sin())), None);
        assert_eq!(creeps(1000.0, |_, t| 0.05 / (1.0 + t)), None);
        assert_eq!(creeps(2.0, |_, t| 1e-10 + 1e-2 * (t - 1.0_f64).abs()), None);
    }
}
