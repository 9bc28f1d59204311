//! The packager.
