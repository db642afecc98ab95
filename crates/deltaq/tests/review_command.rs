//! `deltaq review`: what it says, in which exit codes, and in which JSON.

use std::fs;
use std::process::{Command, Output};

use serde_json::Value;

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_deltaq")).args(arguments).output().unwrap()
}

const RIGHT: &str = "m*x'' - m*a*(phi''*sin(phi) + phi'^2*cos(phi)) = -k*sin(phi)
m*y'' + m*a*(phi''*cos(phi) - phi'^2*sin(phi)) = k*cos(phi)
(I + m*a^2)*phi'' = m*a*(x''*sin(phi) - y''*cos(phi))
y'*cos(phi) = x'*sin(phi)
";

#[test]
fn right_wrong_and_undecided_have_codes_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("theirs.txt");
    let says = |text: &str, code: i32, said: &[&str]| {
        fs::write(&path, text).unwrap();
        let answer = run(&["review", "sleigh", path.to_str().unwrap()]);
        let told = [answer.stdout, answer.stderr].map(|bytes| String::from_utf8(bytes).unwrap()).concat();
        assert!(answer.status.code() == Some(code) && said.iter().all(|words| told.contains(words)), "{told}");
    };
    says(RIGHT, 0, &["has the Chetaev motions of sleigh from every start", "multipliers and other unknowns: k"]);
    let frozen = RIGHT.replace("y'*cos(phi) = x'*", "y''*cos(phi) = x''*");
    let named = "These are exactly the equations of: rate of the constraint's coefficients left out.";
    says(&frozen, 1, &[named, "From the start of the scene on", "phi''", "finite field"]);
    says("x'' = 0\n", 3, &["cannot tell", "these equations do not determine phi''"]);
    says("x'' = 1 +\n", 2, &["theirs.txt:1:10: the expression ends where", "x'' = 1 +"]);
}

#[test]
fn its_own_code_is_right_and_its_json_has_the_schema() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("disc.c");
    fs::write(&path, run(&["show", "falling-disc", "--code", "c"]).stdout).unwrap();
    let answer = run(&["review", "falling-disc", path.to_str().unwrap(), "--format", "json"]);
    let value: Value = serde_json::from_slice(&answer.stdout).unwrap();
    let schema: Value = serde_json::from_slice(&run(&["schema", "review"]).stdout).unwrap();
    assert_eq!((&value["verdict"], answer.status.code()), (&"right".into(), Some(0)));
    let fields = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<Vec<String>>();
    assert_eq!(fields(&value), fields(&schema["properties"]));
    let refused = run(&["review", "falling-disc", path.to_str().unwrap(), "--where", "alpha = q"]);
    let complaint = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(complaint.contains("where alpha = q: `alpha` is neither a coordinate nor a parameter"), "{complaint}");
    assert_eq!(refused.status.code(), Some(2));
}
