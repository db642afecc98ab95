//! Numbers, and their images in fields of `p` elements.

use decision::exact::{Coefficient, Dual, Entry, Exact, FIELDS, Flaw, Jet, Modular, PARTS, in_field};
use symbolic::{Fraction, Graph, Scalar};

#[expect(clippy::approx_constant, reason = "decimals as a scene has them")]
#[test]
fn numbers_are_read_as_they_are_written() {
    assert_eq!(Exact::of(0.05).ok(), Exact::ratio(1, 20));
    assert_eq!(Exact::of(-1.5e3).ok(), Exact::ratio(-1500, 1));
    assert_eq!(Exact::of(1.5707963267948966), Err(Flaw::Rounded));
    assert_eq!(Exact::of(1.0471975511965976), Err(Flaw::Rounded));
    assert_eq!(Exact::of(1.5708).ok().and_then(|x| x.recip()), Exact::ratio(2500, 3927));
    let read = |text: &str| {
        let g = Graph::new();
        Exact::of_formula(g.as_fraction(g.parse(text, &|_: &str| None).unwrap()).unwrap())
    };
    assert_eq!(Exact::of(2.5e-60).map(|x| x.to_string()), Ok("1/(4*10^59)".into()));
    let of = |n, d, turns| Ok(Exact { turns, ..Exact::ratio(n, d).unwrap() });
    assert_eq!(read("30*pi/180"), of(0, 1, PARTS / 6));
    assert_eq!(read("pi + 1/3"), of(1, 3, PARTS));
    assert_eq!(read("0.2 - 7*pi/12"), of(1, 5, -7 * PARTS / 12));
    assert_eq!(read("pi/17"), Err(Flaw::Turn));
    assert_eq!(read("1/pi"), Err(Flaw::Pi));
    assert_eq!(
        read("pi + 1/3").ok().and_then(|x| x.checked_mul(Exact::ratio(1, 2)?)).map(|x| x.turns),
        Some(PARTS / 2)
    );
}

fn ratio(n: i128, d: i128) -> Exact {
    Exact::ratio(n, d).unwrap()
}

#[test]
fn images_obey_the_laws_of_their_numbers() {
    for field in &FIELDS {
        in_field(field, laws);
    }
}

fn laws() {
    assert_eq!(Modular::root_of_unity(PARTS / 2).power(2), -Modular::one());
    let (order, circle, neper) = Modular::exponents();
    for exponent in [0, 1, 255, 256, 271_828, order - 1] {
        let x = ratio(exponent.into(), 1);
        // e^{ix} = cos x + i sin x
        let (sine, cosine) = Modular::sine_and_cosine(x).unwrap();
        let along_circle = cosine + Modular::root_of_unity(PARTS / 2) * sine;
        assert_eq!(along_circle, Modular::new(circle).power(exponent));
        assert_eq!(Modular::exponential(x).unwrap(), Modular::new(neper).power(exponent));
    }
    assert_eq!(Modular::integer(-5) + Modular::integer(5), Modular::ZERO);
    assert_eq!(Modular::integer(1 << 90), Modular::new(1 << 45) * Modular::new(1 << 45));
    assert_eq!(Modular::root_of_unity(PARTS), -Modular::one());
    let of_turns = |turns| Modular::sine_and_cosine(Exact { turns, ..Exact::ZERO }).unwrap();
    let (sine, cosine) = Modular::sine_and_cosine(ratio(3, 10)).unwrap();
    assert_eq!(sine * sine + cosine * cosine, Modular::one());
    assert_eq!(Modular::sine_and_cosine(ratio(3, 5)).unwrap().0, Modular::new(2) * sine * cosine);
    let root = |n, d| Modular::root(ratio(n, d)).unwrap().0;
    // roots are those of the angles: sin 60° = √3/2, cos 45° = √2/2, 4 cos 36° = 1 + √5
    assert_eq!(of_turns(PARTS / 3).0 * Modular::new(2), root(3, 1));
    assert_eq!(of_turns(PARTS / 3).1 * Modular::new(2), Modular::one());
    assert_eq!(of_turns(PARTS / 4).1 * Modular::new(2), root(2, 1));
    assert_eq!(of_turns(PARTS / 5).1 * Modular::new(4), root(5, 1) + Modular::one());
    // tan(3π/11) + 4 sin(2π/11) = √11
    let (sine, cosine) = of_turns(3 * PARTS / 11);
    assert_eq!(sine * cosine.inverse().unwrap() + Modular::new(4) * of_turns(2 * PARTS / 11).0, root(11, 1));
    for square in [7, 13, 17, 47, 77, 94] {
        assert_eq!(root(square, 1) * root(square, 1), Modular::integer(square));
    }
    assert_eq!(root(2, 1) * root(3, 1), root(6, 1));
    assert_eq!(Modular::root(ratio(16, 25)).unwrap().1, Some(ratio(4, 5)));
    let exponential = |n, d| Modular::exponential(ratio(n, d)).unwrap();
    assert_eq!(exponential(1, 2) * exponential(1, 3), exponential(5, 6));
}

#[test]
fn numbers_of_any_size_have_their_images() {
    let decimal = |text: &str| Exact::rational(Fraction::decimal(text).unwrap());
    let image = |text: &str| Modular::fraction(decimal(text)).unwrap();
    assert_eq!(image("3e-45") * image("7e30") * image("1e15"), Modular::new(21));
    assert_eq!(Modular::root(decimal("4e-54")).unwrap().1, Some(decimal("2e-27")));
    let (root, none) = Modular::root(decimal("3e-45")).unwrap();
    assert_eq!((root * root, none), (image("3e-45"), None));
    let small = |text: &str| Modular::exponential(decimal(text)).unwrap();
    assert_eq!(small("1e-40").power(10), small("1e-39"));
    assert_eq!(image("-2.5e-27").small_fraction(), Some(decimal("-2.5e-27")));
    assert_eq!(image("-2.5e-27").small_fraction_near(2.5e-27), Some(decimal("-2.5e-27")));
    assert_eq!(image("7e12").small_fraction_near(7e12), Some(decimal("7e12")));
    assert_eq!(image("123.456789").small_fraction_near(123.456789), None);
}

#[test]
fn multiples_of_rows_are_subtracted_one_as_the_other() {
    let element = |i: u64| Modular::new(Modular::prime() - 1 - i * i);
    let rows: Vec<Modular> = (0..19 * 5).map(element).collect();
    let factors: Vec<Modular> = (0..19).map(|i| if i % 4 == 3 { Modular::ZERO } else { element(40 + i) }).collect();
    let mut into: Vec<Modular> = (0..5).map(|j| Modular::new(3 * j)).collect();
    let mut plain = into.clone();
    for (factor, row) in factors.iter().zip(rows.chunks_exact(5)) {
        plain.iter_mut().zip(row).for_each(|(x, y)| *x = *x - *factor * *y);
    }
    <Modular as Entry>::subtract_multiples(&mut into, &factors, &rows);
    assert_eq!(into, plain);
}

#[test]
fn convolutions_are_sums_of_products() {
    let a: Vec<Modular> = (0..19).map(|i| Modular::new(Modular::prime() - 1 - i)).collect();
    let b: Vec<Modular> = (0..19).map(|i| Modular::new(Modular::prime() - 7 - i * i)).collect();
    let plain = (0..19).fold(Modular::ZERO, |sum, i| sum + a[i] * b[18 - i]);
    assert_eq!(<Modular as Coefficient>::convolution(&a, &b), plain);
}

fn at(x: Exact) -> Jet<Dual> {
    Jet::constant(Dual::variable(Modular::of(x).unwrap()), Some(x))
}

fn value(n: i128, d: i128) -> Modular {
    Modular::of(Exact::ratio(n, d).unwrap()).unwrap()
}

/// Against derivatives by hand, at 9/4 and at 1.
#[test]
fn slopes_are_derivatives() {
    in_field(&FIELDS[1], || {
        let x = at(Exact::ratio(9, 4).unwrap());
        let slope = |y: Jet<Dual>| (y.coefficient(0).slope, y.flaw());
        let one = Jet::<Dual>::from_f64(1.0);
        assert_eq!(slope(x.sqrt()), (value(1, 3), None));
        assert_eq!(slope(one / x), (value(-16, 81), None));
        assert_eq!(slope(x * x * x), (value(243, 16), None));
        let (sine, cosine) = x.sin_cos();
        assert_eq!(slope(sine), (cosine.coefficient(0).value, None));
        assert_eq!(slope(cosine), (-sine.coefficient(0).value, None));
        assert_eq!(slope(x.tan() * cosine * cosine).0, slope(sine * cosine).0);
        assert_eq!(slope(x.exp()).0, x.exp().coefficient(0).value);
        let unit = at(Exact::ONE);
        assert_eq!(slope(unit.log()), (Modular::one(), None));
        assert_eq!(slope(unit.powf(Jet::of(2.5))), (value(5, 2), None));
        let zero = at(Exact::ZERO);
        assert_eq!(slope(zero.acos()).0, -Modular::one());
        assert_eq!(slope(zero.atan()), (Modular::one(), None));
        assert!(slope(unit.acos()).1.is_some() && slope(zero.sqrt()).1.is_some());
    });
}
