//! Parameters: one declaration yields the control, the link, the JavaScript interface and the tables of the
//! docs.
//!
//! A widget declares each one as a [`Param`] or a [`OneOf`], which carry the type of its value: a model reads
//! `values.get(&VARIANT)` and gets an `IcpVariant`. Code that handles all parameters alike, such as the
//! controls, uses [`ParamSpec`] and numbers: the index of an option, 0 or 1 for a switch. Links contain the
//! names of options and switches.

mod error;
mod spec;
mod typed;

pub use error::{ParamError, printable};
pub use spec::{Choice, ParamKind, ParamSpec};
pub use typed::{Named, Number, OneOf, Param, Typed, optional, options};

/// Declares a choice: the type of its values, its name in links and on screen, and a table of [`Named`] values.
#[macro_export]
macro_rules! one_of {
    ($type:ty, $id:expr, $label:expr, $values:expr $(,)?) => {{
        const VALUES: &[$crate::param::Named<$type>] = $values;
        const OPTIONS: [$crate::param::Choice; VALUES.len()] = $crate::param::options(VALUES);
        $crate::param::OneOf::new($id, $label, &OPTIONS, VALUES)
    }};
}

/// Declares the parameters of a widget, each once: a static for each, and their list `PARAMS` in the order of their
/// controls. `use` lists one that is declared elsewhere, `use MOVED[0 1][0 1 2]` those of a table row by row.
///
/// ```text
/// params! {
///     pub(super) static BIAS: Param<f64> = Param::slider("bias", "missing turn", [0.0, 10.0], 0.5);
///     use SPEED;
///     use MORE;
/// }
/// ```
#[macro_export]
macro_rules! params {
    (@list [$($list:expr),*]) => {
        /// The widget's parameters, in the order of their controls.
        pub const PARAMS: &[&$crate::param::ParamSpec] = &[$($list),*];
    };
    (@list [$($list:expr),*] use $table:ident[] $columns:tt; $($rest:tt)*) => {
        $crate::params!(@list [$($list),*] $($rest)*);
    };
    (@list [$($list:expr),*] use $table:ident[$row:literal $($rows:literal)*] [$($column:literal)*]; $($rest:tt)*) => {
        $crate::params!(
            @list [$($list,)* $(&$table[$row][$column].spec),*]
            use $table[$($rows)*] [$($column)*];
            $($rest)*
        );
    };
    (@list [$($list:expr),*] use $shared:expr; $($rest:tt)*) => {
        $crate::params!(@list [$($list,)* &$shared.spec] $($rest)*);
    };
    (@list [$($list:expr),*] $vis:vis static $name:ident: $type:ty = $value:expr; $($rest:tt)*) => {
        $vis static $name: $type = $value;
        $crate::params!(@list [$($list,)* &$name.spec] $($rest)*);
    };
    ($($all:tt)*) => {
        $crate::params!(@list [] $($all)*);
    };
}

/// Whether everything is shown. A widget with layers lists it as its last parameter.
pub static MORE: Param<bool> =
    Param::switch("more", "more").help("Shows all settings, presets, numbers, tables and plots.");

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) const SPECS: &[&ParamSpec] = &[
        &ParamSpec {
            id: "heading",
            label: "heading error",
            unit: "°",
            kind: ParamKind::Slider {
                min: -180.0,
                max: 180.0,
                step: 1.0,
            },
            default: 25.0,
            help: "",
        },
        &ParamSpec {
            id: "variant",
            label: "variant",
            unit: "",
            kind: ParamKind::Choice {
                options: &[
                    Choice {
                        id: "point-to-point",
                        label: "point-to-point",
                    },
                    Choice {
                        id: "point-to-plane",
                        label: "point-to-plane",
                    },
                ],
            },
            default: 0.0,
            help: "",
        },
    ];

    #[test]
    fn the_text_in_a_link_parses_to_the_same_bits() {
        for value in [0.1 + 0.2, -179.999_999_9, 25.0] {
            let text = SPECS[0].to_text(value);
            assert_eq!(SPECS[0].parse(&text).unwrap().to_bits(), value.to_bits());
        }
        assert_eq!(SPECS[1].parse("point-to-plane"), Ok(1.0));
        assert_eq!(SPECS[1].to_text(1.0), "point-to-plane");
    }

    #[test]
    fn an_unknown_option_is_an_error_that_lists_the_valid_ones() {
        let error = SPECS[1].parse("plane").unwrap_err();
        assert_eq!(
            error.to_string(),
            "`variant` takes point-to-point or point-to-plane, not `plane`"
        );
    }

    #[test]
    fn a_quoted_text_is_short_and_without_control_characters() {
        assert_eq!(printable("point-to-plane"), "point-to-plane");
        assert_eq!(printable("a\u{1b}[2Jb"), "a\\u{1b}[2Jb");
        assert_eq!(printable(&"é".repeat(61)), format!("{}…", "é".repeat(60)));
        let escaped = printable(&"\u{1b}".repeat(61));
        assert_eq!(escaped, format!("{}…", "\\u{1b}".repeat(10)));
    }
}
