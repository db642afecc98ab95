//! Growth vectors at starts in exact numbers: what round-off hides is there.

use comparison::integrability;
use mechanics::Integrability;

use crate::support::read;

#[track_caller]
fn has_growth(coordinates: &str, constraints: &[&str], generic: &[usize], start: &[usize]) {
    let names: Vec<&str> = coordinates.split(' ').map(|own| own.split('=').next().expect("a name")).collect();
    let starts: String = coordinates.split(' ').fold(String::new(), |text, own| {
        let (name, at) = own.split_once('=').expect("a start");
        text + &format!("{name} = {{ start = \"{at}\" }}\n")
    });
    let squares: Vec<String> = names.iter().map(|name| format!("{name}'^2/2")).collect();
    let rates: String = names.iter().map(|name| format!("\"{name}'\" = 0\n")).collect();
    let scene = format!(
        "title = 'growth'\n[coordinates]\n{starts}[system]\nlagrangian = \"{}\"\nconstraints = {constraints:?}\n\
         [start.velocities]\n{rates}[run]\nduration = 1\n",
        squares.join(" + ")
    );
    let found = integrability(&read("growth", &scene)).expect("a verdict");
    let Integrability::Nonintegrable { growth: Some(growth), .. } = &found else { panic!("{found}") };
    assert!(growth.exact && !found.to_string().contains("round-off"), "{found}");
    assert_eq!((&growth.generic[..], &growth.start[..]), (generic, start), "{found}");
}

/// Jean 1996: two trailers with the tractor at a right angle, which no double is.
#[test]
fn a_right_angle_is_one() {
    let trailers =
        ["y'*cos(a) - x'*sin(a)", "y'*cos(b) - x'*sin(b) - b'", "y'*cos(c) - x'*sin(c) - b'*cos(b - c) - c'"];
    has_growth("x=0 a=pi/2 y=0 b=0 c=0", &trailers, &[2, 3, 4, 5], &[2, 3, 4, 4, 5]);
    has_growth("x=0 a=pi/3 y=0 b=0 c=0", &trailers, &[2, 3, 4, 5], &[2, 3, 4, 5]);
}

/// Published normal forms, their starts as formulas.
#[test]
fn normal_forms_have_their_published_growth_vectors() {
    has_growth("x=0 y=1/3 z=0", &["z' - x^2*y'"], &[2, 3], &[2, 2, 3]);
    let kumpera_ruiz = ["x2' - x3*x1'", "x3' - x4*x1'", "x1' - x5*x4'"];
    has_growth("x5=0 x4=0 x3=0 x2=0 x1=0", &kumpera_ruiz, &[2, 3, 4, 5], &[2, 3, 4, 4, 5]);
}

/// A pulse at x = 1 that is 4e-18 at x = 2, where doubles add it to 2, and not zero.
#[test]
fn what_round_off_hides_is_there() {
    let pulse = ["z' - x^2*y'/2", "w' - (x^2/2 + exp(-40*(x - 1)^2))*y'"];
    has_growth("x=2 y=0 z=0 w=0", &pulse, &[2, 3, 4], &[2, 3, 4]);
}

/// `z z' − s'` is a derivative beside what is 1e-231 at the drawn points; a 0 that may be off counts there.
#[test]
fn what_underflows_is_not_a_direction() {
    let scene = "title = 'small'\n[coordinates]\nx = { start = '1/3' }\ny = { start = '1e3' }\nz = { start = '3' }\n\
         w = { start = '-pi/2' }\ns = { start = '1/3' }\n[system]\n\
         lagrangian = \"x'^2/2 + y'^2 + 2*z'^2 + w'^2/2 + s'^2/2\"\n\
         constraints = [\"(w' + z^2*x' - 2*exp(-30*(x - 1/3)^2)*y' - sin(y)*z')*(2 + sin(x))\", \
         \"(s' - exp(-30*(x - 1)^2)*x'/2 - z*z')*(2 + sin(x))\"]\n[start.velocities]\n\"x'\" = -0.7\n\
         \"y'\" = -0.7\n\"z'\" = 0.5\n[run]\nduration = 1\n";
    let found = integrability(&read("small", scene)).expect("a verdict");
    assert!(matches!(found, Integrability::PartlyIntegrable { integrals: 1, constraints: 2, .. }), "{found}");
}
