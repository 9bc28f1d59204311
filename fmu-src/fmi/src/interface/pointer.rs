//! What a host points to.

use std::ffi::CStr;

use super::{
    log::Failure,
    types::{Size, Text},
};

/// The values that an argument points to.
///
/// # Safety
/// The pointer is null or points to `len` values that live, unchanged, as long as `'a`.
#[inline]
pub unsafe fn slice<'a, T>(pointer: *const T, len: Size, name: &str) -> Result<&'a [T], Failure> {
    if len == 0 {
        return Ok(&[]);
    }
    check(pointer, len, name)?;
    // SAFETY: not null and aligned; the caller answers for the rest.
    Ok(unsafe { std::slice::from_raw_parts(pointer, len) })
}

/// The values that an argument points to, to be written.
///
/// # Safety
/// The pointer is null or points to `len` plain numbers or pointers that live as long as `'a` and are
/// reached by nobody else in that time.
#[inline]
pub unsafe fn slice_mut<'a, T>(pointer: *mut T, len: Size, name: &str) -> Result<&'a mut [T], Failure> {
    if len == 0 {
        return Ok(&mut []);
    }
    check(pointer, len, name)?;
    // SAFETY: not null and aligned; the caller answers for the rest.
    Ok(unsafe { std::slice::from_raw_parts_mut(pointer, len) })
}

/// The single value that an argument points to, to be written.
///
/// # Safety
/// As for [`slice_mut`] with one value.
#[inline]
pub unsafe fn one<'a, T>(pointer: *mut T, name: &str) -> Result<&'a mut T, Failure> {
    check(pointer, 1, name)?;
    // SAFETY: not null and aligned; the caller answers for the rest.
    Ok(unsafe { &mut *pointer })
}

/// The text that an argument points to.
///
/// # Safety
/// The pointer is null or points to bytes that end with a zero and live, unchanged, as long as `'a`.
pub unsafe fn text<'a>(pointer: Text, name: &str) -> Result<&'a CStr, Failure> {
    if pointer.is_null() {
        return Err(Failure::error(format!("{name} is a null pointer: give a string")));
    }
    // SAFETY: not null; the caller answers for the rest.
    Ok(unsafe { CStr::from_ptr(pointer) })
}

/// The text that an argument points to; none if it is null or empty.
///
/// # Safety
/// As for [`text`].
pub unsafe fn optional<'a>(pointer: Text, name: &str) -> Result<Option<&'a str>, Failure> {
    if pointer.is_null() {
        return Ok(None);
    }
    // SAFETY: by the caller.
    let given = utf8(unsafe { text(pointer, name) }?, name)?;
    Ok((!given.is_empty()).then_some(given))
}

/// A text as UTF-8.
pub fn utf8<'a>(text: &'a CStr, name: &str) -> Result<&'a str, Failure> {
    text.to_str().map_err(|_| {
        Failure::error(format!("{name}, {:?}, is not UTF-8: encode it so", text.to_string_lossy()))
    })
}

#[inline]
fn check<T>(pointer: *const T, len: Size, name: &str) -> Result<(), Failure> {
    if !pointer.is_null() && pointer.is_aligned() && len <= isize::MAX as usize / size_of::<T>() {
        return Ok(());
    }
    Err(refused(pointer.is_null(), len, name))
}

#[cold]
fn refused(null: bool, len: Size, name: &str) -> Failure {
    Failure::error(if null {
        format!(
            "{name} is a null pointer: give the address of {len} value{}",
            if len == 1 { "" } else { "s" }
        )
    } else {
        format!("{name} with {len} values cannot be an array: check address and length")
    })
}
