//! draft
use engine::*;
fn main() -> anyhow::Result<()> {
    let ball = Ball { mass: 1.0, radius: 0.1, gyration: 0.1 * 0.4f64.sqrt() };
    let setup = Setup::incline(0.3, ball, 9.81);
    for c in [Contacts::Hard, Contacts::AsShipped] {
        for steps in [100, 200, 400, 800, 1600, 16000] {
            let t = Run { contacts: c, duration: 1.0, steps, samples: 100 }.of(&setup)?;
            let d = (t.poses[100].centre - t.poses[0].centre).length();
            let e = 5.0 / 14.0 * 9.81 * 0.3f64.sin();
            println!("incline {c:?} {steps} {:e} off {:e} slip {:e}", d / e - 1.0, t.off_surface, t.slip);
        }
    }
    for name in ["turntable", "ball-in-cone"] {
        let scene = validation::catalogue::find(name, &[])?;
        let map = Mapping::new(&scene)?;
        println!("{name} residual {:e}", map.residual);
        let mut targets = vec![];
        for c in deltaq::choices(&scene) {
            let mut m = deltaq::solve_choice(&scene, &c, &Default::default())?;
            println!("{} {} {}", c.label, c.formulation, m.end());
            let mut p = vec![];
            for k in 0..=100 {
                let t = scene.duration * k as f64 / 100.0;
                if t <= m.end() { p.push(map.pose(&m.at(t)?.coordinates)) }
            }
            targets.push(p);
        }
        for c in [Contacts::Hard, Contacts::AsShipped] {
            let mut last: Option<Trajectory> = None;
            for k in 0..10 {
                let steps = 500 << k;
                let clock = std::time::Instant::now();
                let t = Run { contacts: c, duration: scene.duration, steps, samples: 100 }.of(&map.setup)?;
                let s = clock.elapsed().as_secs_f64();
                let d = |p: &[Pose], q: &[Pose]| p.iter().zip(q).map(|(a, b)| a.distance(b, map.setup.ball.gyration)).fold(0.0, f64::max);
                let ds: Vec<String> = targets.iter().map(|q| format!("{:.2e}", d(&t.poses, q))).collect();
                let x = last.map(|l| { let x: Vec<Pose> = t.poses.iter().zip(&l.poses).map(|(a, b)| a.extrapolated(b)).collect(); d(&x, &targets[0]) });
                println!("{c:?} {steps} {ds:?} rich {x:?} off {:.1e} slip {:.1e} {s:.2} s", t.off_surface, t.slip);
                last = Some(t);
            }
        }
    }
    Ok(())
}
