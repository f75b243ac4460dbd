//! Sparse polynomials in the few variables of one clique.

use std::collections::BTreeMap;

/// Largest number of variables of a clique: nodes and states.
pub(super) const VARIABLES: usize = 8;

/// Exponents of a monomial.
pub(super) type Monomial = [u8; VARIABLES];

/// Degree of a monomial.
pub(super) fn degree(monomial: &Monomial) -> u8 {
    monomial.iter().sum()
}

/// All monomials in the first `variables` variables up to a degree, the constant first, by degree.
pub(super) fn monomials(variables: usize, up_to: u8) -> Vec<Monomial> {
    let mut found = vec![[0; VARIABLES]];
    let mut from = 0;
    for _ in 0..up_to {
        let until = found.len();
        for k in from..until {
            // each monomial once: multiply by variables not before its last one
            let last = found[k].iter().rposition(|&e| e > 0).unwrap_or(0);
            for variable in last..variables {
                let mut next = found[k];
                next[variable] += 1;
                found.push(next);
            }
        }
        from = until;
    }
    found
}

/// A sparse polynomial.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Polynomial {
    terms: BTreeMap<Monomial, f64>,
}

impl Polynomial {
    /// The number `c`.
    pub(super) fn constant(c: f64) -> Self {
        Self::term([0; VARIABLES], c)
    }

    /// `coefficient · monomial`.
    pub(super) fn term(monomial: Monomial, coefficient: f64) -> Self {
        Self { terms: BTreeMap::from([(monomial, coefficient)]) }
    }

    /// Variable k, times a number.
    pub(super) fn variable(k: usize, coefficient: f64) -> Self {
        let mut monomial = [0; VARIABLES];
        monomial[k] = 1;
        Self::term(monomial, coefficient)
    }

    /// The terms that are not zero.
    pub(super) fn terms(&self) -> impl Iterator<Item = (&Monomial, f64)> {
        self.terms.iter().map(|(monomial, &coefficient)| (monomial, coefficient)).filter(|term| term.1 != 0.0)
    }

    /// `self + factor · other`.
    pub(super) fn plus(&self, factor: f64, other: &Self) -> Self {
        let mut sum = self.clone();
        for (monomial, coefficient) in &other.terms {
            *sum.terms.entry(*monomial).or_insert(0.0) += factor * coefficient;
        }
        sum
    }

    /// `factor · self`.
    pub(super) fn scaled(&self, factor: f64) -> Self {
        Self::default().plus(factor, self)
    }

    /// The product.
    pub(super) fn times(&self, other: &Self) -> Self {
        let mut product = Self::default();
        for (m, x) in &self.terms {
            for (n, y) in &other.terms {
                let monomial = std::array::from_fn(|k| m[k] + n[k]);
                *product.terms.entry(monomial).or_insert(0.0) += x * y;
            }
        }
        product
    }

    /// `1 − self²`: not negative where `|self| ≤ 1`.
    pub(super) fn slack(&self) -> Self {
        Self::constant(1.0).plus(-1.0, &self.times(self))
    }

    /// Largest value that `|self|` can take where every variable is in [−1, 1]: the sum of the coefficients' sizes.
    pub(super) fn bounds(&self) -> f64 {
        self.terms.values().map(|coefficient| coefficient.abs()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pad(exponents: [u8; 2]) -> Monomial {
        std::array::from_fn(|k| exponents.get(k).copied().unwrap_or(0))
    }

    #[test]
    fn monomials_are_counted_by_the_binomial_coefficient() {
        assert_eq!(monomials(4, 4).len(), 70);
        assert_eq!(monomials(3, 4).len(), 35);
        assert_eq!(monomials(2, 2), [[0, 0], [1, 0], [0, 1], [2, 0], [1, 1], [0, 2]].map(pad));
        assert_eq!(monomials(0, 4).len(), 1);
    }

    #[test]
    fn products_expand() {
        let (x, y) = (Polynomial::variable(0, 1.0), Polynomial::variable(1, 2.0));
        let product = x.plus(1.0, &y).times(&x.plus(-1.0, &y));
        let terms: Vec<_> = product.terms().collect();
        assert_eq!(terms, [(&pad([0, 2]), -4.0), (&pad([2, 0]), 1.0)], "(x + 2y)(x − 2y)");
        assert_eq!(x.plus(1.0, &y).bounds(), 3.0);
    }
}
