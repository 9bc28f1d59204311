//! The derive macros of `strut-model`: a variable is declared once, as a field with its unit, start
//! value, bounds and doc comment.

mod choice;
mod settings;
mod variables;

use proc_macro::TokenStream;
use syn::{Attribute, DeriveInput, Expr, ExprLit, Lit, Meta, parse_macro_input};

/// Makes a generic struct a bundle of declared real variables.
///
/// A field of the struct's type parameter is a variable and carries `#[var(...)]` with `unit` (a
/// constant of `strut_model::unit` or any expression of type `Unit`) and, optional, `start` (0),
/// `min`, `max`, `nominal`, `fixed` (a parameter that is fixed at initialisation), `output` (a
/// state that is an output as well) and `port` (a parameter that is an additive constant at which the
/// diagnosis looks for a missing signal). An array of them is declared alike, with one start for all or an
/// array of starts; its variables are named `field[1]`, `field[2]` and so on. A field of another type is
/// a group: its variables are named `field.variable`, or `variable` if it carries `#[var(flatten)]`. With
/// `#[var(min(variable = 0.0))]` a variable of the group has another lower bound than elsewhere.
#[proc_macro_derive(Variables, attributes(var))]
pub fn derive_variables(input: TokenStream) -> TokenStream {
    expand(&parse_macro_input!(input as DeriveInput), variables::expand)
}

/// Makes a struct a set of declared settings: parameters that are not real numbers.
///
/// A field carries `#[set(start = ...)]` and, optional, `name = "dotted.name"` and `tunable`. One that
/// carries nothing is a group: a struct of settings of its own, whose names stand as they are.
#[proc_macro_derive(Settings, attributes(set))]
pub fn derive_settings(input: TokenStream) -> TokenStream {
    expand(&parse_macro_input!(input as DeriveInput), settings::expand)
}

/// Makes an enum of documented unit variants a setting: an FMI enumeration type.
#[proc_macro_derive(Choice)]
pub fn derive_choice(input: TokenStream) -> TokenStream {
    expand(&parse_macro_input!(input as DeriveInput), choice::expand)
}

fn expand(
    input: &DeriveInput,
    with: fn(&DeriveInput) -> syn::Result<proc_macro2::TokenStream>,
) -> TokenStream {
    with(input).unwrap_or_else(|error| error.to_compile_error()).into()
}

/// The doc comment as one line, without a final stop. A variable without one would stand in the model
/// description without an explanation, so that it is required.
fn doc(attributes: &[Attribute], of: &syn::Ident) -> syn::Result<String> {
    let mut lines = Vec::new();
    for attribute in attributes.iter().filter(|attribute| attribute.path().is_ident("doc")) {
        if let Meta::NameValue(pair) = &attribute.meta
            && let Expr::Lit(ExprLit { lit: Lit::Str(text), .. }) = &pair.value
        {
            lines.push(text.value().trim().to_owned());
        }
    }
    let text = lines.join(" ").trim().trim_end_matches('.').to_owned();
    if text.is_empty() {
        return Err(syn::Error::new(
            of.span(),
            format!("`{of}` needs a doc comment: it becomes the description in the FMU"),
        ));
    }
    Ok(text)
}

/// The named fields of a struct.
fn fields(input: &DeriveInput) -> syn::Result<&syn::FieldsNamed> {
    match &input.data {
        syn::Data::Struct(syn::DataStruct { fields: syn::Fields::Named(named), .. }) => Ok(named),
        _ => {
            Err(syn::Error::new_spanned(&input.ident, "variables are declared as a struct with named fields"))
        }
    }
}
