//! Sorts numbers, pairs of numbers, and indices by a key.
//!
//! Every instance of a sort for another type adds a kilobyte of code or more, so all crates share these.

/// Sorts numbers in ascending order by the total order of IEEE 754: −NaN first, NaN last.
#[inline(never)]
pub fn sort_numbers(numbers: &mut [f64]) {
    numbers.sort_unstable_by(f64::total_cmp);
}

/// Sorts pairs by the first number, and by the second if those are equal.
#[inline(never)]
pub fn sort_pairs(pairs: &mut [(f64, f64)]) {
    pairs.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
}

/// Sorts indices by a key in ascending order, and by index if the keys are equal.
#[inline(never)]
pub fn sort_ranked(ranked: &mut [(f64, usize)]) {
    ranked.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
}

/// Returns the indices below `count` in ascending order of a key; those with equal keys stay in order.
#[inline(never)]
pub fn order_by(count: usize, key: &dyn Fn(usize) -> f64) -> Vec<usize> {
    let mut ranked: Vec<(f64, usize)> = (0..count).map(|index| (key(index), index)).collect();
    sort_ranked(&mut ranked);
    ranked.into_iter().map(|(_, index)| index).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_has_its_place() {
        let mut numbers = [
            f64::NAN,
            2.0,
            f64::INFINITY,
            0.0,
            -0.0,
            -7.5,
            f64::NEG_INFINITY,
        ];
        sort_numbers(&mut numbers);
        let bits = numbers.map(f64::to_bits);
        let expected = [
            f64::NEG_INFINITY,
            -7.5,
            -0.0,
            0.0,
            2.0,
            f64::INFINITY,
            f64::NAN,
        ];
        assert_eq!(bits, expected.map(f64::to_bits));
    }

    #[test]
    fn what_is_the_same_goes_by_what_comes_second() {
        let mut pairs = [(2.0, 1.0), (1.0, 5.0), (2.0, -1.0), (1.0, 4.0)];
        sort_pairs(&mut pairs);
        assert_eq!(pairs, [(1.0, 4.0), (1.0, 5.0), (2.0, -1.0), (2.0, 1.0)]);
        let mut ranked = [(0.5, 3), (0.25, 2), (0.5, 1), (0.25, 0)];
        sort_ranked(&mut ranked);
        assert_eq!(ranked, [(0.25, 0), (0.25, 2), (0.5, 1), (0.5, 3)]);
    }

    #[test]
    fn equal_keys_keep_their_order() {
        let keys = [2.0, -1.0, 2.0, f64::NAN, -1.0];
        assert_eq!(order_by(keys.len(), &|at| keys[at]), [1, 4, 0, 2, 3]);
        assert_eq!(order_by(keys.len(), &|at| -keys[at])[1..], [0, 2, 1, 4]);
    }
}
