//! A host that treats FMUs as badly as it can: legal and illegal calls in any order, wrong arguments,
//! forged states; checked call by call against the state machines of the standard.
//!
//! [`standard`] is read from FMI 2.0.4 and FMI 3.0 and from nothing else: neither it nor the [`player`] that judges the
//! library's answers looks at how the library decides. `README.md` says how to run all this under memory
//! and thread checkers.

pub mod api;
pub mod call;
pub mod generate;
pub mod package;
pub mod player;
pub mod shrink;
pub mod standard;
