//! The terminal's colours, those of cargo; streams that are no terminal are written without.

use anstyle::{AnsiColor, Color, Style};

const fn bold(color: AnsiColor) -> Style {
    Style::new().bold().fg_color(Some(Color::Ansi(color)))
}

/// What is wrong.
pub const ERROR: Style = bold(AnsiColor::Red);
/// What may go wrong.
#[cfg(feature = "tools")]
pub const WARNING: Style = bold(AnsiColor::Yellow);
/// What to do.
pub const HELP: Style = bold(AnsiColor::Cyan);
/// Headings.
pub const HEADING: Style = bold(AnsiColor::Green);
/// Names.
pub const NAME: Style = Style::new().bold();
/// What stands beside.
pub const ASIDE: Style = Style::new().dimmed();
