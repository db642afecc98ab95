//! Where a derivation can be made wrong: every place in a source, and what to write there instead.
//!
//! The mathematics of a derivation stands in method calls on an expression graph, so the mutations are those of such
//! calls: a sign turned, a term dropped, a factor dropped, a rate left out of a flow. What does not fit by type is found
//! when it does not compile.

use std::ops::Range;

use anyhow::{Context, Result};
use syn::punctuated::Punctuated;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Attribute, BinOp, Expr, ExprCall, ExprMethodCall, Member, Stmt, Token};

/// One change of a source: a replacement of one range of bytes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mutant {
    /// Path of the source, from the root of the workspace.
    pub(crate) file: String,
    /// Name of the innermost function around the change.
    pub(crate) function: String,
    /// Line where the change begins, from 1.
    pub(crate) line: usize,
    /// The text of that line.
    pub(crate) context: String,
    pub(crate) range: Range<usize>,
    /// What stands there, its white space made single blanks.
    pub(crate) original: String,
    /// What is written there, its white space made single blanks.
    pub(crate) replacement: String,
    /// The change in words.
    pub(crate) what: &'static str,
    /// What is written there, to the letter.
    pub(crate) text: String,
}

/// Every mutant of a source, in the order of their places.
pub(crate) fn find(file: &str, source: &str) -> Result<Vec<Mutant>> {
    let syntax = syn::parse_file(source).with_context(|| format!("{file} does not parse"))?;
    let mut finder = Finder { file, source, functions: Vec::new(), mutants: Vec::new() };
    finder.visit_file(&syntax);
    let mut mutants = finder.mutants;
    mutants.sort_by(|a, b| (a.range.start, b.range.end, &a.text).cmp(&(b.range.start, a.range.end, &b.text)));
    mutants.dedup_by(|a, b| a.range == b.range && a.text == b.text);
    Ok(mutants)
}

/// White space made single blanks, so that a text can be shown in one line and found after reformatting.
pub(crate) fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Methods whose answer is a truth value.
const QUESTIONS: [&str; 7] = ["is_zero", "depends_on", "is_autonomous", "has_forces", "is_some", "is_none", "is_empty"];
/// Methods on a graph that give one expression, of which the sign and the whole matter.
const VALUES: [&str; 3] = ["derivative", "total_derivative", "dot"];
/// Methods on a graph that give a vector of expressions.
const VECTORS: [&str; 3] = ["gradient", "transpose_vec", "mat_vec"];

struct Finder<'a> {
    file: &'a str,
    source: &'a str,
    /// Names of the functions around, outermost first, each with what its graph is called.
    functions: Vec<(String, String)>,
    mutants: Vec<Mutant>,
}

impl Finder<'_> {
    fn text(&self, node: &impl Spanned) -> &str {
        &self.source[node.span().byte_range()]
    }

    fn graph(&self) -> &str {
        self.functions.last().map_or("g", |(_, graph)| graph)
    }

    fn add(&mut self, node: &impl Spanned, text: impl Into<String>, what: &'static str) {
        let (span, text) = (node.span(), text.into());
        self.mutants.push(Mutant {
            file: self.file.to_owned(),
            function: self.functions.last().map_or_else(String::new, |(name, _)| name.clone()),
            line: span.start().line,
            context: self.source.lines().nth(span.start().line - 1).map_or_else(String::new, one_line),
            range: span.byte_range(),
            original: one_line(self.text(node)),
            replacement: one_line(&text),
            what,
            text,
        });
    }

    fn within(&mut self, name: String, body: &syn::Block, walk: impl FnOnce(&mut Self)) {
        let mut search = Receivers { found: None };
        search.visit_block(body);
        let graph = search.found.map_or_else(|| "g".to_owned(), |range| self.source[range].to_owned());
        self.functions.push((name, graph));
        walk(self);
        self.functions.pop();
    }

    /// Mutants of a call of a method on a graph.
    fn graph_call(&mut self, call: &ExprMethodCall) {
        let (graph, whole) = (self.text(&call.receiver).to_owned(), self.text(call).to_owned());
        let method = call.method.to_string();
        let arguments: Vec<String> = call.args.iter().map(|a| self.text(a).to_owned()).collect();
        match (method.as_str(), arguments.as_slice()) {
            ("sub", [a, b]) => {
                self.add(call, format!("{graph}.add({a}, {b})"), "sign turned");
                self.add(call, a, "term dropped");
                self.add(call, format!("{graph}.neg({b})"), "term dropped");
            }
            ("add", [a, b]) => {
                self.add(call, format!("{graph}.sub({a}, {b})"), "sign turned");
                self.add(call, a, "term dropped");
                self.add(call, b, "term dropped");
            }
            ("mul", [a, b]) => {
                self.add(call, a, "factor dropped");
                self.add(call, b, "factor dropped");
            }
            ("div", [a, b]) => {
                self.add(call, format!("{graph}.mul({a}, {b})"), "divisor made a factor");
                self.add(call, a, "divisor dropped");
            }
            ("neg", [a]) => self.add(call, a, "sign turned"),
            ("sum", [_]) => self.sum(call, &graph, &whole),
            ("integer", [n]) => self.add(call, format!("{graph}.integer({n} + 1)"), "number changed"),
            ("one", []) => self.add(call, format!("{graph}.neg({whole})"), "sign turned"),
            ("substitute", [e, map]) => {
                // What is not substituted keeps its type all the same.
                let kind = "std::collections::HashMap<symbolic::Symbol, symbolic::Expr>";
                self.add(call, format!("{{ let _: &{kind} = {map}; {e} }}"), "substitution left out");
            }
            ("jacobian", _) => {
                let entry = format!("|i, j| {graph}.neg(m[(i, j)])");
                let matrix = format!("symbolic::Matrix::from_fn(m.rows(), m.columns(), {entry})");
                self.add(call, format!("{{ let m = {whole}; {matrix} }}"), "sign turned");
            }
            (name, _) if VALUES.contains(&name) => {
                self.add(call, format!("{graph}.neg({whole})"), "sign turned");
                self.add(call, format!("{graph}.zero()"), "made zero");
            }
            (name, _) if VECTORS.contains(&name) => {
                let negated = format!("{whole}.into_iter().map(|e| {graph}.neg(e)).collect::<Vec<_>>()");
                self.add(call, negated, "sign turned");
            }
            _ => {}
        }
    }

    fn sum(&mut self, call: &ExprMethodCall, graph: &str, whole: &str) {
        let Some(Expr::Reference(terms)) = call.args.first() else { return };
        let Expr::Array(terms) = &*terms.expr else {
            return self.add(call, format!("{graph}.neg({whole})"), "sign turned");
        };
        for (left_out, term) in terms.elems.iter().enumerate() {
            let kept = terms.elems.iter().enumerate().filter(|(i, _)| *i != left_out);
            let kept: Vec<&str> = kept.map(|(_, term)| self.text(term)).collect();
            self.add(call, format!("{graph}.sum(&[{}])", kept.join(", ")), "term dropped");
            // The sign of a term that is written with its sign is turned there.
            if !matches!(term, Expr::MethodCall(inner) if inner.method == "neg" && is_graph(&inner.receiver)) {
                self.add(term, format!("{graph}.neg({})", self.text(term)), "sign turned");
            }
        }
    }

    /// Mutants of a call of any other method.
    fn other_call(&mut self, call: &ExprMethodCall) {
        let (receiver, whole) = (self.text(&call.receiver).to_owned(), self.text(call).to_owned());
        match (call.method.to_string().as_str(), call.args.len()) {
            ("chain", 1) => self.add(call, receiver, "continuation dropped"),
            ("any", 1) => self.add(call, format!("{receiver}.all({})", self.text(&call.args)), "any made all"),
            ("all", 1) => self.add(call, format!("{receiver}.any({})", self.text(&call.args)), "all made any"),
            (name, _) if QUESTIONS.contains(&name) => self.add(call, format!("!{whole}"), "condition turned"),
            _ => {}
        }
        if call.method == "push"
            && self.text(&call.receiver) == "flow"
            && let Some(Expr::Tuple(pair)) = call.args.first()
            && let Some(rate) = pair.elems.get(1).filter(|rate| !is_call_of(rate, "one"))
        {
            self.add(rate, format!("{}.neg({})", self.graph(), self.text(rate)), "sign of a rate turned");
        }
    }
}

impl<'ast> Visit<'ast> for Finder<'_> {
    fn visit_attribute(&mut self, _: &'ast Attribute) {}

    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        if !is_for_tests(&item.attrs) {
            visit::visit_item_mod(self, item);
        }
    }

    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        if !is_for_tests(&item.attrs) {
            self.within(item.sig.ident.to_string(), &item.block, |finder| visit::visit_item_fn(finder, item));
        }
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        if !is_for_tests(&item.attrs) {
            self.within(item.sig.ident.to_string(), &item.block, |finder| visit::visit_impl_item_fn(finder, item));
        }
    }

    fn visit_stmt(&mut self, statement: &'ast Stmt) {
        if let Stmt::Expr(Expr::MethodCall(call), Some(_)) = statement
            && ["push", "extend", "retain"].contains(&call.method.to_string().as_str())
        {
            self.add(statement, "", "statement left out");
        }
        visit::visit_stmt(self, statement);
    }

    fn visit_expr_method_call(&mut self, call: &'ast ExprMethodCall) {
        if is_graph(&call.receiver) {
            self.graph_call(call);
        }
        self.other_call(call);
        visit::visit_expr_method_call(self, call);
    }

    /// The rate that is handed to a function `state`.
    fn visit_expr_call(&mut self, call: &'ast ExprCall) {
        if let (Expr::Path(path), Some(rate)) = (&*call.func, call.args.get(3))
            && path.path.is_ident("state")
        {
            self.add(rate, format!("{}.neg({})", self.graph(), self.text(rate)), "sign of a rate turned");
        }
        visit::visit_expr_call(self, call);
    }

    fn visit_expr_struct(&mut self, literal: &'ast syn::ExprStruct) {
        let kind = literal.path.segments.last().map(|segment| segment.ident.to_string());
        for field in &literal.fields {
            let Member::Named(name) = &field.member else { continue };
            let value = self.text(&field.expr).to_owned();
            match (kind.as_deref(), name.to_string().as_str()) {
                (Some("StateVariable"), "rate" | "start") => {
                    let what = if name == "rate" { "sign of a rate turned" } else { "sign of a start turned" };
                    self.add(field, format!("{name}: {}.neg({value})", self.graph()), what);
                }
                (Some("FreeConstant"), "natural") if value.starts_with("Some") => {
                    self.add(field, "natural: None", "end condition left out");
                }
                _ => {}
            }
        }
        visit::visit_expr_struct(self, literal);
    }

    fn visit_expr_unary(&mut self, unary: &'ast syn::ExprUnary) {
        if !matches!(unary.op, syn::UnOp::Not(_)) {
            return visit::visit_expr_unary(self, unary);
        }
        let before = self.mutants.len();
        visit::visit_expr_unary(self, unary);
        let inner = unary.expr.span().byte_range();
        // `!(!x)` is the same change.
        let last = self.mutants.split_off(before);
        self.mutants.extend(last.into_iter().filter(|m| m.range != inner || m.what != "condition turned"));
        self.add(unary, self.text(&unary.expr).to_owned(), "condition turned");
    }

    fn visit_expr_binary(&mut self, binary: &'ast syn::ExprBinary) {
        let (left, right) = (self.text(&binary.left).to_owned(), self.text(&binary.right).to_owned());
        match binary.op {
            BinOp::Eq(_) => self.add(binary, format!("({left} != {right})"), "condition turned"),
            BinOp::Ne(_) => self.add(binary, format!("({left} == {right})"), "condition turned"),
            BinOp::And(_) | BinOp::Or(_) => {
                let other = if matches!(binary.op, BinOp::And(_)) { "||" } else { "&&" };
                self.add(binary, format!("({left} {other} {right})"), "conditions joined otherwise");
                self.add(binary, left, "condition dropped");
                self.add(binary, right, "condition dropped");
            }
            _ => {}
        }
        visit::visit_expr_binary(self, binary);
    }

    fn visit_expr_if(&mut self, branch: &'ast syn::ExprIf) {
        if let Expr::Path(condition) = &*branch.cond {
            self.add(condition, format!("!{}", self.text(condition)), "condition turned");
        }
        visit::visit_expr_if(self, branch);
    }

    fn visit_expr_range(&mut self, range: &'ast syn::ExprRange) {
        for (at, end) in [&range.start, &range.end].into_iter().enumerate() {
            let Some(Expr::Lit(literal)) = end.as_deref() else { continue };
            let syn::Lit::Int(number) = &literal.lit else { continue };
            let Ok(value) = number.base10_parse::<u64>() else { continue };
            let next = format!("{}{}", value + 1, number.suffix());
            let other = |end: &Option<Box<Expr>>| end.as_ref().map_or(String::new(), |e| self.text(e).to_owned());
            let limits = self.text(&range.limits);
            let text = match at {
                0 => format!("{next}{limits}{}", other(&range.end)),
                _ => format!("{}{limits}{next}", other(&range.start)),
            };
            self.add(range, text, "range changed");
        }
        visit::visit_expr_range(self, range);
    }

    /// `vec![..]` holds expressions; what other macros hold is not looked into.
    fn visit_macro(&mut self, mac: &'ast syn::Macro) {
        if mac.path.is_ident("vec")
            && let Ok(list) = mac.parse_body_with(Punctuated::<Expr, Token![,]>::parse_terminated)
        {
            list.iter().for_each(|element| self.visit_expr(element));
        }
    }
}

/// Where the first graph stands in a function.
struct Receivers {
    found: Option<Range<usize>>,
}

impl<'ast> Visit<'ast> for Receivers {
    fn visit_expr_method_call(&mut self, call: &'ast ExprMethodCall) {
        if self.found.is_none() && is_graph(&call.receiver) {
            self.found = Some(call.receiver.span().byte_range());
        }
        visit::visit_expr_method_call(self, call);
    }
}

/// `g`, `graph`, or a field called `graph`.
fn is_graph(receiver: &Expr) -> bool {
    match receiver {
        Expr::Path(path) => path.path.is_ident("g") || path.path.is_ident("graph"),
        Expr::Field(field) => matches!(&field.member, Member::Named(name) if name == "graph"),
        _ => false,
    }
}

fn is_call_of(e: &Expr, method: &str) -> bool {
    matches!(e, Expr::MethodCall(call) if call.method == method)
}

fn is_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let path = attribute.path();
        let list = attribute.meta.require_list();
        path.is_ident("test") || path.is_ident("cfg") && list.is_ok_and(|list| list.tokens.to_string() == "test")
    })
}
