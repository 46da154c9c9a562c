# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""All cloths, arrows and regions of a picture are inside of what is surveyed."""

from dataclasses import replace
from itertools import product

from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.survey import Box
from cloth_sim_ros.rendering.survey import Extent
from cloth_sim_ros.rendering.survey import region_rings
from cloth_sim_ros.rendering.survey import Survey
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.snapshot import FLAG_AT_LIMIT
from cloth_sim_ros.sim.snapshot import FLAG_GRASPED
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
import numpy as np
import pytest


def test_it_keeps_what_reaches_farthest():
    """The camera would cut off a corner of the cloth in some frame."""
    random = np.random.default_rng(0)
    clouds = [random.normal(size=(50, 60, 3)) + shift for shift in (0.0, 3.0, -1.0)]
    extent = Extent()
    for cloud in clouds:
        extent.add(cloud)
    points = np.concatenate(clouds).reshape(-1, 3)
    np.testing.assert_array_equal(extent.low, points.min(axis=0))
    np.testing.assert_array_equal(extent.high, points.max(axis=0))
    assert extent.size == np.ptp(points, axis=0).max()
    # From any side, all but a sliver is within what was kept.
    sides = random.normal(size=(200, 3))
    sides /= np.linalg.norm(sides, axis=1, keepdims=True)
    missed = (points @ sides.T).max(axis=0) - (extent.points @ sides.T).max(axis=0)
    assert missed.max() < 0.03 * extent.size
    assert len(extent.points) < 300


def test_of_a_fine_cloth_the_corners_are_looked_at():
    """A corner that flies off would be outside the picture."""
    positions = np.zeros((301, 517, 3))
    positions[-1, -1] = (7.0, 8.0, 9.0)
    extent = Extent()
    extent.add_nodes(positions)
    np.testing.assert_array_equal(extent.high, [7.0, 8.0, 9.0])


def test_what_is_not_finite_is_left_out():
    """One lost node would leave the whole picture without a camera."""
    points = np.array([[0.0, 0.0, 0.0], [np.nan, 1.0, 1.0], [1.0, np.inf, 1.0], [1.0, 2.0, 3.0]])
    extent = Extent()
    extent.add(points)
    np.testing.assert_array_equal(extent.high, [1.0, 2.0, 3.0])


def test_the_ring_is_the_outline_of_the_sphere():
    """A reader would see another region than the one that is pushed."""
    axes = Camera(20.0, 40.0).axes
    whole = Push.checked(force=(0.0, 0.0, 1.0), start=0.0, duration=1.0)
    part = Push.checked(
        force=(0.0, 0.0, 1.0), start=0.0, duration=1.0, region='sphere', center=(1.0, 2.0, 3.0),
        radius=0.5)
    ring, = region_rings([whole, part], axes)
    away = ring - part.center
    np.testing.assert_allclose(np.linalg.norm(away, axis=1), 0.5)
    np.testing.assert_allclose(away @ axes[2], 0.0, atol=1e-12)
    np.testing.assert_allclose(ring[0], ring[-1])


def survey_of(*frames):
    """Return the survey of ``frames``."""
    survey = Survey()
    for frame in frames:
        survey.add(frame)
    return survey


def push(*force, start=0.0, **region):
    """Return a push for ten seconds."""
    return Push.checked(force=force, start=start, duration=10.0, **region)


def test_it_tells_what_has_to_be_explained(hanging):
    """The legend would have marks that are not drawn, or lack some that are."""
    frame = hanging()
    survey = survey_of(frame)
    assert len(survey.pins.corners) and not len(survey.limits.corners)
    assert not len(survey.grasps.corners) and not survey.shows_pushes
    frame.records['flags'] = FLAG_PINNED | FLAG_GRASPED
    survey = survey_of(frame)
    assert len(survey.grasps.corners) and not len(survey.pins.corners)
    frame.records['flags'] = FLAG_AT_LIMIT
    survey = survey_of(hanging(pushes=(push(0.0, 0.0, 1.0),)), frame)
    assert len(survey.pins.corners) and len(survey.limits.corners) and survey.shows_pushes


def test_a_box_spans_its_finite_points():
    """A mark at a corner would be sought where none is; a lost node would have no place."""
    box = Box()
    assert box.corners.shape == (0, 3)
    box.add(np.array([[0.0, 5.0, 1.0], [np.nan, 9.0, 9.0]]))
    box.add(np.zeros((0, 3)))
    box.add(np.array([[-1.0, 4.0, 2.0]]))
    assert {tuple(corner) for corner in box.corners} == set(
        product((-1.0, 0.0), (4.0, 5.0), (1.0, 2.0)))


def test_a_level_plane_is_no_collider(hanging):
    """The legend would name a body where only the floor is drawn."""
    level = Collider('plane', 'plane', (), (0.0, 0.0, -1.0), (0.0, 0.0, 0.0, 1.0), 0.3)
    tilted = replace(level, orientation=(0.0, 0.6, 0.0, 0.8))
    assert not survey_of(replace(hanging(), colliders=(level,))).shows_colliders
    assert survey_of(replace(hanging(), colliders=(level, tilted))).shows_colliders


def test_arrows_of_all_frames_have_one_scale(hanging):
    """A weak push would look as strong as another one in the next panel."""
    weak = hanging(pushes=(push(0.0, 1.0, 0.0),))
    strong = hanging(pushes=(push(0.0, 0.0, 4.0), push(2.0, 0.0, 0.0)))
    survey = survey_of(weak, strong)
    lengths = [
        np.linalg.norm(tip - tail) for frame in (weak, strong)
        for tail, tip in survey.arrows(frame)]
    np.testing.assert_allclose(
        lengths, np.array([0.25, 1.0, 0.5]) * survey.arrow_length)


def test_arrows_and_their_words_are_in_view(hanging):
    """A push would point out of the picture."""
    frame = hanging(pushes=(push(0.0, -3.0, 0.0),))
    points = survey_of(frame).points
    tip = survey_of(frame).arrows(frame)[0][1]
    assert points[:, 1].min() < tip[1] < 0.0


def test_a_region_is_in_view_unless_it_is_huge(hanging):
    """Its ring would be cut off, or the cloth be a speck in it."""
    small = push(0.0, 0.0, 1.0, region='sphere', center=(0.5, 0.0, 0.5), radius=0.3)
    huge = push(0.0, 0.0, 1.0, region='sphere', center=(0.5, 0.0, 0.5), radius=30.0)
    assert survey_of(hanging(pushes=(small,))).points[:, 0].max() == 0.8
    assert survey_of(hanging(pushes=(huge,))).points[:, 0].max() < 2.0


def with_ball(frame, x, radius, z=0.5):
    """Return ``frame`` with a ball."""
    return replace(frame, colliders=(Collider(
        'ball', 'sphere', (radius,), (x, 0.0, z), (0.0, 0.0, 0.0, 1.0), 0.3),))


def test_a_body_next_to_the_cloth_is_in_view(hanging):
    """A ball that comes towards the cloth would be cut off, or the cloth be a speck beside it."""
    survey = survey_of(*(with_ball(hanging(), x, 0.1) for x in (0.9, 0.7, 0.7)))
    assert survey.shows_colliders and not survey_of(hanging()).shows_colliders
    assert survey.points[:, 0].max() == pytest.approx(1.0)
    # Where it began is as near as where it is.
    assert survey_of(with_ball(hanging(), 30.0, 0.1)).points[:, 0].max() == 0.5
    assert np.abs(survey_of(with_ball(hanging(), 0.0, 40.0, -40.0)).points).max() < 1.2


def test_the_floor_is_below_bodies(hanging):
    """A table would stand in the floor."""
    assert survey_of(with_ball(hanging(), 0.0, 0.2, -0.2)).floor == pytest.approx(-0.43, abs=0.01)


def test_the_floor_is_below_all_frames(hanging):
    """The cloth would fall through the floor."""
    low = hanging()
    low.records['z'] -= 2.0
    survey = survey_of(hanging(), low)
    assert -2.2 < survey.floor < -2.0
