//! Short loops over numbers, compiled for the wide registers that most processors have as well as for those that all have.
//!
//! Every operation is the one that is written, in its order and rounded as it is there: results are the same in both. What
//! widening changes is only how many are done at a time.

/// Defines a function that runs with registers of four numbers where the processor has them. What it calls, if it is not
/// `#[inline(always)]`, stays as narrow as the rest of the program.
macro_rules! wide {
    ($($(#[$meta:meta])* $vis:vis fn $name:ident($($arg:ident: $ty:ty),*) $(-> $out:ty)? $body:block)*) => {$(
        $(#[$meta])*
        $vis fn $name($($arg: $ty),*) $(-> $out)? {
            #[inline(always)]
            fn kernel($($arg: $ty),*) $(-> $out)? $body
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2")]
                fn widened($($arg: $ty),*) $(-> $out)? {
                    kernel($($arg),*)
                }
                if std::arch::is_x86_feature_detected!("avx2") {
                    // SAFETY: the processor has what the function is compiled for.
                    return unsafe { widened($($arg),*) };
                }
            }
            kernel($($arg),*)
        }
    )*};
}

pub(crate) use wide;

#[cfg(test)]
mod tests {
    wide! {
        /// x less the products of a and b, and their sum.
        fn less(x: &mut [f64], a: &[f64], b: f64) -> f64 {
            x.iter_mut().zip(a).for_each(|(x, a)| *x -= a * b);
            x.iter().zip(a).map(|(x, a)| x * a).sum()
        }
    }

    #[test]
    fn every_digit_is_that_of_one_number_at_a_time() {
        for n in 0..23 {
            let a: Vec<f64> = (0..n).map(|i| (1.0 + f64::from(i)).sin()).collect();
            let start: Vec<f64> = a.iter().map(|a| 1.0 / (a + 2.0)).collect();
            let mut wide = start.clone();
            let sum = less(&mut wide, &a, 0.1);
            let mut expected = 0.0;
            for (i, x) in start.iter().enumerate() {
                let x = std::hint::black_box(x - std::hint::black_box(a[i] * 0.1));
                assert_eq!(wide[i].to_bits(), x.to_bits());
                expected += std::hint::black_box(x * a[i]);
            }
            assert_eq!(sum, expected);
        }
    }
}
