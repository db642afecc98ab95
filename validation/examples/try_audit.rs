fn main(){ let t=std::time::Instant::now(); let p=validation::audit::Paper::new().unwrap();
 for n in p.numbers(){ match p.check(n){ Err(e)=>println!("{n}: ERR {e:#}"), Ok(f)=>{ println!("{n:12} {:?} P {:?} C {:?}", f.verdict, f.printed.lines.iter().map(|l|l.residual).collect::<Vec<_>>(), f.corrected.lines.iter().map(|l|l.residual).collect::<Vec<_>>());
 if std::env::args().count()>1 { for l in f.printed.lines.iter().chain(&f.corrected.lines){println!("      {}",l.latex);} }
 for v in &f.variants{ println!("      {} {:?}", v.words, v.form.lines.iter().map(|l|l.residual).collect::<Vec<_>>()); } } } }
 println!("{:?}",t.elapsed()); }
