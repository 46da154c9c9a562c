# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A choice replaces the built-in one when it wins always, by the times that it is given."""

from collections.abc import Iterator

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.device.tuning import BUILT_IN
from cloth_sim_ros.sim.device.tuning import Choice
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.layout_tuning import tune
import pytest

BASELINE = Choice('texture', 4)


@pytest.fixture(scope='module')
def context() -> Iterator[Context]:
    """Lend a software device, for which the built-in choice is known."""
    context = Context(single_thread=True)
    if not context.is_software:
        pytest.skip('the built-in choice is that of a software device')
    yield context
    context.close()


class Times:
    """
    Wall times by choice, without a step being made.

    :param speeds: of choices that differ from 1 [steps/s]
    :param slow: the speed of a choice from a number of turns on
    """

    def __init__(
            self, speeds: dict[Choice, float],
            slow: tuple[Choice, int, float] | None = None) -> None:
        """Begin before the first turn."""
        self.speeds = speeds
        self.slow = slow
        self.calls: list[tuple[Choice, int, bool]] = []

    def __call__(self, run: Simulation, steps: int) -> float:
        """Return the time of a turn [s]."""
        choice = run.layout.choice
        self.calls.append((choice, steps, run.scene.has_rigidity))
        speed = self.speeds.get(choice, 1.0)
        if self.slow and self.slow[0] == choice and self.turns(choice) > self.slow[1]:
            speed = self.slow[2]
        return steps / speed

    def turns(self, choice: Choice, *, bends: bool | None = None) -> int:
        """Return how many times a choice was timed, with cloths that bend or do not."""
        return sum(
            called == choice and bends in (None, has_rigidity)
            for called, _, has_rigidity in self.calls)


def found(context: Context, times: Times, rounds: int = 3):
    """Return what is found for a small cloth."""
    size, = tune(context, [20], rounds, times)
    assert size.built_in == BASELINE and len(size.rivals) == 5
    return size


def test_what_wins_always_is_chosen(context):
    """The measurement would be for nothing."""
    size = found(context, Times({Choice('storage', 2): 2.0, Choice('texture', 1): 1.5}))
    assert size.choice == Choice('storage', 2)
    winner = next(rival for rival in size.rivals if rival.choice == size.choice)
    # Three rounds with each of the two cloths.
    assert winner.ratios == pytest.approx([2.0] * 6)
    assert 'replaced by storage loads, block 2' in size.in_words()
    assert size.as_dict()['choice'] == {'loads': 'storage', 'block': 2}


@pytest.mark.parametrize('speed', [0.5, 1.0, 1.02])
def test_what_is_no_faster_is_not_chosen(context, speed):
    """Noise would decide, and another measurement would choose otherwise."""
    times = Times({Choice(loads, block): speed for loads in ('texture', 'storage')
                   for block in (1, 2, 4)} | {BASELINE: 1.0})
    size = found(context, times)
    assert size.choice == BUILT_IN
    assert all(rival.is_out and len(rival.ratios) == 1 for rival in size.rivals)
    assert 'built-in texture loads, block 4, kept' in size.in_words()


def test_a_single_lost_round_is_enough(context):
    """What is faster now and then would be chosen."""
    rival = Choice('texture', 2)
    plain = Times({rival: 2.0})
    assert found(context, plain).choice == rival
    lucky = Times({rival: 2.0}, slow=(rival, plain.turns(rival) - 1, 1.0))
    # In the last turn, the repetitions before the slow one count.
    assert found(context, lucky).choice == rival
    late = Times({rival: 2.0}, slow=(rival, plain.turns(rival) - 3, 1.0))
    assert found(context, late).choice == BUILT_IN


def test_what_wins_with_one_cloth_alone_is_not_chosen(context):
    """Springs would be stepped faster, and the default fabric slower than before."""
    rival = Choice('texture', 1)
    with_springs = Times({rival: 2.0})
    found(context, with_springs)
    count = with_springs.turns(rival, bends=False)
    assert 0 < count < with_springs.turns(rival)
    times = Times({rival: 2.0}, slow=(rival, count, 0.9))
    assert found(context, times).choice == BUILT_IN


def test_what_is_out_takes_no_more_time(context):
    """On a device that the built-in choice suits, a measurement would take as long as ever."""
    times = Times({})
    found(context, times, rounds=50)
    assert not any(bends for _, _, bends in times.calls)
    # Two turns to count the steps, and a round.
    assert max(times.turns(Choice('storage', block)) for block in (1, 2, 4)) == 5


def test_without_textures_there_is_one_way_to_load(context, monkeypatch):
    """A device without texture buffers could not be measured."""
    monkeypatch.setattr(context, 'max_texture_texels', 0)
    size, = tune(context, [20], 1, Times({}))
    assert size.built_in == Choice('storage', 4)
    assert {rival.choice for rival in size.rivals} == {Choice('storage', 1), Choice('storage', 2)}
