//! A panic is a fault of the program. Its borders catch it, all in this way: a program says it in a line,
//! Python raises it, a row of a table has it as its cause.

use std::cell::{Cell, RefCell};
use std::panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind, panic_any, resume_unwind, set_hook, take_hook};
use std::sync::{LazyLock, Once};

use crate::cancel::Cancelled;

/// A fault of the program: what it says, and where.
#[derive(Clone, Debug, Default, PartialEq, Eq, thiserror::Error)]
#[error("{message}, at {place}{about}: this is a fault of deltaq; please report it")]
pub struct Broken {
    /// The message of the panic, in one line.
    pub message: String,
    /// File, line and column in the sources.
    pub place: String,
    /// What was worked on, behind a comma; nothing where that is not known.
    pub about: String,
}

/// Set to `through` nothing is caught, as in all checks: for them a panic is a failure. Set to the name of a
/// border something breaks there, for the tests of these borders.
static ASKED: LazyLock<Option<String>> = LazyLock::new(|| std::env::var("DELTAQ_PANICS").ok());

static HOOK: Once = Once::new();

thread_local! {
    /// How many borders the work of this thread is within.
    static BORDERS: Cell<usize> = const { Cell::new(0) };
    static ABOUT: RefCell<String> = const { RefCell::new(String::new()) };
    static KEPT: RefCell<Option<Broken>> = const { RefCell::new(None) };
}

/// Says what this thread works on from now on.
pub fn work_on(about: String) {
    ABOUT.set(about);
}

/// What this thread works on, for others that work for it.
pub fn worked_on() -> String {
    ABOUT.with_borrow(String::clone)
}

impl Broken {
    /// That of a panic.
    pub fn of(panic: &PanicHookInfo) -> Broken {
        if let Some(broken) = panic.payload().downcast_ref::<Broken>() {
            return broken.clone();
        }
        let lines = panic.payload_as_str().unwrap_or("panic").lines().map(str::trim);
        let about = Some(worked_on()).filter(|about| !about.is_empty());
        let about = about.map_or_else(String::new, |about| format!(", {about}"));
        let place = panic.location().map_or_else(|| "an unknown place".into(), ToString::to_string);
        Broken { message: lines.collect::<Vec<_>>().join("; "), place, about }
    }

    /// Breaks this thread, too, on which another one worked.
    pub fn hand_on(self) -> ! {
        match BORDERS.get() {
            0 => panic!("{self}"),
            _ => panic_any(self),
        }
    }
}

/// Does `work` within the border of this name; nothing of a panic is printed. Work that is no longer wanted
/// is left as before.
///
/// # Errors
/// [`Broken`].
pub fn caught<T>(border: &str, work: impl FnOnce() -> T) -> Result<T, Broken> {
    let asked = ASKED.as_deref();
    // where a panic aborts nothing can be caught
    if cfg!(panic = "abort") || asked == Some("through") {
        return Ok(work());
    }
    HOOK.call_once(|| {
        let outside = take_hook();
        set_hook(Box::new(move |panic| match BORDERS.get() {
            0 => outside(panic),
            _ => KEPT.set(Some(Broken::of(panic))),
        }));
    });
    let whole = AssertUnwindSafe(|| {
        assert!(asked != Some(border), "broken on purpose");
        work()
    });
    let outer = BORDERS.replace(BORDERS.get() + 1);
    let done = catch_unwind(whole);
    BORDERS.set(outer);
    done.map_err(|cause| match cause.is::<Cancelled>() {
        true => resume_unwind(cause),
        false => KEPT.take().unwrap_or_default(),
    })
}
