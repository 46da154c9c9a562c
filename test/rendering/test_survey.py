# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What all panels have in common."""

from cloth_sim_ros.rendering.survey import Survey
from cloth_sim_ros.sim.push import Push
from cloth_sim_ros.sim.snapshot import FLAG_AT_LIMIT
import numpy as np


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
    """The legend would tell of marks that are nowhere, or not of some that are."""
    frame = hanging()
    survey = survey_of(frame)
    assert survey.shows_pins and not survey.shows_limits and not survey.shows_pushes
    frame.records['flags'] = FLAG_AT_LIMIT
    survey = survey_of(hanging(pushes=(push(0.0, 0.0, 1.0),)), frame)
    assert survey.shows_pins and survey.shows_limits and survey.shows_pushes


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


def test_the_floor_is_below_all_frames(hanging):
    """The cloth would fall through the floor."""
    low = hanging()
    low.records['z'] -= 2.0
    survey = survey_of(hanging(), low)
    assert -2.2 < survey.floor < -2.0
