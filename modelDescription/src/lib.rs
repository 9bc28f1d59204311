//! Model descriptions.
