//! The logger that an importer gives, and what came in by it.

#![allow(unsafe_code)]

use std::collections::BTreeSet;
use std::ffi::{CStr, c_char, c_void};
use std::sync::Mutex;

use super::library::Status;

/// What the library has logged.
#[derive(Clone, Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct Log {
    /// The first messages of status warning and worse.
    pub messages: Vec<String>,
    /// A message came without category.
    pub null_category: bool,
    /// A message came without text or name.
    pub null_text: bool,
    /// A text was not encoded in UTF-8.
    pub invalid_text: bool,
    /// The first categories.
    pub categories: BTreeSet<String>,
}

static LOG: Mutex<Log> = Mutex::new(Log {
    messages: Vec::new(),
    null_category: false,
    null_text: false,
    invalid_text: false,
    categories: BTreeSet::new(),
});

/// What has been logged until now.
pub fn logged() -> Log {
    LOG.lock().map(|log| log.clone()).unwrap_or_default()
}

/// The logger: it keeps the first messages, and the faults of all.
pub unsafe extern "C" fn log(
    _environment: *mut c_void,
    name: *const c_char,
    status: Status,
    category: *const c_char,
    message: *const c_char,
) {
    keep(name.is_null(), status, category, message);
}

/// The logger of FMI 3.0, which has no instance's name.
pub unsafe extern "C" fn log_of_three(
    _environment: *mut c_void,
    status: Status,
    category: *const c_char,
    message: *const c_char,
) {
    keep(false, status, category, message);
}

fn keep(is_nameless: bool, status: Status, category: *const c_char, message: *const c_char) {
    let Ok(mut log) = LOG.lock() else { return };
    log.null_category |= category.is_null();
    log.null_text |= message.is_null() || is_nameless;
    // SAFETY: both are C strings while the logger runs, by the standard.
    let text = |text: *const c_char| (!text.is_null()).then(|| unsafe { CStr::from_ptr(text) });
    if let Some(category) = text(category).filter(|_| log.categories.len() < 20) {
        log.categories.insert(category.to_string_lossy().into_owned());
    }
    if let Some(message) = text(message) {
        log.invalid_text |= message.to_str().is_err();
        if status > 0 && log.messages.len() < 5 {
            let shown = message.to_string_lossy().chars().take(300).collect();
            log.messages.push(shown);
        }
    }
}
