//! What a student's file may not name.

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// What an exercise has no use for: with these a file could end the test program, or write the log that judges it.
const FORBIDDEN: [&str; 8] = [
    "process",
    "fs",
    "env",
    "net",
    "unsafe",
    "extern",
    "include",
    "include_str",
];

/// The first word of a file that an exercise may not have, or a module in a file of its own, which nobody read.
/// Comments are no tokens.
pub fn forbidden(file: &str) -> Option<&'static str> {
    // The compiler skips a first line `#!…`, and this reader stumbles over what stands there.
    file.parse()
        .map_or(Some("a text that is not Rust"), word_in)
}

fn word_in(source: TokenStream) -> Option<&'static str> {
    let mut tokens = source.into_iter().peekable();
    while let Some(token) = tokens.next() {
        let found = match token {
            TokenTree::Group(group) => word_in(group.stream()),
            TokenTree::Ident(ident) if ident == "mod" => {
                let is_named = matches!(tokens.next(), Some(TokenTree::Ident(_)));
                let has_body = matches!(tokens.peek(),
                    Some(TokenTree::Group(body)) if body.delimiter() == Delimiter::Brace);
                (!(is_named && has_body)).then_some("mod …;")
            }
            TokenTree::Ident(ident) => {
                let name = ident.to_string();
                let name = name.strip_prefix("r#").unwrap_or(&name);
                FORBIDDEN.into_iter().find(|word| *word == name)
            }
            TokenTree::Punct(_) | TokenTree::Literal(_) => None,
        };
        if found.is_some() {
            return found;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::run::root;

    #[test]
    fn a_file_may_not_reach_for_the_process_or_for_files() {
        for (source, word) in [
            ("fn f() { std::process::exit(0) }", Some("process")),
            ("use std::{r#fs as files, mem};", Some("fs")),
            ("use std as s; fn f() { s::env::args(); }", Some("env")),
            (
                "let a = ('\"', r\"\\\", \"//\"); unsafe { f() }",
                Some("unsafe"),
            ),
            (
                "macro_rules! m { () => { include!(\"x\") } }",
                Some("include"),
            ),
            ("# [ path = \"x.rs\" ] mod x;", Some("mod …;")),
            ("#[cfg_attr(all(), path = \"x.rs\")] mod x;", Some("mod …;")),
            ("mod a { pub mod b; }", Some("mod …;")),
            (
                "macro_rules! m { ($n:ident $e:tt) => { mod $n $e } } m!(x ;);",
                Some("mod …;"),
            ),
            (
                "#!\"\nfn f() { std::process::exit(0) }",
                Some("a text that is not Rust"),
            ),
            (
                "// The process of a net\nmod a { let path = [path, \"process\"]; /* env */ }",
                None,
            ),
        ] {
            assert_eq!(forbidden(source), word, "{source}");
        }
        for folder in ["src", "solutions/src"] {
            for file in fs::read_dir(root().join("teaching/exercises").join(folder)).unwrap() {
                let path = file.unwrap().path();
                if path.ends_with("lib.rs") {
                    continue;
                }
                let text = fs::read_to_string(&path).unwrap();
                assert_eq!(forbidden(&text), None, "{}", path.display());
            }
        }
    }
}
