//! `#[derive(Choice)]`.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Data, DeriveInput, Fields};

pub fn expand(input: &DeriveInput) -> syn::Result<TokenStream> {
    let name = &input.ident;
    let Data::Enum(data) = &input.data else {
        return Err(syn::Error::new_spanned(name, "a choice is an enum"));
    };
    let doc = crate::doc(&input.attrs, name)?;
    let (mut items, mut to_index, mut from_index) = (Vec::new(), Vec::new(), Vec::new());
    for (index, variant) in (1_i32..).zip(&data.variants) {
        if !matches!(variant.fields, Fields::Unit) {
            return Err(syn::Error::new_spanned(variant, "a choice has no fields"));
        }
        let ident = &variant.ident;
        let text = ident.to_string();
        let doc = crate::doc(&variant.attrs, ident)?;
        items.push(quote!((#text, #doc)));
        to_index.push(quote!(Self::#ident => #index));
        from_index.push(quote!(::strut_model::Value::Integer(#index) => Some(Self::#ident)));
    }
    let text = name.to_string();
    Ok(quote! {
        impl ::strut_model::Setting for #name {
            const KIND: ::strut_model::SettingKind = ::strut_model::SettingKind::Choice(
                ::strut_model::Enumeration { name: #text, doc: #doc, items: &[#(#items),*] });
            fn value(&self) -> ::strut_model::Value {
                ::strut_model::Value::Integer(match self { #(#to_index),* })
            }
            fn from_value(value: ::strut_model::Value) -> Option<Self> {
                match value { #(#from_index,)* _ => None }
            }
        }
    })
}
