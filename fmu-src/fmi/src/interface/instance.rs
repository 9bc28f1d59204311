//! An instance, and the way into it that every function takes.

use std::{
    any::Any,
    ffi::CString,
    panic::{AssertUnwindSafe, catch_unwind},
};

use strut_model::{Access, Model, Simulation, Snapshot};

use super::{
    log::{Debugging, Failure, Log},
    resources::Origin,
    state::{Function, Kind, Phase, State, Version},
    types::{Component, Status},
};

/// What a component points to.
#[repr(C)]
pub struct Instance<M: Model> {
    mark: u64,
    /// Kind and phase.
    pub state: State,
    /// Stop time; infinite if none was given.
    pub stop: f64,
    /// The model.
    pub simulation: Simulation<M>,
    /// What it was made from.
    pub origin: Origin,
    /// The way to the host's logger.
    pub log: Log,
    /// What debug logging was on at first.
    pub debug_at_first: Debugging,
    /// The states that the host has saved and not freed. A host's pointer is looked up here and never
    /// followed, so that a wrong one does no harm.
    pub saved: Vec<Box<Saved<M>>>,
    /// What the host of a co-simulation can handle.
    pub handles: Handles,
    /// What the last call for strings handed out.
    pub strings: Vec<CString>,
}

/// What the host of a co-simulation can handle; in FMI 2.0 nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Handles {
    /// Events.
    pub events: bool,
    /// Steps that end early.
    pub early_return: bool,
}

/// What an FMU state points to.
pub struct Saved<M: Model> {
    /// Kind and phase.
    pub state: State,
    /// Stop time.
    pub stop: f64,
    /// The simulation.
    pub snapshot: Snapshot<M>,
}

impl<M: Model> Instance<M> {
    /// A fresh instance.
    pub fn new(
        version: &Version,
        (kind, handles): (Kind, Handles),
        origin: Origin,
        log: Log,
    ) -> Result<Self, Failure> {
        let state = State::new(kind, Phase::Instantiated);
        Ok(Self {
            mark: version.mark,
            state,
            stop: f64::INFINITY,
            simulation: Simulation::new(origin.set.as_ref(), origin.resources.as_deref())?,
            debug_at_first: log.debug,
            origin,
            log,
            saved: Vec::new(),
            handles,
            strings: Vec::new(),
        })
    }

    /// Hands the instance to the host.
    pub fn into_component(self) -> Component {
        Box::into_raw(Box::new(self)).cast()
    }

    /// The instance behind a component, if it is one of this version.
    ///
    /// # Safety
    /// The component is null or points to readable memory of an instance's size; nobody else uses the
    /// instance as long as `'a`.
    #[inline]
    unsafe fn from_component<'a>(component: Component, version: &Version) -> Option<&'a mut Self> {
        let pointer = component.cast::<Self>();
        if pointer.is_null() || !pointer.is_aligned() {
            return None;
        }
        // SAFETY: not null, aligned and, by the caller, readable.
        if unsafe { (&raw const (*pointer).mark).read() } != version.mark {
            return None;
        }
        // SAFETY: it is an instance and, by the caller, not in use.
        Some(unsafe { &mut *pointer })
    }

    /// Frees the instance of a component; nothing happens if it is none.
    ///
    /// # Safety
    /// As for [`from_component`](Self::from_component); the component must not be used afterwards.
    pub unsafe fn free(component: Component, version: &Version) {
        // SAFETY: by the caller.
        let Some(instance) = (unsafe { Self::from_component(component, version) }) else { return };
        instance.mark = 0;
        // Kept from being optimised away, to tell a second call.
        std::hint::black_box(&mut instance.mark);
        // SAFETY: the instance came from `into_component`, and the reference above is not used any more.
        let instance = unsafe { Box::from_raw(component.cast::<Self>()) };
        // A model that panics when it is dropped must not take the host with it.
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| drop(instance))) {
            std::mem::forget(panic);
        }
    }

    /// What the host may change in the present phase.
    #[inline]
    pub fn access(&self) -> Access {
        match self.state.phase() {
            Phase::Instantiated | Phase::Initialization => Access::All,
            Phase::Continuous => Access::Continuous,
            // FMI 3.0 only, where a host of model exchange always handles events.
            Phase::Event if self.handles.events && self.state.kind() == Kind::ModelExchange => Access::Event,
            _ => Access::Tunable,
        }
    }

    /// Goes to another phase.
    pub fn enter(&mut self, phase: Phase) {
        self.state = self.state.at(phase);
    }

    #[cold]
    fn report(&self, function: &Function, failure: &Failure) -> Status {
        self.log.tell(function.name, failure);
        failure.status
    }

    #[cold]
    fn refuse(&self, function: &Function) -> Status {
        let status = if self.state.phase() == Phase::Fatal { Status::Fatal } else { Status::Error };
        self.report(function, &Failure { status, message: function.refusal(self.state) })
    }

    #[cold]
    fn panicked(&mut self, function: &Function, panic: &(dyn Any + Send)) -> Status {
        self.enter(Phase::Fatal);
        self.report(function, &fatal(function.version, panic))
    }
}

/// What to tell of a panic.
pub fn fatal(version: &Version, panic: &(dyn Any + Send)) -> Failure {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let reason = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no reason given");
    Failure {
        status: Status::Fatal,
        message: format!(
            "the model failed beyond repair ({reason}): call {}FreeInstance, and report this",
            version.prefix
        ),
    }
}

/// Calls a function's body with the instance, if the function is legal in its state.
///
/// This is the whole of the fast path: null, mark, state, body; a panic costs nothing until it happens.
///
/// # Safety
/// As for [`Instance::from_component`].
#[inline]
pub unsafe fn call<M: Model>(
    component: Component,
    function: &Function,
    body: impl FnOnce(&mut Instance<M>) -> Result<(), Failure>,
) -> Status {
    // SAFETY: by the caller.
    let Some(instance) = (unsafe { Instance::<M>::from_component(component, function.version) }) else {
        return Status::Error;
    };
    let guarded = AssertUnwindSafe(|| {
        if !function.legal.contains(instance.state) {
            return instance.refuse(function);
        }
        match body(instance) {
            Ok(()) => Status::Ok,
            Err(failure) => instance.report(function, &failure),
        }
    });
    match catch_unwind(guarded) {
        Ok(status) => status,
        Err(panic) => {
            // SAFETY: by the caller; the reference that the panic unwound is gone.
            match unsafe { Instance::<M>::from_component(component, function.version) } {
                Some(instance) => instance.panicked(function, panic.as_ref()),
                None => Status::Fatal,
            }
        }
    }
}
