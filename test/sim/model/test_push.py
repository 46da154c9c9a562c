# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A push is checked when it is made, and acts for exactly its duration."""

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.push import Push
from hypothesis import given
from hypothesis import strategies
import numpy as np
import pytest

_GOOD = {'force': (0.0, 0.0, 1.0), 'start': 0.0, 'duration': 0.1}
_NAN, _INF = float('nan'), float('inf')


@pytest.mark.parametrize(('changed', 'message'), [
    ({'force': (_NAN, 0.0, 0.0)}, 'the force of a push must be 3 finite numbers [N], got [nan'),
    ({'force': (0.0, _INF, 0.0)}, 'the force of a push must be 3 finite numbers'),
    ({'force': (1.0, 2.0)}, 'must be 3 finite numbers [N], got [1.0, 2.0]: give x, y and z'),
    ({'force': (0.0, 0.0, 1e38)},
     'the force of a push must be at most 1e+30 N along each axis, got'),
    ({'duration': _NAN}, 'the duration of a push must be above 0 and at most 1e+09 s, got nan s'),
    ({'duration': -1.0}, 'the duration of a push must be above 0 and at most 1e+09 s, got -1.0 s'),
    ({'duration': _INF}, 'the duration of a push must be above 0 and at most 1e+09 s, got inf s'),
    ({'duration': 1e200},
     'the duration of a push must be above 0 and at most 1e+09 s, got 1e+200 s'),
    ({'start': _NAN}, 'the start of a push must be from 0 to 1e+09 s, got nan s'),
    ({'start': 1e300}, 'the start of a push must be from 0 to 1e+09 s, got 1e+300 s'),
    ({'region': 'sphere', 'radius': -0.1},
     'the radius of a push must be from 0 to 1e+06 m, got -0.1'),
    ({'region': 'sphere', 'radius': _NAN},
     'the radius of a push must be from 0 to 1e+06 m, got nan'),
    ({'region': 'sphere', 'radius': 1e200}, 'must be from 0 to 1e+06 m, got 1e+200 m: give it in'),
    ({'region': 'sphere', 'radius': 1.0, 'center': (0.0, 1e200, 0.0)},
     'the center of a push must be at most 1e+06 m along each axis'),
    ({'region': 'sphere'}, 'a push on a sphere needs a radius above 0'),
    ({'region': 'sphere', 'radius': 1.0, 'center': (0.0, 0.0, _INF)}, 'the center of a push'),
    ({'region': 'cube'}, "a push needs the region all or sphere, got 'cube'"),
])
def test_bad_values_are_refused(changed: dict, message: str):
    """A NaN force would turn the whole cloth into NaN."""
    with pytest.raises(ClothSimError) as caught:
        Push.checked(**{**_GOOD, **changed})
    assert message in str(caught.value)


@given(
    start=strategies.floats(0.0, 2.0), duration=strategies.floats(1e-3, 2.0),
    dt=strategies.floats(1e-3, 0.5))
def test_overlaps_add_up_to_the_duration(start: float, duration: float, dt: float):
    """The impulse of a push would depend on dt."""
    push = Push.checked(force=(0.0, 0.0, 1.0), start=start, duration=duration)
    times = np.arange(0, int(np.ceil(push.end / dt)) + 2) * dt
    shares = [push.overlap(begin, end) for begin, end in zip(times[:-1], times[1:])]
    assert sum(shares) * dt == pytest.approx(duration, rel=1e-9)
    assert min(shares) >= 0.0
    assert max(shares) <= 1.0 + 1e-12


@given(
    number=strategies.integers(0, 10**6), substeps=strategies.integers(1, 200),
    dt=strategies.floats(1e-4, 0.1))
def test_push_at_the_next_step_does_not_act_in_this_one(
        number: int, substeps: int, dt: float):
    """A push would act in this step or not by rounding, and runs would not be repeatable."""
    push = Push.checked(force=(0.0, 0.0, 1.0), start=(number + 1) * dt, duration=1.0)
    length = dt / substeps
    last = number * dt + (substeps - 1) * length
    assert push.overlap(last, last + length) == 0.0
    assert push.overlap(push.start, push.start + length) == pytest.approx(1.0)
