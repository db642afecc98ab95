//! Stops an integration from another thread, and reports its progress.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use crate::status::StopCause;

/// A flag by which another thread ends an integration, and sees how far it is. Clones share it; two are equal
/// if they are one flag.
///
/// ```
/// use integrate::{Interrupt, StopCause};
/// let interrupt = Interrupt::default();
/// let shared = interrupt.clone();
/// let limited = interrupt.within(1e-9);
/// assert_eq!(limited.cause(), Some(StopCause::TimeLimit { seconds: 1e-9 }));
/// assert_eq!(interrupt.cause(), None);
/// shared.raise();
/// assert!(interrupt.is_raised() && interrupt == shared && interrupt != Interrupt::default());
/// ```
#[derive(Clone, Debug, Default)]
pub struct Interrupt {
    shared: Arc<Shared>,
    deadline: Option<Deadline>,
}

#[derive(Debug, Default)]
struct Shared {
    raised: AtomicBool,
    /// Bits of the time reached.
    time: AtomicU64,
    steps: AtomicUsize,
}

#[derive(Clone, Copy, Debug)]
struct Deadline {
    at: Instant,
    seconds: f64,
}

impl Interrupt {
    /// Asks every integration that was given this flag to stop before its next step. It cannot be taken back.
    pub fn raise(&self) {
        self.shared.raised.store(true, Ordering::Relaxed);
    }

    /// Whether what was given this flag has to end.
    pub fn is_raised(&self) -> bool {
        self.cause().is_some()
    }

    /// Why what was given this flag has to end, if it has.
    pub fn cause(&self) -> Option<StopCause> {
        if self.shared.raised.load(Ordering::Relaxed) {
            return Some(StopCause::Interrupted);
        }
        let deadline = self.deadline.filter(|deadline| Instant::now() >= deadline.at)?;
        Some(StopCause::TimeLimit { seconds: deadline.seconds })
    }

    /// The same flag, with a deadline in seconds from now, wall clock; not positive: at once.
    #[must_use]
    pub fn within(&self, seconds: f64) -> Interrupt {
        let length = Duration::try_from_secs_f64(seconds.max(0.0)).ok();
        // a time that no clock shows is no limit
        let at = length.and_then(|length| Instant::now().checked_add(length));
        Interrupt { shared: self.shared.clone(), deadline: at.map(|at| Deadline { at, seconds }) }
    }

    /// Reports progress (time, steps) to the watcher; returns the stop cause, if any ([`Interrupt::cause`]).
    pub fn pass(&self, t: f64, steps: usize) -> Option<StopCause> {
        self.shared.time.store(t.to_bits(), Ordering::Relaxed);
        self.shared.steps.store(steps, Ordering::Relaxed);
        self.cause()
    }

    /// Time and steps that the integration under way has come to; 0 where none has begun.
    pub fn reached(&self) -> (f64, usize) {
        (f64::from_bits(self.shared.time.load(Ordering::Relaxed)), self.shared.steps.load(Ordering::Relaxed))
    }
}

impl PartialEq for Interrupt {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.shared, &other.shared)
    }
}
