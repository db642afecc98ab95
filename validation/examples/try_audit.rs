//! try
fn main(){ let t=std::time::Instant::now(); let p=validation::audit::Paper::new().unwrap();
 for n in p.numbers(){ match p.check(n){ Err(e)=>println!("{n}: ERR {e:#}"), Ok(f)=>{ 
 if f.verdict==validation::audit::Verdict::Open || n.contains("35") || f.along.is_some() {println!("{n} {:?} {:?}", f.verdict,f.along); for v in &f.variants{ println!("      {} {:?}", v.words, v.form.lines.iter().map(|l|l.residual).collect::<Vec<_>>()); }} } } }
 println!("{:?}",t.elapsed()); 
 match validation::audit::Stationarity::new(&p) {Ok(s)=>{println!("gap {:e}", s.gap); for r in s.readings {println!("{:?}",r);} for r in s.sledge{println!("{r:?}");}}, Err(e)=>println!("{e:#}")}
 println!("{:?}",t.elapsed()); 
 match validation::audit::examples() {Ok(s)=>println!("{s:#?}"), Err(e)=>println!("{e:#}")}
 println!("{:?}",t.elapsed()); 
 match validation::audit::Constants::new() {Ok(s)=>println!("{s:#?}"), Err(e)=>println!("{e:#}")}
 println!("{:?}",t.elapsed()); 
}
