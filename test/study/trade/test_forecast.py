# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How long a study of the trade will take."""

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.trade.forecast import EarlyForecast
from cloth_sim_ros.study.trade.forecast import forecast
from cloth_sim_ros.study.trade.grid import default_grid_path
from cloth_sim_ros.study.trade.grid import load_grid
from cloth_sim_ros.study.trade.grid import quick_grid
from made_study import small_grid
from made_study import SOFT

REFERENCE = {
    'refine': [4, 8, 16], 'converged': 1e-3, 'loosely_converged': 1e-3,
    'float64_node_steps': 1e300}


def test_it_grows_with_the_work(tmp_path):
    """A study of an hour would be announced as one of minutes."""
    with ResultsFolder(tmp_path) as results:
        short, long = (
            forecast(Scene(SOFT), small_grid(times=[0.1, end], reference=REFERENCE), results, 1)
            for end in (0.2, 2000.0))
    assert short.runs == long.runs == 6 and not short.is_least
    # Ten thousand times as much is simulated; measurements differ by what else runs here.
    assert long.accuracy > 100.0 * short.accuracy and long.timing > 100.0 * short.timing


def test_what_is_too_slow_to_measure_is_a_bound(tmp_path):
    """A cloth of which no step ends within seconds would hold the forecast up."""
    slow = Scene({**SOFT, 'rows': 1024, 'cols': 1024, 'stiffness.structural': 1e4})
    grid = small_grid(reference={**REFERENCE, 'float64_node_steps': 1.0})
    with ResultsFolder(tmp_path) as results:
        found = forecast(slow, grid, results, 1)
    assert found.is_least and 'more than about' in found.in_words(1)


def test_words():
    """A user would not learn that there is a shorter study."""
    text = EarlyForecast(96, 180.0, 420.0, False).in_words(2, '--quick measures fewer settings')
    assert text == (
        '96 runs in 2 processes take about 3 min, and timing the best of them up to about 7 min; '
        '--quick measures fewer settings')


def test_the_quick_grid_is_a_part_of_the_shipped_one():
    """A quick study would leave a method out, or take as long."""
    whole = load_grid(default_grid_path())
    quick = quick_grid(whole)
    assert {each.method for each in quick.settings} == {each.method for each in whole.settings}
    assert set(map(str, quick.settings)) < set(map(str, whole.settings))
    assert len(quick.settings) == 8 and len(quick.variants) == 1 and len(quick.times) == 2
    # The finest of each method is the reference of its model.
    for method in {each.method for each in whole.settings}:
        last = [each for each in whole.settings if each.method == method][-1]
        assert last in quick.settings
