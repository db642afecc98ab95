//! The ball on the turning table in the engine, for the judge of motions: `turntable DT STEPS EVERY CONTACTS
//! NAME=VALUE…`, `CONTACTS` a natural frequency in Hz or `shipped`. One line per sample: time, centre,
//! attitude (w, x, y, z), velocity of the centre, angular velocity; the room frame, `z` up; s, m, rad/s.

use anyhow::{Context, Result, bail};
use engine::{Contacts, Mapping, Run};

fn main() -> Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [dt, steps, every, contacts, changes @ ..] = &words[..] else {
        bail!("turntable DT STEPS EVERY CONTACTS [NAME=VALUE…]");
    };
    let dt: f64 = dt.parse().with_context(|| format!("DT: `{dt}`"))?;
    let steps: usize = steps.parse().with_context(|| format!("STEPS: `{steps}`"))?;
    let every: usize = every.parse().with_context(|| format!("EVERY: `{every}`"))?;
    let contacts = match contacts.as_str() {
        "shipped" => Contacts::AsShipped,
        hertz => Contacts::Stiff { frequency: hertz.parse().with_context(|| format!("CONTACTS: `{hertz}`"))? },
    };
    if every == 0 {
        bail!("EVERY: 0 steps lie between no two samples");
    }
    let pairs = changes.iter().map(|pair| -> Result<(String, scene::Number)> {
        let (name, value) = pair.split_once('=').with_context(|| format!("`{pair}` is not NAME=VALUE"))?;
        Ok((name.to_string(), value.parse().with_context(|| format!("`{pair}`"))?))
    });
    let scene = scene::catalogue::find("turntable", &pairs.collect::<Result<Vec<_>>>()?)?;
    let setup = Mapping::new(&scene)?.setup;
    let samples = steps / every;
    let run = Run { contacts, duration: dt * steps as f64, steps, samples }.of(&setup)?;
    for (k, (pose, [velocity, spin])) in run.poses.iter().zip(&run.rates).enumerate() {
        let q = pose.attitude;
        let vectors = [pose.centre.to_array(), velocity.to_array(), spin.to_array()];
        let [c, v, w] = vectors.map(|x| format!("{:e} {:e} {:e}", x[0], x[1], x[2]));
        println!("{:e} {c} {:e} {:e} {:e} {:e} {v} {w}", dt * (k * every) as f64, q.w, q.x, q.y, q.z);
    }
    Ok(())
}
