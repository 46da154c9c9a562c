# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A rag of true mass stays cloth as a robot moves it, however often it is controlled."""

from cloth_sim_ros.sim.model.scene_fields import MODES
from cloth_sim_ros.validation.motions import jitter_of
from cloth_sim_ros.validation.motions import MASSES
from cloth_sim_ros.validation.motions import move_rag
from cloth_sim_ros.validation.motions import rag
from cloth_sim_ros.validation.motions import RATES
from cloth_sim_ros.validation.motions import strains
from cloth_sim_ros.validation.robot_paths import DRAG
from cloth_sim_ros.validation.robot_paths import FLING
import numpy as np
import pytest

# Simulated time of a coarse rag by rate [s], so that all runs take seconds.
SHORT = {10.0: 1.3, 100.0: 1.3, 1000.0: 0.3}
# Max. strain of threads and of diagonals [1]. Woven cloth yields in shear; hard edges do not.
MOST_STRAIN = {
    'mass_spring': (0.02, 0.15), 'constraint': (0.01, 0.01), 'adaptive': (0.02, 0.15)}

# Mean along an axis [m/s2]: the grippers' own is up to 0.55, and cloth that shivers has hundreds.
MOST_ACCELERATION = 5.0


@pytest.fixture(params=MODES)
def mode(request):
    """Return each mode."""
    return request.param


def check_stable(motion, mode, rate):
    """Fail where a motion is not that of a cloth."""
    print(f'measured: {motion}')
    assert motion.finite
    stretch, shear = MOST_STRAIN[mode]
    assert motion.stretch < stretch
    assert motion.shear < shear
    assert motion.acceleration(rate) < MOST_ACCELERATION


@pytest.mark.parametrize('rate', RATES)
def test_a_light_rag_takes_a_fling(mode, rate):
    """Light cloth would blow up, stretch or shiver at some rate of control."""
    values = rag(MASSES[0], mode, rate, rows=7, cols=6)
    motion = move_rag(FLING, values, SHORT[rate], rest=0.0)
    check_stable(motion, mode, rate)


@pytest.mark.long
@pytest.mark.parametrize('path, mass, rates', [
    *((FLING, mass, RATES) for mass in MASSES),
    # At 1000 Hz the displacement per step of this path is below float32 rounding.
    (DRAG, MASSES[0], RATES[:2])], ids=['light', 'heavy', 'slow'])
def test_the_whole_motion_is_the_same_at_every_rate(mode, path, mass, rates):
    """Jitter would hide in the motion at one rate, or the rag of docs/notes/motions.md blow up."""
    accelerations = []
    for rate in rates:
        motion = move_rag(path, rag(mass, mode, rate))
        check_stable(motion, mode, rate)
        assert motion.jitter < 3.0 * motion.rigid
        assert motion.swing < 0.2
        accelerations.append(motion.acceleration(rate))
    assert max(accelerations) < 1.5 * min(accelerations)


def test_jitter_is_that_of_the_authors():
    """L_s would be another measure than the one beside it on the page."""
    times = 0.01 * np.arange(50)
    smooth = np.stack([0.5 * 3.0 * times**2, 2.0 * times, np.ones(50)], axis=-1)[:, None, :]
    assert jitter_of(smooth) == pytest.approx(3.0 * 0.01**2 / 9.0)
    shaken = np.zeros((50, 4, 3))
    shaken[::2] = 0.006
    assert jitter_of(shaken) == pytest.approx(0.008 / 2.0)
    mean = (shaken[:-2] + shaken[1:-1] + shaken[2:]) / 3.0
    assert jitter_of(shaken) == pytest.approx(np.abs(mean - shaken[1:-1]).mean())


def test_strain_is_told_apart():
    """The page would report a shear as a stretch of threads, or miss a stretch."""
    rows, cols = np.mgrid[0:4, 0:3].astype(float)
    flat = np.stack([0.1 * cols, 0.2 * rows, 0.0 * rows], axis=-1)
    assert strains(flat, 0.2, 0.6) == pytest.approx((0.0, 0.0), abs=1e-12)
    stretched = flat * (1.0, 1.05, 1.0)
    assert strains(stretched, 0.2, 0.6)[0] == pytest.approx(0.05)
    sheared = flat.copy()
    sheared[..., 0] += 0.3 * 0.2 * rows
    sheared[..., 1] *= np.sqrt(1.0 - 0.3**2)
    stretch, shear = strains(sheared, 0.2, 0.6)
    assert stretch == pytest.approx(0.0, abs=1e-12)
    assert shear == pytest.approx(1.0 - np.sqrt(1.0 - 2.0 * 0.3 * 0.1 * 0.2 / 0.05))
