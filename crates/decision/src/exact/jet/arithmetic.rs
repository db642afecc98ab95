//! Sums, products and quotients of truncated power series.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::Jet;
use crate::exact::{Coefficient, Exact, Flaw};

impl<C: Coefficient, const N: usize> Add for Jet<C, N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let exact = self.exact.zip(other.exact).and_then(|(a, b)| a.add(b));
        let mut sum = self.combined(&other, self.terms.max(other.terms), exact);
        for k in 0..sum.terms {
            sum.coefficients[k] = self.coefficients[k] + other.coefficients[k];
        }
        sum
    }
}

impl<C: Coefficient, const N: usize> Neg for Jet<C, N> {
    type Output = Self;
    fn neg(self) -> Self {
        let mut negative = Jet { exact: self.exact.map(Exact::neg), ..self };
        for c in &mut negative.coefficients[..self.terms] {
            *c = -*c;
        }
        negative
    }
}

impl<C: Coefficient, const N: usize> Sub for Jet<C, N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<C: Coefficient, const N: usize> Mul for Jet<C, N> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let exact = self.exact.zip(other.exact).and_then(|(a, b)| a.mul(b));
        let mut product = self.combined(&other, self.terms + other.terms - 1, exact);
        // π in a constant would be lost where it meets a coefficient that varies
        let meets = |a: &Self, b: &Self| a.has_pi() && b.terms > 1;
        if meets(&self, &other) || meets(&other, &self) {
            product.flaw = product.flaw.or(Some(Flaw::Pi));
        }
        for k in 0..product.terms {
            let (from, to) = ((k + 1).saturating_sub(other.terms), k.min(self.terms - 1));
            let (a, b) = (&self.coefficients[from..=to], &other.coefficients[k - to..=k - from]);
            product.coefficients[k] = C::convolution(a, b);
        }
        product
    }
}

impl<C: Coefficient, const N: usize> Div for Jet<C, N> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let exact = self.exact.zip(other.exact).and_then(|(a, b)| a.mul(b.recip()?));
        let constant = other.terms == 1;
        let mut quotient = self.combined(&other, if constant { self.terms } else { N }, exact);
        let Some(over) = other.coefficients[0].inverse() else {
            quotient.flaw = quotient.flaw.or(Some(Flaw::Zero));
            return quotient;
        };
        if other.has_pi() || (self.has_pi() && !constant) {
            quotient.flaw = quotient.flaw.or(Some(Flaw::Pi));
        }
        for k in 0..quotient.terms {
            let mut rest = self.coefficients[k];
            if k > 0 && !constant {
                rest = rest - C::convolution(&other.coefficients[1..=k], &quotient.coefficients[..k]);
            }
            quotient.coefficients[k] = rest * over;
        }
        quotient
    }
}
