//! The system that is made of what was found.
