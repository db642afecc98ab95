//! Attributes by which the Python module says what its stubs say: docstrings, signatures, fields of answers.
//!
//! Each stands in `_native.pyi` and nowhere else. What the stubs do not name does not compile.

mod stub;

use proc_macro::TokenStream;
use proc_macro2::TokenStream as Tokens;
use quote::{ToTokens, format_ident, quote};
use syn::spanned::Spanned;
use syn::{
    Attribute, Error, Fields, ImplItem, ImplItemFn, Item, ItemStruct, LitStr, Result, Type, parse_quote, parse_str,
};

use stub::{Stub, rust, signature};

/// A class, methods of one, or a function, with docstrings and signatures; a field that Python reads says
/// `#[pyo3(get)]`.
#[proc_macro_attribute]
pub fn stubbed(_: TokenStream, item: TokenStream) -> TokenStream {
    made(syn::parse(item).and_then(|item| with_stub(|stub| described(item, stub))))
}

/// A class of fields that Python reads, those of the stubs, by which it is pickled:
/// `#[answer] struct State;`. What Rust adds as a field has its default value when it is read again.
/// `#[answer("<State t={t}>")]` says how it is printed.
#[proc_macro_attribute]
pub fn answer(printed: TokenStream, item: TokenStream) -> TokenStream {
    let printed = syn::parse::<Option<LitStr>>(printed);
    made(printed.and_then(|printed| with_stub(|stub| filled(syn::parse(item)?, printed, stub))))
}

/// The exceptions of the stubs, those with two bases left out.
#[proc_macro]
pub fn exceptions(_: TokenStream) -> TokenStream {
    made(with_stub(|stub| {
        let one = |(name, base, doc): (&str, &str, &str)| {
            let base = if base == "Exception" { "PyException" } else { base };
            let (name, base) = (format_ident!("{name}"), format_ident!("{base}"));
            quote!(pyo3::create_exception!(deltaq, #name, #base, #doc);)
        };
        Ok(stub.exceptions().map(one).collect())
    }))
}

fn made(item: Result<Tokens>) -> TokenStream {
    item.unwrap_or_else(|error| error.to_compile_error()).into()
}

fn with_stub(make: impl FnOnce(&Stub) -> Result<Tokens>) -> Result<Tokens> {
    let stub = Stub::read().map_err(|error| Error::new(proc_macro2::Span::call_site(), error))?;
    make(&stub)
}

/// Its docstring and, of a function, its signature. Python calls what has a name `__so__` in its own way.
fn said(stub: &Stub, at: &impl Spanned, name: &str, is_called: bool) -> Result<Vec<Attribute>> {
    let own = name.rsplit('.').next().unwrap_or_default();
    let is_slot = own.starts_with("__") && own != "__new__";
    let Some(entry) = stub.entry(name) else {
        let absent = Error::new(at.span(), format!("the stubs do not name `{name}`"));
        return if is_slot { Ok(Vec::new()) } else { Err(absent) };
    };
    let mut attributes = Vec::new();
    if !entry.doc.is_empty() {
        let doc = &entry.doc;
        attributes.push(parse_quote!(#[doc = #doc]));
    }
    if is_called && !is_slot {
        let arguments: Tokens = parse_str(&signature(&entry.said, name.contains('.')))?;
        attributes.push(parse_quote!(#[pyo3(signature = #arguments)]));
    }
    Ok(attributes)
}

fn has(attributes: &[Attribute], name: &str) -> bool {
    attributes.iter().any(|own| own.path().is_ident(name))
}

fn plain(name: &impl ToString) -> String {
    name.to_string().trim_start_matches("r#").to_owned()
}

fn described(item: Item, stub: &Stub) -> Result<Tokens> {
    match item {
        Item::Struct(mut class) => {
            let name = class.ident.to_string();
            class.attrs.extend(said(stub, &class.ident, &name, false)?);
            for field in class.fields.iter_mut().filter(|field| has(&field.attrs, "pyo3")) {
                let own = field.ident.as_ref().map(plain).unwrap_or_default();
                field.attrs.extend(said(stub, &field.ident, &format!("{name}.{own}"), false)?);
            }
            Ok(quote!(#[pyo3::pyclass(frozen, module = "deltaq")] #class))
        }
        Item::Impl(mut methods) => {
            let class = methods.self_ty.to_token_stream().to_string();
            for item in &mut methods.items {
                let ImplItem::Fn(ImplItemFn { attrs, sig, .. }) = item else { continue };
                let name = if has(attrs, "new") { "__new__".into() } else { plain(&sig.ident) };
                let is_called = !has(attrs, "getter");
                attrs.extend(said(stub, &sig.ident, &format!("{class}.{name}"), is_called)?);
                if sig.inputs.len() > 7 {
                    attrs.push(parse_quote!(#[expect(clippy::too_many_arguments, reason = "named in Python")]));
                }
            }
            Ok(quote!(#[pyo3::pymethods] #methods))
        }
        Item::Fn(mut function) => {
            function.attrs.extend(said(stub, &function.sig.ident, &plain(&function.sig.ident), true)?);
            Ok(quote!(#[pyo3::pyfunction] #function))
        }
        other => Err(Error::new(other.span(), "a class, methods or a function is needed")),
    }
}

fn filled(mut class: ItemStruct, printed: Option<LitStr>, stub: &Stub) -> Result<Tokens> {
    let (ident, name) = (class.ident.clone(), class.ident.to_string());
    let own: Vec<_> = class.fields.iter().map(|field| field.ident.clone()).collect();
    let (names, kinds): (Vec<&str>, Vec<&str>) = stub.fields(&name).unzip();
    let fields: Vec<_> = names.iter().map(|name| format_ident!("{name}")).collect();
    let kinds = kinds.into_iter().map(|kind| parse_str::<Type>(&rust(kind))).collect::<Result<Vec<_>>>()?;
    let more = class.fields.iter();
    class.fields = Fields::Named(parse_quote!({ #(#[pyo3(get)] pub(crate) #fields: #kinds,)* #(#more,)* }));
    class.semi_token = None;
    let class = described(Item::Struct(class), stub)?;
    let printed = printed.map(|text| {
        let all = text.value();
        let is_shown = |name: &&&str| all.contains(&format!("{{{name}}}")) || all.contains(&format!("{{{name}:"));
        let shown = names.iter().filter(is_shown).map(|name| format_ident!("{name}"));
        quote!(fn __repr__(&self) -> String {
            let #ident { #(#shown,)* .. } = self;
            format!(#text)
        })
    });
    // the module is compiled again where the stubs change
    let file = stub.file.to_string_lossy();
    Ok(quote! {
        const _: &str = include_str!(#file);

        #class

        #[pyo3::pymethods]
        impl #ident {
            fn __reduce__<'py>(slf: &pyo3::Bound<'py, Self>) -> pyo3::PyResult<crate::pickled::Reduced<'py>> {
                crate::pickled::reduced(slf.as_any(), &[#(#names),*])
            }

            #printed

            #[classmethod]
            fn _again(
                _class: &pyo3::Bound<'_, pyo3::types::PyType>,
                state: &pyo3::Bound<'_, pyo3::types::PyDict>,
            ) -> pyo3::PyResult<Self> {
                Ok(#ident { #(#fields: crate::pickled::field(state, #names)?,)* #(#own: Default::default(),)* })
            }
        }
    })
}
