# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The exponent of a power law is fitted with its standard error."""

from cloth_sim_ros.study.growth import fit_growth
from cloth_sim_ros.study.growth import Growth
import numpy as np
import pytest
from scipy.stats import linregress


@pytest.mark.parametrize('power', [-1.0, 0.0, 1.0, 1.5, 2.0])
def test_a_power_law_is_found(power):
    """A quadratic cost would be reported with another exponent."""
    sizes = np.array([144.0, 196.0, 256.0, 400.0])
    growth = fit_growth(sizes, 3e-7 * sizes**power)
    assert growth.exponent == pytest.approx(power, abs=1e-12)
    assert growth.error == pytest.approx(0.0, abs=1e-12)


def test_exponent_and_error_are_those_of_linear_regression():
    """The uncertainty of an exponent would not match the scatter of its points."""
    random = np.random.default_rng(4)
    sizes = np.geomspace(10.0, 1e6, 9)
    costs = sizes**1.3 * np.exp(0.2 * random.normal(size=9))
    expected = linregress(np.log(sizes), np.log(costs))
    growth = fit_growth(sizes, costs)
    assert growth.exponent == pytest.approx(expected.slope)
    assert growth.error == pytest.approx(expected.stderr)


def test_two_sizes_have_an_exponent_without_an_error():
    """A line through two points would be reported without uncertainty."""
    assert fit_growth([10.0, 20.0], [1.0, 4.0]) == Growth(pytest.approx(2.0), None)
    assert str(Growth(2.0)) == '2.00'
    assert str(Growth(2.0, 0.125)) == '2.00 ± 0.12'


def test_one_size_has_none():
    """A single run would divide by zero."""
    assert fit_growth([10.0, 10.0], [1.0, 2.0]) is None
    assert fit_growth([], []) is None
