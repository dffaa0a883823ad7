//! Checks of the statistics against published values and against SciPy 1.x and matplotlib, computed
//! once.

use super::{BoxSummary, Estimate, PairedTest, holm, mean, standard_deviation, t_quantile};

/// Extra hours of sleep with two drugs for ten patients: Student, "The probable error of a mean",
/// Biometrika 6 (1908), the data set `sleep` of R. For `t.test(..., paired = TRUE)`, R's manual
/// gives t = -4.0621, df = 9, p = 0.002833.
const FIRST_DRUG: [f64; 10] = [0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0];
const SECOND_DRUG: [f64; 10] = [1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4];

fn assert_close(found: f64, expected: f64, relative: f64) {
    assert!(
        (found - expected).abs() <= relative * expected.abs(),
        "found {found}, expected {expected}"
    );
}

#[test]
fn students_sleep_experiment_gives_the_published_test() {
    // scipy.stats.ttest_rel(first, second): statistic=-4.062127683382037,
    // pvalue=0.002832890197384273, df=9, confidence_interval() = (-2.459885763276983,
    // -0.7001142367230175)
    let test = PairedTest::of(&FIRST_DRUG, &SECOND_DRUG);
    assert_eq!(test.degrees_of_freedom, 9);
    assert_close(test.t.expect("varies"), -4.062_127_683_382_037, 1e-12);
    assert_close(test.p_value.expect("defined"), 0.002_832_890_197_384_273, 1e-9);
    let (low, high) = test.difference.interval_95().expect("defined");
    assert_close(low, -2.459_885_763_276_983, 1e-9);
    assert_close(high, -0.700_114_236_723_017_5, 1e-9);
    assert_eq!((test.first_larger, test.second_larger), (0, 9));
}

#[test]
fn mean_and_standard_deviation_are_those_of_the_sample() {
    // numpy.mean(first), numpy.std(first, ddof=1)
    assert_close(mean(&FIRST_DRUG), 0.75, 1e-12);
    assert_close(
        standard_deviation(&FIRST_DRUG).expect("ten values"),
        1.789_009_657_759_162_3,
        1e-12,
    );
}

#[test]
fn quantiles_of_students_t_match_scipy() {
    // scipy.stats.t.ppf(0.975, df)
    for (degrees_of_freedom, expected) in [
        (1.0, 12.706_204_736_174_694),
        (2.0, 4.302_652_729_749_462),
        (9.0, 2.262_157_162_798_205),
        (99.0, 1.984_216_951_586_417_4),
        (999.0, 1.962_341_461_133_449_3),
    ] {
        assert_close(t_quantile(0.975, degrees_of_freedom), expected, 1e-9);
    }
}

/// `base + step * ((factor * i) % 100) + slope * i` for i = 0 ... 99: values that any tool can
/// reproduce.
fn made_up(base: f64, step: f64, factor: u32, slope: f64) -> Vec<f64> {
    (0..100u32)
        .map(|i| base + step * f64::from((factor * i) % 100) + slope * f64::from(i))
        .collect()
}

#[test]
fn a_hundred_days_give_the_p_value_of_scipy() {
    // x=[28000+137*((i*37)%100)+0.5*i for i in range(100)]; y=[27000+141*((i*53)%100)-0.25*i for i
    // in range(100)] scipy.stats.ttest_rel(x, y): statistic=1.5094533706744344,
    // pvalue=0.13436800224146808, df=99
    let first = made_up(28_000.0, 137.0, 37, 0.5);
    let second = made_up(27_000.0, 141.0, 53, -0.25);
    let test = PairedTest::of(&first, &second);
    assert_close(test.t.expect("varies"), 1.509_453_370_674_434_4, 1e-9);
    assert_close(test.p_value.expect("defined"), 0.134_368_002_241_468_08, 1e-9);
}

#[test]
fn a_tiny_p_value_keeps_its_digits() {
    // z=[v-1000-10*(i%7) for i, v in enumerate(x)], x as above
    // scipy.stats.ttest_rel(x, z): statistic=509.15559387776824, pvalue=5.019259862275201e-171
    let first = made_up(28_000.0, 137.0, 37, 0.5);
    let second: Vec<f64> =
        first.iter().zip(0u32..).map(|(v, i)| v - 1000.0 - 10.0 * f64::from(i % 7)).collect();
    let test = PairedTest::of(&first, &second);
    assert_close(test.t.expect("varies"), 509.155_593_877_768_24, 1e-9);
    assert_close(test.p_value.expect("defined"), 5.019_259_862_275_201e-171, 1e-6);
}

#[test]
fn exchanging_the_sides_of_a_test_changes_signs_only() {
    let there = PairedTest::of(&FIRST_DRUG, &SECOND_DRUG);
    let back = PairedTest::of(&SECOND_DRUG, &FIRST_DRUG);
    assert_eq!(there.t.map(|t| -t), back.t);
    assert_eq!(there.p_value, back.p_value);
    assert_eq!(there.first_larger, back.second_larger);
}

#[test]
fn a_box_is_that_of_matplotlib() {
    // matplotlib.cbook.boxplot_stats([1, 2, 2.5, 3, 3.5, 4, 5, 20, -9.5])
    let summary = BoxSummary::of(&[1.0, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 20.0, -9.5]).expect("values");
    assert_eq!(
        summary,
        BoxSummary {
            low_whisker: 1.0,
            first_quartile: 2.0,
            median: 3.0,
            third_quartile: 4.0,
            high_whisker: 5.0,
            outliers: vec![-9.5, 20.0],
        }
    );
}

#[test]
fn few_or_equal_values_leave_undefined_numbers_out() {
    assert_eq!(
        Estimate::of(&[]),
        Estimate { mean: 0.0, standard_deviation: None, half_width_95: None }
    );
    assert_eq!(Estimate::of(&[3.0]).interval_95(), None);
    assert_eq!(Estimate::of(&[0.1; 3]).interval_95(), Some((mean(&[0.1; 3]), mean(&[0.1; 3]))));
    assert_eq!(BoxSummary::of(&[]), None);

    let single = PairedTest::of(&[2.0], &[1.0]);
    assert_eq!((single.t, single.p_value, single.degrees_of_freedom), (None, None, 0));
    let same = PairedTest::of(&FIRST_DRUG, &FIRST_DRUG);
    assert_eq!((same.t, same.p_value), (None, Some(1.0)));
    let shifted = PairedTest::of(&[3.0, 4.0, 5.0], &[1.0, 2.0, 3.0]);
    assert_eq!((shifted.t, shifted.p_value), (None, Some(0.0)));
}

proptest::proptest! {
    #[test]
    fn no_finite_values_give_a_number_that_is_not_finite(
        pairs in proptest::collection::vec((-1e9..1e9_f64, -1e9..1e9_f64), 0..40)
    ) {
        let (first, second): (Vec<f64>, Vec<f64>) = pairs.into_iter().unzip();
        let test = PairedTest::of(&first, &second);
        let written = [
            Some(test.difference.mean),
            test.difference.standard_deviation,
            test.difference.half_width_95,
            test.t,
            test.p_value,
        ];
        proptest::prop_assert!(written.into_iter().flatten().all(f64::is_finite));
        proptest::prop_assert!(test.p_value.is_none_or(|p| (0.0..=1.0).contains(&p)));
    }

    #[test]
    fn a_box_holds_its_values_in_order(values in proptest::collection::vec(-1e6..1e6_f64, 1..60)) {
        let summary = BoxSummary::of(&values).expect("at least one value");
        let marks = [
            summary.low_whisker,
            summary.first_quartile,
            summary.median,
            summary.third_quartile,
            summary.high_whisker,
        ];
        proptest::prop_assert!(marks.is_sorted(), "{marks:?}");
        let inside = values.iter().filter(|&&v| v >= marks[0] && v <= marks[4]).count();
        proptest::prop_assert!(inside + summary.outliers.len() <= values.len());
        proptest::prop_assert!(summary.outliers.iter().all(|&v| v < marks[1] || v > marks[3]));
    }
}

/// R: `p.adjust(c(0.01, 0.04, 0.03, 0.005), "holm")`; values that are missing do not count.
#[test]
fn corrected_p_values_are_those_of_holm() {
    let corrected = holm(&[Some(0.01), None, Some(0.04), Some(0.03), Some(0.005)]);
    let expected = [Some(0.03), None, Some(0.06), Some(0.06), Some(0.02)];
    for (found, expected) in corrected.into_iter().zip(expected) {
        assert_eq!(found.is_some(), expected.is_some());
        assert!(found.zip(expected).is_none_or(|(a, b)| (a - b).abs() < 1e-12));
    }
    assert_eq!(holm(&[Some(0.9), Some(0.8)]), [Some(1.0), Some(1.0)], "no p-value is above 1");
}
