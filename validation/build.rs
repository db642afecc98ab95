//! Nothing is done here: cargo only looks at dependencies of a build script where there is one.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
}
