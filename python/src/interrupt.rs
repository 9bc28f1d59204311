//! Work in a thread of its own, while this one listens to Python's signals: Ctrl-C is heard at once.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// How often Python's signals are looked at.
const PERIOD: Duration = Duration::from_millis(50);

/// What the thread says.
enum Said<T> {
    Progress(String),
    Done(T),
}

/// Does the work. After a signal, its result is dropped when it comes.
///
/// # Errors
/// Python's signal, or a panic of the work.
pub fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    watched(py, &Arc::default(), |_| work(), |_| Ok(()))
}

/// Runs work with progress. It ends early when a signal sets `stop`.
///
/// # Errors
/// Python's signal, an exception of `progress`, or a panic of the work.
pub fn watched<T: Send + 'static>(
    py: Python<'_>,
    stop: &Arc<AtomicBool>,
    work: impl FnOnce(&(dyn Fn(&str) + Sync)) -> T + Send + 'static,
    progress: impl Fn(&str) -> PyResult<()>,
) -> PyResult<T> {
    let (sender, receiver) = channel::<Said<T>>();
    thread::spawn(move || {
        let done = catch_unwind(AssertUnwindSafe(|| {
            let told: Mutex<Sender<Said<T>>> = Mutex::new(sender.clone());
            // Who asked may have been interrupted and gone.
            work(&|text: &str| drop(told.lock().map(|to| to.send(Said::Progress(text.to_owned())))))
        }));
        if let Ok(done) = done {
            let _ = sender.send(Said::Done(done));
        }
    });
    let receiver = Mutex::new(receiver);
    loop {
        let said = py.detach(|| match receiver.lock() {
            Ok(receiver) => receiver.recv_timeout(PERIOD),
            Err(_) => Err(RecvTimeoutError::Disconnected),
        });
        let heard = match said {
            Ok(Said::Done(done)) => return Ok(done),
            Ok(Said::Progress(text)) => progress(&text),
            Err(RecvTimeoutError::Timeout) => py.check_signals(),
            Err(RecvTimeoutError::Disconnected) => {
                Err(PyRuntimeError::new_err("an internal error, printed above: please report it"))
            }
        };
        if let Err(error) = heard {
            stop.store(true, Ordering::Relaxed);
            return Err(error);
        }
    }
}
