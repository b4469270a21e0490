//! Arguments that take a name from a short list.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

/// Parses the short names of a list of choices, names and labels, and shows its labels in the help.
///
/// # Panics
/// If the parser lets another name pass: a bug of clap.
pub fn choice<C: Copy + Send + Sync + 'static>(
    named: &'static [(C, &'static str, &'static str)],
) -> impl TypedValueParser<Value = C> {
    let values = named
        .iter()
        .map(|(_, name, label)| PossibleValue::new(*name).help(*label));
    PossibleValuesParser::new(values).map(|given| {
        let row = named.iter().find(|(_, name, _)| *name == given);
        row.expect("the parser lets only names of the list pass").0
    })
}
