//! The border between C and Rust: pointers become references, errors become codes, and panics become errors.

use std::any::Any;
use std::ffi::{CStr, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::error::{Error, LOBE_ERROR_INTERNAL, LOBE_OK, lobe_error, lobe_status};

/// Runs the body of a function that can fail. Panics are caught here.
///
/// # Safety
/// `error` is null, or points to memory to which a `lobe_error` can be written and that nothing else uses during the
/// call.
pub unsafe fn guarded(error: *mut lobe_error, body: impl FnOnce() -> Result<(), Error>) -> lobe_status {
    let done = catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|panic| Err(panicked(&*panic)));
    match done {
        Ok(()) => LOBE_OK,
        Err(found) => {
            if !error.is_null() && error.is_aligned() {
                // SAFETY: not null, and by the promise of the caller it can be written to. The old value has no
                // destructor.
                unsafe { error.write(found.shown()) };
            }
            found.status()
        }
    }
}

/// Runs the body of a function that cannot fail, but might panic because of a bug: then it returns `fallback`.
pub fn infallible<T>(fallback: T, body: impl FnOnce() -> T) -> T {
    catch_unwind(AssertUnwindSafe(body)).unwrap_or(fallback)
}

fn panicked(panic: &(dyn Any + Send)) -> Error {
    let words = panic.downcast_ref::<&str>().copied();
    let words = words.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("a panic");
    Error::new(LOBE_ERROR_INTERNAL, format!("an error in lobe, please report it: {words}"))
}

/// The value that an argument points to.
///
/// # Errors
/// If it is null or misaligned.
///
/// # Safety
/// If it is not null, it points to a `T` that lives for `'a`, and that nothing writes to.
pub unsafe fn borrowed<'a, T>(pointer: *const T, name: &str) -> Result<&'a T, Error> {
    check(pointer, name)?;
    // SAFETY: neither null nor misaligned; the rest is the promise of the caller.
    Ok(unsafe { &*pointer })
}

/// Writes to the memory that an argument points to.
///
/// # Errors
/// If it is null or misaligned; then nothing is written.
///
/// # Safety
/// If it is not null, a `T` can be written there, and nothing else uses it.
pub unsafe fn write<T>(pointer: *mut T, value: T, name: &str) -> Result<(), Error> {
    check(pointer, name)?;
    // SAFETY: neither null nor misaligned; the rest is the promise of the caller.
    unsafe { pointer.write(value) };
    Ok(())
}

/// The numbers that an argument points to.
///
/// # Errors
/// If it is null or misaligned.
///
/// # Safety
/// If it is not null, it points to `count` values that live for `'a`, and that nothing writes to.
pub unsafe fn slice<'a, T>(pointer: *const T, count: usize, name: &str) -> Result<&'a [T], Error> {
    if count == 0 {
        return Ok(&[]);
    }
    check(pointer, name)?;
    fits::<T>(count, name)?;
    // SAFETY: neither null nor misaligned, and not larger than memory can be; the rest is the promise of the caller.
    Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
}

/// The same, to write to.
///
/// # Errors
/// The same as for [`slice`].
///
/// # Safety
/// If it is not null, it points to `count` values that live for `'a`, and that nothing else uses.
pub unsafe fn slice_mut<'a, T>(pointer: *mut T, count: usize, name: &str) -> Result<&'a mut [T], Error> {
    if count == 0 {
        return Ok(&mut []);
    }
    check(pointer, name)?;
    fits::<T>(count, name)?;
    // SAFETY: as above.
    Ok(unsafe { std::slice::from_raw_parts_mut(pointer, count) })
}

/// The text that an argument points to.
///
/// # Errors
/// If it is null, or not UTF-8.
///
/// # Safety
/// If it is not null, it points to text that ends with a zero, lives for `'a`, and is not written to.
pub unsafe fn text<'a>(pointer: *const c_char, name: &str) -> Result<&'a str, Error> {
    check(pointer, name)?;
    // SAFETY: not null; the rest is the promise of the caller.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map_err(|error| Error::invalid(format!("{name}: found bytes that are not UTF-8: {error}")))
}

/// Checks a pointer for output before the work is done.
///
/// # Errors
/// If it is null or misaligned.
pub fn check<T>(pointer: *const T, name: &str) -> Result<(), Error> {
    match (pointer.is_null(), pointer.is_aligned()) {
        (false, true) => Ok(()),
        (true, _) => Err(Error::invalid(format!("{name}: found NULL; expected a pointer"))),
        (_, false) => Err(Error::invalid(format!("{name}: found a misaligned pointer"))),
    }
}

fn fits<T>(count: usize, name: &str) -> Result<(), Error> {
    let bytes = count.checked_mul(size_of::<T>()).filter(|bytes| isize::try_from(*bytes).is_ok());
    bytes
        .map(|_| ())
        .ok_or_else(|| Error::invalid(format!("{name}: found {count} values; expected as many as fit into memory")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::LOBE_ERROR_INVALID;

    #[test]
    fn panics_become_errors() {
        let mut error = Error::invalid("").shown();
        // SAFETY: a local variable.
        let status = unsafe { guarded(&mut error, || panic!("at the disco")) };
        assert_eq!((status, error.status), (LOBE_ERROR_INTERNAL, LOBE_ERROR_INTERNAL));
        let message: String = error.message.iter().map(|&c| c as u8 as char).take_while(|&c| c != '\0').collect();
        assert!(message.ends_with("at the disco"), "{message}");
        assert_eq!(infallible(3, || panic!("again")), 3);
    }

    #[test]
    fn null_and_misaligned_pointers_are_errors() {
        // SAFETY: none of them is used.
        unsafe {
            assert_eq!(borrowed::<u32>(std::ptr::null(), "a").unwrap_err().status(), LOBE_ERROR_INVALID);
            let odd = std::ptr::dangling::<u32>().wrapping_byte_add(1);
            assert!(slice(odd, 1, "a").is_err() && slice(odd, 0, "a").is_ok());
            assert!(slice::<f32>(std::ptr::dangling(), usize::MAX, "a").is_err());
            assert!(guarded(std::ptr::null_mut(), || Err(Error::invalid("a"))) == LOBE_ERROR_INVALID);
        }
    }
}
