//! The same data by statsmodels and SciPy: see `statistics_against_python.py`.

use serde_json::Value;
use sprag_studies::statistics::{DemandPoint, Fragility, Level, Observation, PowerLaw, fragility, normal, quantile, student};

/// Largest relative differences, by what was compared.
#[derive(Default)]
struct Differences(Vec<(&'static str, usize, f64, f64)>);

impl Differences {
    /// Notes the difference of `found` from `expected`, of which `allowed` is allowed, relative to `scale`.
    fn note(&mut self, what: &'static str, allowed: f64, (found, expected, scale): (f64, f64, f64)) {
        let difference = ((found - expected) / scale).abs();
        // NaN is no agreement.
        let difference = if found == expected { 0.0 } else { difference };
        let difference = if difference.is_nan() { f64::INFINITY } else { difference };
        match self.0.iter_mut().find(|known| known.0 == what) {
            Some((_, count, most, _)) => (*count, *most) = (*count + 1, most.max(difference)),
            None => self.0.push((what, 1, difference, allowed)),
        }
    }

    fn relative(&mut self, what: &'static str, allowed: f64, found: f64, expected: f64) {
        self.note(what, allowed, (found, expected, expected));
    }
}

#[test]
#[ignore = "needs Python and its packages: run by cargo xtask test"]
fn statsmodels_and_scipy_agree() {
    let reference: Value = serde_json::from_slice(&super::printed("statistics_against_python.py", &[])).unwrap();
    let mut differences = Differences::default();
    let level = Level::new(number(&reference["level"])).unwrap();
    for law in array(&reference["laws"]) {
        compare_law(law, level, &mut differences);
    }
    for runs in array(&reference["fragilities"]) {
        compare_fragility(runs, &mut differences);
    }
    compare_functions(&reference["functions"], &mut differences);
    for (what, count, most, allowed) in &differences.0 {
        eprintln!("{what}: {count} values, largest relative difference {most:.1e}, allowed {allowed:.0e}");
    }
    let beyond: Vec<_> = differences.0.iter().filter(|(_, _, most, allowed)| most > allowed).collect();
    assert!(beyond.is_empty(), "{beyond:?}");
    assert!(differences.0.len() == 14);
}

fn array(value: &Value) -> &Vec<Value> {
    value.as_array().unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    array(value).iter().map(number).collect()
}

fn compare_law(law: &Value, level: Level, differences: &mut Differences) {
    let pairs = numbers(&law["intensity"]).into_iter().zip(numbers(&law["demand"]));
    let points: Vec<DemandPoint> = pairs.map(|(intensity, demand)| DemandPoint { intensity, demand }).collect();
    let found = PowerLaw::fit(&points).unwrap();
    let expected = numbers(&law["coefficients"]);
    // ln a may be next to 0: against its standard error where that is larger.
    let scale = expected[0].abs().max(expected[2]);
    differences.note("ln a", 1e-10, (found.ln_a, expected[0], scale));
    differences.relative("b", 1e-10, found.b, expected[1]);
    differences.relative("standard error of ln a", 1e-10, found.ln_a_standard_error, expected[2]);
    differences.relative("standard error of b", 1e-10, found.b_standard_error, expected[3]);
    differences.relative("R²", 1e-10, found.r_squared.unwrap(), expected[4]);
    differences.relative("dispersion", 1e-10, found.dispersion, expected[5]);
    for ((at, median), prediction) in numbers(&law["at"]).into_iter().zip(array(&law["median"])).zip(array(&law["prediction"])) {
        let (median, prediction) = (numbers(median), numbers(prediction));
        let (own_median, own_prediction) = (found.median_band(at, level), found.prediction_band(at, level));
        let own = [found.median(at), own_median.low, own_median.high, own_prediction.low, own_prediction.high];
        for (own, expected) in own.into_iter().zip(median.into_iter().chain(prediction)) {
            differences.relative("median and bands", 1e-10, own, expected);
        }
    }
}

fn compare_fragility(runs: &Value, differences: &mut Differences) {
    let pairs = numbers(&runs["intensity"]).into_iter().zip(numbers(&runs["overturned"]));
    let observations: Vec<Observation> =
        pairs.map(|(intensity, overturned)| Observation { intensity, overturned: overturned as u32, of: 1 }).collect();
    let Fragility::Estimated(found) = fragility(&observations).unwrap() else { panic!("{runs}") };
    let covariance: Vec<Vec<f64>> = array(&runs["covariance"]).iter().map(numbers).collect();
    for (what, allowed) in [("probit", "μ and β"), ("scoring", "μ and β by Fisher scoring")] {
        let expected = numbers(&runs[what]);
        // μ is the logarithm of an intensity, which may be next to 0: an error of it is one of the median, relative to β.
        differences.note(allowed, 1e-6, (found.mu, expected[0], expected[1]));
        differences.relative(allowed, 1e-6, found.beta, expected[1]);
    }
    for (own, expected) in
        [(found.mu_standard_error, covariance[0][0].sqrt()), (found.beta_standard_error, covariance[1][1].sqrt())]
    {
        differences.relative("standard errors of μ and β", 1e-6, own, expected);
    }
    let scale = (covariance[0][0] * covariance[1][1]).sqrt();
    differences.note("standard errors of μ and β", 1e-6, (found.covariance[0][1], covariance[0][1], scale));
    differences.relative("log-likelihood", 1e-10, found.ln_likelihood, number(&runs["ln_likelihood"]));
}

fn compare_functions(functions: &Value, differences: &mut Differences) {
    for pair in array(&functions["ln_cumulative"]).iter().map(numbers) {
        // Beyond 37 ln Φ(z) is no normal number.
        if pair[0] < 37.0 {
            differences.relative("ln Φ", 1e-12, normal::ln_cumulative(pair[0]), pair[1]);
        }
    }
    for pair in array(&functions["normal_quantile"]).iter().map(numbers) {
        let scale = pair[1].abs().max(1e-3);
        differences.note("quantiles", 1e-12, (normal::quantile(pair[0]), pair[1], scale));
    }
    for triple in array(&functions["student"]).iter().map(numbers) {
        let found = student::central_quantile(triple[0], triple[1] as u32);
        differences.relative("Student's t", 1e-11, found, triple[2]);
    }
    let sample = numbers(&functions["sample"]);
    for pair in array(&functions["quantiles"]).iter().map(numbers) {
        differences.relative("quantiles", 1e-12, quantile::quantile(&sample, pair[0]).unwrap(), pair[1]);
    }
}
