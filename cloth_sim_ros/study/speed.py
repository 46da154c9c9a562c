# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How fast variants of a scene step, measured side by side on one device."""

from collections.abc import Iterator
from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import asdict
from dataclasses import dataclass
import statistics
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.stability import SAFETY
from cloth_sim_ros.sim.stability import stability_limit
from cloth_sim_ros.study.timed_steps import time_steps

_STEPS_BEFORE = 2


@dataclass(frozen=True)
class Speed:
    """
    Node steps a second of one variant.

    :param median: over the rounds
    :param rounds: each round's figure
    :param ratio: of the median over the rounds to the last variant, round by round
    """

    variant: str
    layout: str
    loads: str
    block: int
    median: float
    rounds: tuple[float, ...]
    ratio: float
    ratio_rounds: tuple[float, ...]


@dataclass(frozen=True)
class Comparison:
    """The variants at one size; the last is what the others are compared with."""

    rows: int
    cols: int
    device: str
    speeds: tuple[Speed, ...]

    def as_dict(self) -> dict[str, object]:
        """Return plain values for JSON."""
        return asdict(self)


def compare_variants(
        variants: Mapping[str, Mapping[str, Any]], sizes: Sequence[int], rounds: int,
        round_seconds: float) -> Iterator[Comparison]:
    """
    Yield the comparison for each size; in a round each variant has its turn.

    :param variants: name and scene parameters of each
    :param sizes: nodes along each side
    :param round_seconds: wall time that each turn aims at [s]
    """
    context = Context()
    for size in sizes:
        runs = [
            Simulation(bench_scene(size, values), context=context)
            for values in variants.values()]
        counts = [_steps_for(run, round_seconds) for run in runs]
        measured: list[list[float]] = [[] for _ in runs]
        for _ in range(rounds):
            for run, count, figures in zip(runs, counts, measured):
                figures.append(run.scene.node_count * count / time_steps(run, count))
        speeds = tuple(
            _speed(name, run, figures, measured[-1])
            for name, run, figures in zip(variants, runs, measured))
        yield Comparison(size, size, context.device, speeds)
        for run in runs:
            run.close()
    context.close()


def bench_scene(size: int, values: Mapping[str, Any]) -> Scene:
    """Return a moving cloth with all springs and damping, in one substep at 0.85 of the limit."""
    # The damping of a coarse cloth would rule the limit of a fine one.
    damping = {f'damping.{family}': 1e-5 for family in ('structural', 'shear', 'bend')}
    given = {
        'rows': size, 'cols': size, 'auto_substeps': False, 'start.jitter': 0.05,
        'material.preset': 'none', **damping, **values}
    return Scene({**given, 'dt': SAFETY * stability_limit(Scene(given))})


def _speed(
        name: str, run: Simulation, figures: list[float], baseline: list[float]) -> Speed:
    ratios = tuple(figure / other for figure, other in zip(figures, baseline))
    return Speed(
        name, run.layout.kind, 'texture' if run.layout.texture_loads else 'storage',
        run.layout.block, statistics.median(figures), tuple(figures), statistics.median(ratios),
        ratios)


def _steps_for(run: Simulation, seconds: float) -> int:
    # The first steps compile what the device puts off until then.
    time_steps(run, _STEPS_BEFORE)
    return max(1, round(_STEPS_BEFORE * seconds / time_steps(run, _STEPS_BEFORE)))
