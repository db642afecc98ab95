//! Where the environment of the referee in Python is kept.

use validation::casadi_job::{cache, target};

#[test]
fn the_target_folder_is_the_one_that_this_program_was_built_into() {
    let (program, target) = (std::env::current_exe().unwrap(), target());
    assert!(target.is_absolute() && program.starts_with(&target), "{} in {}", program.display(), target.display());
}

#[test]
fn an_installed_program_keeps_to_the_users_cache() {
    let (named, home) = (std::env::temp_dir().join("cache"), std::env::temp_dir().join("me"));
    let in_home = home.join(".cache").join("deltaq");
    assert_eq!(cache(Some(named.clone()), Some(home.clone())), named.join("deltaq"));
    assert_eq!(cache(None, Some(home.clone())), in_home);
    assert_eq!(cache(Some("relative".into()), Some(home)), in_home, "not absolute");
    assert!(cache(None, None).is_absolute());
}
