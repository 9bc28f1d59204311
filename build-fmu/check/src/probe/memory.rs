//! The memory that an importer gives: `allocateMemory` and `freeMemory`, with an account of it.

#![allow(unsafe_code)]

use std::collections::HashMap;
use std::ffi::c_void;
use std::sync::Mutex;

/// What became of the memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Memory {
    /// How many blocks were given.
    pub allocated: usize,
    /// How many of them are not freed.
    pub left: usize,
    /// Their size in bytes.
    pub bytes: usize,
    /// How often something was to be freed that was not given, or was freed already.
    pub foreign: usize,
}

/// The blocks that are given, with their sizes; how many there were, and how many foreign ones came back.
struct Account {
    blocks: Option<HashMap<usize, usize>>,
    allocated: usize,
    foreign: usize,
}

static ACCOUNT: Mutex<Account> = Mutex::new(Account { blocks: None, allocated: 0, foreign: 0 });

/// `allocateMemory`: that many objects of that size, set to zero.
pub unsafe extern "C" fn allocate(number: usize, size: usize) -> *mut c_void {
    // SAFETY: any two numbers are fine; null is an answer.
    let block = unsafe { libc::calloc(number, size) };
    if let Ok(mut account) = ACCOUNT.lock()
        && !block.is_null()
    {
        account.allocated += 1;
        account.blocks.get_or_insert_default().insert(block.addr(), number.saturating_mul(size));
    }
    block
}

/// `freeMemory`: what was not given is left alone and counted, since freeing it would end the process.
pub unsafe extern "C" fn free(block: *mut c_void) {
    let Ok(mut account) = ACCOUNT.lock() else { return };
    if block.is_null() {
        return;
    }
    match account.blocks.get_or_insert_default().remove(&block.addr()) {
        // SAFETY: it was given by `calloc`, and is not freed until now.
        Some(_) => unsafe { libc::free(block) },
        None => account.foreign += 1,
    }
}

/// The account until now.
pub fn memory() -> Memory {
    let Ok(account) = ACCOUNT.lock() else { return Memory::default() };
    let sizes = account.blocks.iter().flat_map(HashMap::values);
    Memory {
        allocated: account.allocated,
        left: sizes.clone().count(),
        bytes: sizes.sum(),
        foreign: account.foreign,
    }
}
