//! The Python module has one kind of lock, by whose type nobody waits for Python's while holding it.

use std::path::Path;

#[test]
fn the_python_module_has_one_kind_of_lock() {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/python/src");
    let mut wrong = String::new();
    for file in std::fs::read_dir(sources).expect("a folder") {
        let path = file.expect("a file").path();
        let text = std::fs::read_to_string(&path).expect("a source");
        let locks = ["Mutex", "RwLock", "RefCell", "Condvar", "LazyLock"].into_iter();
        let locks: Vec<&str> = locks.filter(|lock| text.contains(lock)).collect();
        if !locks.is_empty() && !path.ends_with("shared.rs") {
            wrong += &format!("{}: {}; use `Shared`\n", path.display(), locks.join(", "));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}
