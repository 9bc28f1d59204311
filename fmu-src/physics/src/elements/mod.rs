//! Elements between masses: the textbook law with the effects that may sit on it.

mod strut;
mod tire;

pub use strut::Strut;
pub use tire::Tire;
