//! Settings: parameters that are not real numbers and are no part of the equations' scalar.

/// A value of any of the types that FMI 2.0 knows. An enumeration's value is its index from one.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Real number.
    Real(f64),
    /// Integer, or index of an enumeration item.
    Integer(i32),
    /// Boolean.
    Boolean(bool),
    /// Text.
    Text(String),
}

/// An enumeration type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Enumeration {
    /// Type name.
    pub name: &'static str,
    /// The doc comment.
    pub doc: &'static str,
    /// Name and doc comment of each item; item `i` has the value `i + 1`.
    pub items: &'static [(&'static str, &'static str)],
}

/// What kind of values a setting takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SettingKind {
    /// A whole number.
    Integer,
    /// True or false.
    Boolean,
    /// Any text.
    Text,
    /// One of several.
    Choice(Enumeration),
}

/// What is declared about a setting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SettingDeclaration {
    /// Structured name.
    pub name: &'static str,
    /// The doc comment, as one line.
    pub doc: &'static str,
    /// May be changed after initialisation.
    pub tunable: bool,
    /// Type.
    pub kind: SettingKind,
}

/// A type that a setting can have.
pub trait Setting: Sized {
    /// Its kind.
    const KIND: SettingKind;
    /// As a value.
    fn value(&self) -> Value;
    /// From a value; none if it is of another type or no item of the enumeration.
    fn from_value(value: Value) -> Option<Self>;
}

macro_rules! impl_setting {
    ($($ty:ty: $kind:ident, $variant:ident;)*) => {$(
        impl Setting for $ty {
            const KIND: SettingKind = SettingKind::$kind;
            fn value(&self) -> Value {
                Value::$variant(self.clone())
            }
            fn from_value(value: Value) -> Option<Self> {
                match value {
                    Value::$variant(value) => Some(value),
                    _ => None,
                }
            }
        }
    )*};
}
impl_setting! {
    bool: Boolean, Boolean;
    i32: Integer, Integer;
    String: Text, Text;
}

/// A struct of settings; made by `#[derive(Settings)]`.
pub trait Settings: Clone + PartialEq + std::fmt::Debug + Send + 'static {
    /// Number of settings, those of groups included.
    const COUNT: usize;
    /// Declared start values.
    fn starts() -> Self;
    /// Declares the settings in order.
    fn declare() -> Vec<SettingDeclaration>;
    /// Setting number `index`.
    fn get(&self, index: usize) -> Option<Value>;
    /// Changes setting number `index`; none if there is none or the value is not one of its type.
    fn set(&mut self, index: usize, value: Value) -> Option<()>;
}

/// No settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoSettings;

impl Settings for NoSettings {
    const COUNT: usize = 0;
    fn starts() -> Self {
        Self
    }
    fn declare() -> Vec<SettingDeclaration> {
        Vec::new()
    }
    fn get(&self, _: usize) -> Option<Value> {
        None
    }
    fn set(&mut self, _: usize, _: Value) -> Option<()> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Choice, Settings as DeriveSettings};

    /// The shape.
    #[derive(Choice, Clone, Copy, Debug, PartialEq)]
    enum Shape {
        /// Round
        Round,
        /// Square
        Square,
    }

    #[derive(DeriveSettings, Clone, Debug, PartialEq)]
    struct Sheet {
        /// Outline
        outline: Outline,
        /// File
        #[set(name = "profile.file", start = "a.csv", tunable)]
        file: String,
    }

    #[derive(DeriveSettings, Clone, Debug, PartialEq)]
    struct Outline {
        /// Shape
        #[set(start = Shape::Square)]
        shape: Shape,
    }

    #[test]
    fn settings_are_read_and_written_by_index() {
        let mut sheet = Sheet::starts();
        assert_eq!(sheet.get(0), Some(Value::Integer(2)));
        assert_eq!(sheet.set(0, Value::Integer(1)), Some(()));
        assert_eq!(sheet.outline.shape, Shape::Round);
        assert_eq!(sheet.set(0, Value::Integer(3)), None);
        assert_eq!(sheet.set(1, Value::Boolean(true)), None);
        assert_eq!(sheet.get(2), None);
        let declared = Sheet::declare();
        assert_eq!((declared[1].name, declared[1].tunable), ("profile.file", true));
        assert!(matches!(
            declared[0].kind,
            SettingKind::Choice(Enumeration { items: [_, ("Square", "Square")], .. })
        ));
    }
}
