//! `#[derive(Variables)]`.

use proc_macro2::{TokenStream, TokenTree};
use quote::{ToTokens, quote};
use syn::ext::IdentExt;
use syn::{Attribute, DeriveInput, Expr, Field, GenericParam, Ident, Type};

/// What `#[var(...)]` says.
struct Var {
    unit: Expr,
    start: Expr,
    min: Option<Expr>,
    max: Option<Expr>,
    nominal: Option<Expr>,
    fixed: bool,
    output: bool,
    port: bool,
}

pub fn expand(input: &DeriveInput) -> syn::Result<TokenStream> {
    let name = &input.ident;
    let scalar = match input.generics.params.first() {
        Some(GenericParam::Type(parameter)) if input.generics.params.len() == 1 => &parameter.ident,
        _ => {
            return Err(syn::Error::new_spanned(
                name,
                "variables are generic over their scalar: write `struct Name<R>`",
            ));
        }
    };
    let (mut count, mut gather, mut scatter, mut combine, mut declare) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for field in &crate::fields(input)?.named {
        let ident = field.ident.as_ref().expect("a named field has a name");
        // A field may be `r#yield`; its variable is not.
        let text = ident.unraw().to_string();
        let doc = crate::doc(&field.attrs, ident)?;
        if is_scalar(&field.ty, scalar) {
            let Var { unit, start, min, max, nominal, fixed, output, port } = parse(field, ident)?;
            let (min, max, nominal) = (option(min), option(max), option(nominal));
            count.push(quote!(1));
            gather.push(quote!(#ident: next()));
            scatter.push(quote!(put(self.#ident);));
            combine.push(quote!(#ident: f(&self.#ident, ::strut_model::each(others, |it| &it.#ident))));
            declare.push(quote!(declarations.variable(::strut_model::Declaration {
                name: #text.into(), doc: #doc.into(), unit: #unit, start: #start,
                min: #min, max: #max, nominal: #nominal, fixed: #fixed, output: #output, port: #port,
                element: None,
            });));
        } else if let Some(length) = array_length(&field.ty, scalar) {
            let Var { unit, start, min, max, nominal, fixed, output, port } = parse(field, ident)?;
            let (min, max, nominal) = (option(min), option(max), option(nominal));
            // One start for all, or one for each.
            let start = match start {
                Expr::Array(starts) => quote!({ let starts: [f64; #length] = #starts; starts[index] }),
                same => same.to_token_stream(),
            };
            count.push(quote!(#length));
            gather.push(quote!(#ident: ::strut_model::elements(next)));
            scatter.push(quote!(self.#ident.into_iter().for_each(&mut *put);));
            combine.push(quote!(#ident: {
                let mut index = 0;
                ::strut_model::elements(&mut || {
                    index += 1;
                    f(&self.#ident[index - 1], ::strut_model::each(others, |it| &it.#ident[index - 1]))
                })
            }));
            declare.push(quote!(for index in 0..#length {
                declarations.variable(::strut_model::Declaration {
                    name: format!("{}[{}]", #text, index + 1), doc: format!("{}, {}", #doc, index + 1),
                    unit: #unit, start: #start, min: #min, max: #max, nominal: #nominal, fixed: #fixed,
                    output: #output, port: #port, element: Some((index, #length)),
                });
            }));
        } else {
            let ty = &field.ty;
            let concrete = with_f64(ty.to_token_stream(), scalar);
            count.push(quote!(<#concrete>::COUNT));
            gather.push(quote!(#ident: <#ty as ::strut_model::Bundle<#scalar>>::gather(next)));
            scatter.push(quote!(::strut_model::Bundle::<#scalar>::scatter(&self.#ident, put);));
            combine.push(quote!(#ident: ::strut_model::Bundle::<#scalar>::combine(
                &self.#ident, ::strut_model::each(others, |it| &it.#ident), f,
            )));
            declare.push(match group(field)? {
                Group::Flattened => quote!(<#concrete as ::strut_model::Bundle<f64>>::declare(declarations);),
                Group::Bounded(least) if least.is_empty() => {
                    quote!(declarations.group::<#concrete>(#text, #doc);)
                }
                Group::Bounded(least) => {
                    let least = least.iter().map(|(name, min)| quote!((#name, #min)));
                    quote!(declarations.bounded_group::<#concrete>(#text, #doc, &[#(#least),*]);)
                }
            });
        }
    }
    Ok(quote! {
        impl #name<f64> {
            /// Number of variables, those of groups included.
            pub const COUNT: usize = 0 #(+ #count)*;
        }
        impl<#scalar: ::strut_model::Real> ::strut_model::Bundle<#scalar> for #name<#scalar> {
            const LEN: usize = #name::<f64>::COUNT;
            type Array = [f64; #name::<f64>::COUNT];
            #[inline]
            fn gather(next: &mut impl FnMut() -> #scalar) -> Self {
                Self { #(#gather),* }
            }
            #[inline]
            fn scatter(&self, put: &mut impl FnMut(#scalar)) {
                #(#scatter)*
            }
            #[inline(always)]
            fn combine<const N: usize>(
                &self, others: [&Self; N], f: &mut impl FnMut(&#scalar, [&#scalar; N]) -> #scalar,
            ) -> Self {
                Self { #(#combine),* }
            }
            fn declare(declarations: &mut ::strut_model::Declarations) {
                #(#declare)*
            }
        }
    })
}

fn parse(field: &Field, ident: &Ident) -> syn::Result<Var> {
    let Some(attribute) = attribute(field) else {
        return Err(syn::Error::new(
            ident.span(),
            format!("`{ident}` needs its unit: write `#[var(unit = M)]` (a constant of strut_model::unit)"),
        ));
    };
    let mut unit = None;
    let mut var = Var {
        unit: syn::parse_quote!(::strut_model::unit::ONE),
        start: syn::parse_quote!(0.0),
        min: None,
        max: None,
        nominal: None,
        fixed: false,
        output: false,
        port: false,
    };
    attribute.parse_nested_meta(|meta| {
        let key = meta.path.require_ident()?.to_string();
        match key.as_str() {
            "unit" => unit = Some(meta.value()?.parse()?),
            "start" => var.start = meta.value()?.parse()?,
            "min" => var.min = Some(meta.value()?.parse()?),
            "max" => var.max = Some(meta.value()?.parse()?),
            "nominal" => var.nominal = Some(meta.value()?.parse()?),
            "fixed" => var.fixed = true,
            "output" => var.output = true,
            "port" => var.port = true,
            other => {
                return Err(meta.error(format!(
                    "unknown `{other}`; a variable has unit, start, min, max, nominal, fixed, output, port"
                )));
            }
        }
        Ok(())
    })?;
    var.unit = match unit {
        // A bare name is one of the units that strut_model declares.
        Some(Expr::Path(path)) if path.path.get_ident().is_some() => {
            syn::parse_quote!(::strut_model::unit::#path)
        }
        Some(other) => other,
        None => return Err(syn::Error::new_spanned(attribute, format!("`{ident}` needs its `unit`"))),
    };
    Ok(var)
}

/// How the variables of a group are declared.
enum Group {
    /// Named as if they were the struct's own.
    Flattened,
    /// Named below the group's name; some have a lower bound of their own here.
    Bounded(Vec<(String, Expr)>),
}

fn group(field: &Field) -> syn::Result<Group> {
    let mut group = Group::Bounded(Vec::new());
    if let Some(attribute) = attribute(field) {
        attribute.parse_nested_meta(|meta| {
            if meta.path.is_ident("flatten") {
                group = Group::Flattened;
                return Ok(());
            }
            if !meta.path.is_ident("min") {
                return Err(meta.error("a group has nothing but `flatten` or `min(variable = bound)`"));
            }
            meta.parse_nested_meta(|bound| {
                let name = bound.path.require_ident()?.to_string();
                let value = bound.value()?.parse()?;
                if let Group::Bounded(least) = &mut group {
                    least.push((name, value));
                }
                Ok(())
            })
        })?;
    }
    Ok(group)
}

fn attribute(field: &Field) -> Option<&Attribute> {
    field.attrs.iter().find(|attribute| attribute.path().is_ident("var"))
}

fn option(value: Option<Expr>) -> TokenStream {
    match value {
        Some(value) => quote!(Some(#value)),
        None => quote!(None),
    }
}

fn is_scalar(ty: &Type, scalar: &Ident) -> bool {
    matches!(ty, Type::Path(path) if path.qself.is_none() && path.path.is_ident(scalar))
}

/// The length of an array of scalars.
fn array_length<'a>(ty: &'a Type, scalar: &Ident) -> Option<&'a Expr> {
    match ty {
        Type::Array(array) if is_scalar(&array.elem, scalar) => Some(&array.len),
        _ => None,
    }
}

/// The type with `f64` in place of the scalar: array lengths may not name a type parameter.
fn with_f64(tokens: TokenStream, scalar: &Ident) -> TokenStream {
    tokens
        .into_iter()
        .map(|token| match token {
            TokenTree::Ident(ident) if ident == *scalar => TokenTree::Ident(Ident::new("f64", ident.span())),
            other => other,
        })
        .collect()
}
