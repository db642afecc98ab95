use review::{Verdict, review};

fn show(scene: &str, text: &str, wheres: &[&str]) {
    let scene = catalogue::find(scene, &[]).unwrap();
    let before = std::time::Instant::now();
    let wheres: Vec<String> = wheres.iter().map(|s| s.to_string()).collect();
    let answer = review(&scene, "theirs.txt", text, &wheres, deltaq::CHETAEV);
    println!("{:#?} {:?}", answer, before.elapsed());
}

#[test]
fn try_it() {
    show("falling-disc", "w = q1'*sin(q2) + q3'\na = 3/2*m*r^2\nb=5/4*m*r^2\nc=m*r^2/4\n\
      a*w'*sin(q2) + a*w*cos(q2)*q2' + c*cos(q2)^2*q1'' - 2*c*cos(q2)*sin(q2)*q1'*q2' = 0\n\
      b*q2'' - a*w*q1'*cos(q2) + c*cos(q2)*sin(q2)*q1'^2 + m*g*r*sin(q2) = 0\n a*w' = 0", &["phi=q1", "theta=-q2", "psi=q3", "R=r", "I=m*r^2/2", "J=m*r^2/4"]);
    show("sleigh", "m*x'' - m*a*phi'^2*cos(phi) - m*a*phi''*sin(phi) + l*sin(phi) = 0\nm*a*phi''*cos(phi) - m*a*phi'^2*sin(phi) + m*y'' - l*cos(phi)=0\nm*a*y''*cos(phi) - m*a*x''*sin(phi)  + phi''*(m*a + I) = 0\n y'*cos(phi) - x'*sin(phi)=0", &[]);
    show("sleigh", "m*x'' + m*a*phi'^2*cos(phi) - m*a*phi''*sin(phi) + l*sin(phi) = 0\nm*a*phi''*cos(phi) - m*a*phi'^2*sin(phi) + m*y'' - l*cos(phi)=0\nm*a*y''*cos(phi) - m*a*x''*sin(phi)  + phi''*(m*a^2 + I) = 0\n y''*cos(phi) - x''*sin(phi)=0", &[]);
    show("sleigh", "m*x'' - m*a*phi'^2*cos(phi) - m*a*phi''*sin(phi) + l*sin(phi) = 0\nm*a*phi''*cos(phi) - m*a*phi'^2*sin(phi) + m*y'' - l*cos(phi)=0\nm*a*y''*cos(phi) - m*a*x''*sin(phi)  + phi''*(m*a^2 + I) = 0\n y'*sin(phi) - x'*cos(phi)=0", &[]);
    let _ = Verdict::Right;
}
