//! Saving and restoring states.

use std::{ffi::c_void, ptr};

use strut_model::{Model, Snapshot};

use super::{
    blob::{self, Content},
    instance::{Instance, Saved, call},
    log::Failure,
    pointer::{one, slice, slice_mut},
    state::{Function, Version},
    types::{Component, FmuState, Size, Status},
};

impl<M: Model> Instance<M> {
    /// Where the state that a host points to is kept.
    fn index(&self, state: FmuState, version: &Version) -> Result<usize, Failure> {
        let wanted = state.cast_const().cast::<Saved<M>>();
        self.saved.iter().position(|saved| ptr::eq(&raw const **saved, wanted)).ok_or_else(|| {
            let Version { get_state, de_serialize, .. } = version;
            Failure::error(format!(
                "FMUstate is none that {get_state} or {de_serialize} of this instance gave, or it was freed; to bring \
                 a state to another instance, serialize it"
            ))
        })
    }

    /// The state that a host points to.
    fn saved(&self, state: FmuState, version: &Version) -> Result<&Saved<M>, Failure> {
        Ok(&self.saved[self.index(state, version)?])
    }

    /// Keeps a state where the host's pointer says, or in a new place if it is null.
    fn keep(&mut self, state: &mut FmuState, saved: Saved<M>, version: &Version) -> Result<(), Failure> {
        if state.is_null() {
            let place = Box::new(saved);
            *state = (&raw const *place).cast_mut().cast::<c_void>();
            self.saved.push(place);
        } else {
            let index = self.index(*state, version)?;
            *self.saved[index] = saved;
        }
        Ok(())
    }

    /// A saved state as bytes.
    fn bytes(&self, state: FmuState, version: &Version) -> Result<Vec<u8>, Failure> {
        let Saved { state, stop, snapshot } = self.saved(state, version)?;
        let content = Content { state: *state, stop: *stop, snapshot: &snapshot.to_bytes() };
        Ok(blob::write(&self.origin.guid, content))
    }
}

/// Saves the state, in the place of an earlier one if a pointer to that is given.
///
/// # Safety
/// The component is null or an instance of this model that nobody else uses; the pointer to the state is
/// null or may be read and written.
pub unsafe fn get_fmu_state<M: Model>(
    function: &Function,
    component: Component,
    state: *mut FmuState,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        let state = unsafe { one(state, "FMUstate") }?;
        let saved =
            Saved { state: instance.state, stop: instance.stop, snapshot: instance.simulation.save() };
        instance.keep(state, saved, function.version)
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}

/// Goes back to a saved state, its place in the state machine included.
///
/// # Safety
/// The component is as for [`get_fmu_state`]; the state is looked up and may be any pointer.
pub unsafe fn set_fmu_state<M: Model>(function: &Function, component: Component, state: FmuState) -> Status {
    let body = |instance: &mut Instance<M>| {
        let Saved { state, stop, snapshot } = &*instance.saved[instance.index(state, function.version)?];
        instance.simulation.restore(snapshot)?;
        (instance.state, instance.stop) = (*state, *stop);
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}

/// Frees a saved state and sets the pointer to it to null.
///
/// # Safety
/// As for [`get_fmu_state`].
pub unsafe fn free_fmu_state<M: Model>(
    function: &Function,
    component: Component,
    state: *mut FmuState,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        let state = unsafe { one(state, "FMUstate") }?;
        if !state.is_null() {
            let index = instance.index(*state, function.version)?;
            instance.saved.swap_remove(index);
            *state = ptr::null_mut();
        }
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}

/// Tells how many bytes a saved state has.
///
/// # Safety
/// As for [`set_fmu_state`]; the size is null or may be written.
pub unsafe fn serialized_fmu_state_size<M: Model>(
    function: &Function,
    component: Component,
    state: FmuState,
    size: *mut Size,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        *unsafe { one(size, "size") }? = instance.bytes(state, function.version)?.len();
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}

/// Writes a saved state as bytes.
///
/// # Safety
/// As for [`set_fmu_state`]; the bytes are null or `size` of them may be written.
pub unsafe fn serialize_fmu_state<M: Model>(
    function: &Function,
    component: Component,
    state: FmuState,
    bytes: *mut u8,
    size: Size,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        let written = instance.bytes(state, function.version)?;
        if written.len() != size {
            return Err(Failure::error(format!(
                "size = {size}, but the state has {} bytes: ask {}",
                written.len(),
                function.version.state_size
            )));
        }
        // SAFETY: by the caller.
        unsafe { slice_mut(bytes, size, "serializedState") }?.copy_from_slice(&written);
        Ok(())
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}

/// Makes a saved state of bytes. Those that another FMU wrote, or that were damaged, are refused.
///
/// # Safety
/// As for [`get_fmu_state`]; the bytes are null or there are `size` of them.
pub unsafe fn de_serialize_fmu_state<M: Model>(
    function: &Function,
    component: Component,
    bytes: *const u8,
    size: Size,
    state: *mut FmuState,
) -> Status {
    let body = |instance: &mut Instance<M>| {
        // SAFETY: by the caller.
        let (bytes, place) = unsafe { (slice(bytes, size, "serializedState")?, one(state, "FMUstate")?) };
        let refused = |reason| Failure::error(format!("the bytes cannot be a saved state: {reason}"));
        let Content { state, stop, snapshot } =
            blob::read(&instance.origin.guid, function.legal, bytes).map_err(refused)?;
        if state.kind() != instance.state.kind() {
            return Err(refused(
                "they were saved in the other of model exchange and co-simulation: restore them there",
            ));
        }
        let saved = Saved { state, stop, snapshot: Snapshot::from_bytes(snapshot)? };
        instance.keep(place, saved, function.version)
    };
    // SAFETY: by the caller.
    unsafe { call(component, function, body) }
}
