//! Fractions of any decimal exponent.

use symbolic::Fraction;

fn decimal(text: &str) -> Fraction {
    Fraction::decimal(text).unwrap()
}

#[test]
fn products_of_units_are_exact() {
    let (a, b) = (decimal("3e-45"), decimal("4e45"));
    assert_eq!(a.checked_mul(b), Fraction::new(12, 1));
    assert_eq!(a.recip().unwrap().checked_mul(Fraction::new(3, 1).unwrap()), Some(decimal("1e45")));
    assert_eq!(decimal("1.5e-60").checked_add(decimal("2.5e-60")), Some(decimal("4e-60")));
    assert_eq!(decimal("1e-60").checked_add(decimal("1")), None);
    let third = Fraction::new(1, 3).unwrap().checked_mul(decimal("1e-50")).unwrap();
    assert_eq!(third.checked_add(third).and_then(|x| x.checked_add(third)), Some(decimal("1e-50")));
    assert_eq!(third.powi(-3), Fraction::new(27, 1).and_then(|x| x.checked_mul(decimal("1e150"))));
    assert_eq!(third.checked_add(third.minus()), Some(Fraction::ZERO));
    // one way to be written, wherever it comes from
    assert_eq!(decimal("1e-40").checked_mul(decimal("1e20")), Fraction::new(1, 10_i128.pow(20)));
}

#[test]
fn floats_of_decimals_are_the_nearest() {
    for text in ["1e-24", "7e25", "9.81e-45", "123456789012345e-60", "1e300", "5e-324", "2.5e33"] {
        assert_eq!(decimal(text).to_f64().to_bits(), text.parse::<f64>().unwrap().to_bits(), "{text}");
    }
    assert_eq!(decimal("1e-400").to_f64(), 0.0);
    let third = Fraction::new(1, 3).unwrap().checked_mul(decimal("1e-50")).unwrap().to_f64();
    assert!((third / (1e-50 / 3.0) - 1.0).abs() < 1e-14, "{third}");
    assert_eq!(Fraction::new(2, 1).unwrap().powi(-2000).unwrap().to_f64(), 0.0);
}

#[test]
fn text_is_read_back() {
    assert_eq!(decimal("7e-45").to_string(), "7/10^45");
    assert_eq!(decimal("-7e-45").checked_mul(Fraction::new(1, 3).unwrap()).unwrap().to_string(), "-7/(3*10^45)");
    assert_eq!(decimal("2.5e45").to_string(), "25*10^44");
    assert_eq!(decimal("1.5e-45").to_string(), "3/(2*10^45)");
    assert_eq!(Fraction::new(1, 3).unwrap().to_string(), "1/3");
    assert_eq!(Fraction::new(3, 2).unwrap().powi(200).unwrap_or(Fraction::ONE), Fraction::ONE);
    assert_eq!(Fraction::new(1, 2).unwrap().powi(200).unwrap().to_string(), "1/2^200");
}
