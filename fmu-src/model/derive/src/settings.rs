//! `#[derive(Settings)]`.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{DeriveInput, Expr, LitStr};

pub fn expand(input: &DeriveInput) -> syn::Result<TokenStream> {
    let name = &input.ident;
    let (mut starts, mut declare, mut get, mut set) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut count = Vec::new();
    for field in &crate::fields(input)?.named {
        let ident = field.ident.as_ref().expect("a named field has a name");
        let ty = &field.ty;
        // How many came before: those of a group are known to its type only.
        let first = quote!(0 #(+ #count)*);
        if !field.attrs.iter().any(|attribute| attribute.path().is_ident("set")) {
            let settings = quote!(<#ty as ::strut_model::Settings>);
            starts.push(quote!(#ident: #settings::starts()));
            declare.push(quote!(list.extend(#settings::declare());));
            get.push(quote!(if index < #first + #settings::COUNT {
                return ::strut_model::Settings::get(&self.#ident, index - (#first));
            }));
            set.push(quote!(if index < #first + #settings::COUNT {
                return ::strut_model::Settings::set(&mut self.#ident, index - (#first), value);
            }));
            count.push(quote!(#settings::COUNT));
            continue;
        }
        let doc = crate::doc(&field.attrs, ident)?;
        let mut text = ident.to_string();
        let mut start: Option<Expr> = None;
        let mut tunable = false;
        for attribute in field.attrs.iter().filter(|attribute| attribute.path().is_ident("set")) {
            attribute.parse_nested_meta(|meta| {
                match meta.path.require_ident()?.to_string().as_str() {
                    "start" => start = Some(meta.value()?.parse()?),
                    "name" => text = meta.value()?.parse::<LitStr>()?.value(),
                    "tunable" => tunable = true,
                    other => {
                        return Err(
                            meta.error(format!("unknown `{other}`; a setting has start, name, tunable"))
                        );
                    }
                }
                Ok(())
            })?;
        }
        let start = start.ok_or_else(|| {
            syn::Error::new(ident.span(), format!("`{ident}` needs its start: write `#[set(start = ...)]`"))
        })?;
        starts.push(quote!(#ident: #start.into()));
        declare.push(quote!(list.push(::strut_model::SettingDeclaration {
            name: #text, doc: #doc, tunable: #tunable, kind: <#ty as ::strut_model::Setting>::KIND,
        });));
        get.push(quote!(if index == #first {
            return Some(::strut_model::Setting::value(&self.#ident));
        }));
        set.push(quote!(if index == #first {
            self.#ident = ::strut_model::Setting::from_value(value)?;
            return Some(());
        }));
        count.push(quote!(1));
    }
    Ok(quote! {
        impl ::strut_model::Settings for #name {
            const COUNT: usize = 0 #(+ #count)*;
            fn starts() -> Self {
                Self { #(#starts),* }
            }
            fn declare() -> Vec<::strut_model::SettingDeclaration> {
                let mut list = Vec::with_capacity(Self::COUNT);
                #(#declare)*
                list
            }
            fn get(&self, index: usize) -> Option<::strut_model::Value> {
                #(#get)*
                None
            }
            fn set(&mut self, index: usize, value: ::strut_model::Value) -> Option<()> {
                #(#set)*
                None
            }
        }
    })
}
