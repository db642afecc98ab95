use review::{Asked, review};

#[test]
fn every_scene_shown_as_text_latex_and_code() {
    for (name, _) in catalogue::built_in() {
        let scene = catalogue::find(name, &[]).unwrap();
        let choices = deltaq::choices(&scene);
        let choice = choices.iter().find(|c| c.formulation == deltaq::CHETAEV).unwrap();
        let equations = deltaq::derive(&scene.system, choice).unwrap();
        let g = &equations.graph;
        let lines = |print: &dyn Fn(symbolic::Expr) -> String| {
            let lines = equations.statements.iter().map(|s| format!("{} = {}\n", print(s.left), print(s.right)));
            lines.collect::<String>()
        };
        let code = {
            let prepared = deltaq::prepare(deltaq::setting(&scene), equations.clone(), &choice.constants, &deltaq::Settings::default()).unwrap();
            deltaq::code(&scene, &prepared, deltaq::Language::C).unwrap()
        };
        for (file, text) in [("a.txt", lines(&|e| g.plain(e))), ("a.tex", lines(&|e| g.latex(e))), ("a.c", code)] {
            let before = std::time::Instant::now();
            match review(&scene, file, &text, &Asked::default()) {
                Ok(r) => println!("{name} {file} {:?} {:?} {:?} {:?} {:?}", r.verdict, r.numbers, r.notes, r.explanations.first(), before.elapsed()),
                Err(e) => println!("{name} {file} ERROR {}", e.to_string().chars().take(300).collect::<String>()),
            }
        }
    }
}
