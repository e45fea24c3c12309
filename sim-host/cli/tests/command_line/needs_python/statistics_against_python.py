#!/usr/bin/env python3
"""Demand regressions and fragilities by statsmodels and SciPy, of data sets made from a seed, as JSON for `statistics.rs`.

    laws          ln D = ln a + b ln IM by sm.OLS, with the bands of get_prediction
    fragilities   P = Φ((ln IM − μ)/β) by sm.Probit, by Newton's method, and by sm.GLM with the binomial family and Fisher
                  scoring; errors of (μ, β) from those of the intercept and the slope by the delta method
    functions     scipy.special.log_ndtr and ndtri, scipy.stats.t.ppf, numpy.quantile
"""

from __future__ import annotations

import argparse
import json
import sys
from typing import Any

import numpy as np
import statsmodels.api as sm
from scipy import special, stats

LEVEL = 0.9


def law(rng: Any, number: int, dispersion: float, unit: float) -> dict[str, Any]:
    """A power law with its fit."""
    x = rng.normal(np.log(unit), 0.7, number)
    y = -0.4 + 1.3 * (x - np.log(unit)) + dispersion * rng.standard_normal(number)
    intensity, demand = np.exp(x), np.exp(y)
    x, y = np.log(intensity), np.log(demand)
    fit = sm.OLS(y, sm.add_constant(x)).fit()
    at = np.array([0.2, 1.0, 3.0]) * unit
    band = fit.get_prediction(np.column_stack([np.ones(3), np.log(at)])).summary_frame(alpha=1 - LEVEL)
    return {
        "intensity": intensity.tolist(),
        "demand": demand.tolist(),
        "coefficients": [*fit.params, *fit.bse, fit.rsquared, fit.mse_resid**0.5],
        "at": at.tolist(),
        "median": np.exp(band[["mean", "mean_ci_lower", "mean_ci_upper"]].to_numpy()).tolist(),
        "prediction": np.exp(band[["obs_ci_lower", "obs_ci_upper"]].to_numpy()).tolist(),
    }


def has_maximum(x: Any, z: Any) -> bool:
    """Whether the outcomes overlap and overturning becomes likelier."""
    if z.min() == z.max() or x[z == 0].max() <= x[z == 1].min() or x[z == 1].max() <= x[z == 0].min():
        return False
    return bool(x[z == 1].mean() > x[z == 0].mean())


def lognormal(params: Any, covariance: Any) -> tuple[list[float], list[list[float]]]:
    """(μ, β) and their covariance, of an intercept and a slope."""
    intercept, slope = params
    jacobian = np.array([[-1 / slope, intercept / slope**2], [0, -1 / slope**2]])
    return [-intercept / slope, 1 / slope], (jacobian @ covariance @ jacobian.T).tolist()


def fragility(rng: Any, number: int, beta: float, stripes: int) -> dict[str, Any]:
    """Runs, with 0 stripes as a cloud, and the fit to them."""
    while True:
        x = rng.uniform(-1, 1.5, number)
        if stripes:
            x = np.linspace(-1, 1.5, stripes)[np.arange(number) % stripes]
        intensity = np.exp(x)
        x = np.log(intensity)
        z = (rng.uniform(size=number) < special.ndtr((x - 0.2) / beta)).astype(int)
        if has_maximum(x, z):
            break
    design = sm.add_constant(x)
    probit = sm.Probit(z, design).fit(method="newton", tol=1e-14, maxiter=500, disp=0)
    family = sm.families.Binomial(link=sm.families.links.Probit())
    scoring = sm.GLM(z, design, family=family).fit(tol=1e-15, tol_criterion="params", maxiter=500)
    estimates, covariance = lognormal(probit.params, probit.cov_params())
    return {
        "intensity": intensity.tolist(),
        "overturned": z.tolist(),
        "probit": estimates,
        "covariance": covariance,
        "ln_likelihood": probit.llf,
        "scoring": lognormal(scoring.params, np.eye(2))[0],
    }


def functions(rng: Any) -> dict[str, Any]:
    """Distributions and quantiles."""
    deviates = np.linspace(-40, 40, 161)
    probabilities = np.concatenate([10.0 ** -np.arange(1, 301, 13), np.linspace(0.01, 0.99, 50)])
    freedoms = [1, 2, 3, 7, 28, 198, 1998, 99998]
    levels = [0.5, 0.9, 0.95, 0.99]
    sample = rng.standard_normal(101)
    shares = np.linspace(0, 1, 23)
    return {
        "ln_cumulative": list(zip(deviates.tolist(), special.log_ndtr(deviates).tolist())),
        "normal_quantile": list(zip(probabilities.tolist(), special.ndtri(probabilities).tolist())),
        "student": [(level, freedom, float(stats.t.isf((1 - level) / 2, freedom))) for level in levels for freedom in freedoms],
        "sample": sample.tolist(),
        "quantiles": list(zip(shares.tolist(), np.quantile(sample, shares).tolist())),
    }


def results(seed: int) -> dict[str, Any]:
    """Everything."""
    rng = np.random.default_rng(seed)
    clouds = [(number, beta, 0) for number in (25, 200, 3000) for beta in (0.15, 0.5, 1.5) for _ in range(5)]
    striped = [(number, beta, stripes) for number, stripes in ((60, 6), (2000, 20)) for beta in (0.3, 0.8) for _ in range(3)]
    laws = [(n, s, unit) for n in (3, 10, 200, 5000) for s in (0.01, 0.4, 2.0) for unit in (1.0, 1e-5, 981.0)]
    return {
        "level": LEVEL,
        "laws": [law(rng, *of) for of in laws],
        "fragilities": [fragility(rng, *of) for of in clouds + striped],
        "functions": functions(rng),
    }


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=2019)
    options = parser.parse_args()
    json.dump(results(options.seed), sys.stdout)


if __name__ == "__main__":
    main()
