//! The shortest sequence of calls that still goes wrong.

/// Leaves out as many calls as can be left out while `fails` holds: halves first, then quarters, down to
/// single ones (Zeller's delta debugging, complements only).
pub fn shrink<T: Clone>(calls: &[T], mut fails: impl FnMut(&[T]) -> bool) -> Vec<T> {
    let mut left = calls.to_vec();
    let mut size = left.len().div_ceil(2);
    while size > 0 {
        let mut start = 0;
        while start < left.len() {
            let end = (start + size).min(left.len());
            let without = [&left[..start], &left[end..]].concat();
            if fails(&without) {
                left = without;
            } else {
                start = end;
            }
        }
        size = if size == 1 { 0 } else { size.div_ceil(2) };
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_matters_is_left() {
        let calls: Vec<u32> = (0..250).collect();
        let left = shrink(&calls, |calls| [3, 77, 249].iter().all(|wanted| calls.contains(wanted)));
        assert_eq!(left, [3, 77, 249]);
        assert!(shrink(&calls, |_| true).is_empty());
    }
}
