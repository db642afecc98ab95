//! `evidence bench`: what is measured is right, and what fails is listed.

use bench::{Effort, KeptReferences, ensemble_throughput, measure, prepare, references};
use bench::{bench_files, bench_json};
use diffsol_methods::EVERY;
use integrate::Method;
use validation::{REFERENCES, kept_references};

fn effort(max_steps: usize) -> Effort {
    Effort { methods: EVERY.to_vec(), every: 1, seconds: 1e-6, repeats: 1, max_steps, patience: 0.05 }
}

#[test]
fn every_formulation_is_measured_by_every_method() {
    let bench = measure(prepare("sledge", &KeptReferences::default()).unwrap(), &effort(20_000), |_| ()).unwrap();
    assert!(bench.entries.len() >= 6);
    for form in motion::FORMS {
        assert!(bench.entries.iter().any(|e| e.formulation == form.name), "{} is not measured", form.name);
    }
    for entry in &bench.entries {
        let m = entry.outcome.as_ref().unwrap_or_else(|reason| panic!("{}: {reason}", entry.label));
        assert_eq!(m.series.len(), EVERY.len());
        assert!(m.reference_error < 1e-10, "{}: {:.1e}", entry.label, m.reference_error);
        let best = m.fastest(1e-9, Some(Method::Dop853)).expect("an error of 1e-9");
        assert!(best.error <= 1e-9 && best.seconds > 0.0 && best.work.evaluations > 12 * best.work.steps);
        assert!(m.fastest(0.0, None).is_none(), "no run is exact");
    }
    let json = bench_json(&[bench]);
    let point = &json["scenes"][0]["motions"][0]["series"][0]["points"][0];
    assert!(point["error"].as_f64().unwrap() > 0.0 && point["evaluations"].as_u64().unwrap() > 0);
}

#[test]
fn failures_are_listed_with_their_cause() {
    let bench = measure(prepare("sledge", &KeptReferences::default()).unwrap(), &effort(20), |_| ()).unwrap();
    let files = bench_files(&[bench], &[]).unwrap();
    let failures = &files.iter().find(|f| f.path.ends_with("failures.csv")).unwrap().text;
    assert!(failures.contains("more than 20 steps"), "{failures}");
}

#[test]
fn ensembles_are_measured_and_reported_with_what_they_agree_to() {
    let measured = ensemble_throughput(37, 1e-9, 1).unwrap();
    assert_eq!(measured.len(), 3);
    for m in &measured {
        assert_eq!((m.members, m.over_cores), (37, 0.0), "{}", m.label);
        assert!(m.difference < 1e-7 && m.over_single() > 0.0, "{}: {:.1e}", m.label, m.difference);
        let [single, lanes] = m.mean_steps();
        assert!(single > 1.0 && (single - lanes).abs() <= 0.05 * single, "{}: {single} and {lanes} steps", m.label);
        assert!(m.efficiency().is_none_or(|e| e > 0.0 && e.is_finite()), "{}: {:?}", m.label, m.efficiency());
    }
    let files = bench_files(&[], &measured).unwrap();
    let text = |name: &str| files.iter().find(|f| f.path.ends_with(name)).expect(name).text.clone();
    let table = text("ensembles.csv");
    assert_eq!(table.lines().filter(|line| line.contains(",37,")).count(), 3, "{table}");
    assert!(text("error-vs-time.md").contains("`evidence bench --ensemble 1e-10`"));
    assert!(bench_files(&[], &[]).unwrap().iter().all(|f| !f.text.contains("Many motions")));
}

/// Every tenth of them; `REFERENCES=write cargo test --release --package deltaq-validation bench::` computes
/// and writes all.
#[test]
fn kept_references_are_those_of_the_equations_and_a_tenth_is_found_again() {
    let names: Vec<&str> = scene::catalogue::SCENES.iter().map(|(name, _)| *name).collect();
    if std::env::var("REFERENCES").is_ok_and(|asked| asked == "write") {
        let found = KeptReferences::behind(&references(&names, &KeptReferences::default(), true).unwrap());
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(REFERENCES);
        std::fs::write(path, found.text()).unwrap();
        return;
    }
    let kept = kept_references().unwrap();
    let tenth = |i: usize| i % 10 == 7;
    let others = kept.only(|i| !tenth(i));
    let found = KeptReferences::behind(&references(&names, &others, true).unwrap());
    let formulas = |of: &KeptReferences| -> Vec<(String, u64)> {
        of.motions().iter().map(|motion| (motion.name.clone(), motion.digests[0])).collect()
    };
    assert_eq!(formulas(&found), formulas(&kept), "REFERENCES=write writes them anew");
    let mut again = 0;
    for (i, (now, before)) in found.motions().iter().zip(kept.motions()).enumerate() {
        // the last bits of a start may be others on another machine
        if now.digests == before.digests {
            let (apart, limit) = (now.reference.gap(&before.reference), now.reference.error + before.reference.error);
            assert!(apart <= limit, "{}: {apart:.1e} over {limit:.1e}", now.name);
            again += usize::from(tenth(i));
        }
    }
    assert!(again >= kept.motions().len() / 20, "{again} of {} found again", kept.motions().len());
    // what is not of the file is noticed
    let text = kept.text();
    assert_eq!(KeptReferences::read(&text).unwrap().text(), text);
    let digit = text.rfind('1').unwrap();
    let error = KeptReferences::read(&format!("{}2{}", &text[..digit], &text[digit + 1..])).unwrap_err();
    assert!(error.to_string().contains("not the numbers"), "{error}");
}
