//! Why data cannot be used.

use thiserror::Error;

/// Why a file or a map cannot be used, and what to do about it.
#[derive(Debug, Error)]
pub enum DataError {
    /// The file cannot be read at all.
    #[error("{file}: cannot be read: {source}; check the path and who may read it")]
    Io {
        /// Its path.
        file: String,
        /// The system's word.
        source: std::io::Error,
    },
    /// Something at one place of a text file.
    #[error("{file}, line {line}, column {column}: {text}")]
    Cell {
        /// The file's name.
        file: String,
        /// Line, counted from 1.
        line: u64,
        /// Column of the table, counted from 1.
        column: usize,
        /// What is wrong and what to do.
        text: String,
    },
    /// Something about the whole file.
    #[error("{file}: {text}")]
    File {
        /// The file's name.
        file: String,
        /// What is wrong and what to do.
        text: String,
    },
    /// Something about one signal.
    #[error("{file}, {signal}: {text}")]
    Signal {
        /// The file's name.
        file: String,
        /// The column's or the model's name of the signal.
        signal: String,
        /// What is wrong and what to do.
        text: String,
    },
    /// The map cannot be understood.
    #[error("map: {0}")]
    Map(String),
}

impl DataError {
    /// An error of the whole file.
    pub(crate) fn file(file: &str, text: impl Into<String>) -> Self {
        Self::File { file: file.to_owned(), text: text.into() }
    }

    /// An error of one signal.
    pub(crate) fn signal(file: &str, signal: &str, text: impl Into<String>) -> Self {
        Self::Signal { file: file.to_owned(), signal: signal.to_owned(), text: text.into() }
    }
}
