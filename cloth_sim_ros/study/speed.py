# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How fast variants of a scene step, side by side on one device; what colliders cost."""

from collections.abc import Callable
from collections.abc import Iterator
from collections.abc import Mapping
from collections.abc import Sequence
from contextlib import closing
from contextlib import ExitStack
from dataclasses import asdict
from dataclasses import dataclass
import math
import statistics
import time
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.model.stability import SAFETY
from cloth_sim_ros.sim.model.stability import stability_limit
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.simulation import SINGLE_THREAD_NODES


def time_steps(run: Simulation, count: int) -> float:
    """Make ``count`` steps of dt and return the wall time [s]."""
    run.finish()
    begin = time.perf_counter()
    run.step(count)
    run.finish()
    return time.perf_counter() - begin


# Makes a number of steps of dt and returns their wall time [s].
Timer = Callable[[Simulation, int], float]


# How fast variants of a scene step, measured side by side on one device.

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
        counts = [steps_for(run, round_seconds) for run in runs]
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
        name, run.layout.kind, run.layout.choice.loads, run.layout.block,
        statistics.median(figures), tuple(figures), statistics.median(ratios), ratios)


def steps_for(run: Simulation, seconds: float, timer: Timer = time_steps) -> int:
    """Return how many steps of dt take about ``seconds`` of wall time [s], after the first."""
    # The first steps compile what the device puts off until then.
    timer(run, _STEPS_BEFORE)
    return max(1, round(_STEPS_BEFORE * seconds / timer(run, _STEPS_BEFORE)))


# What colliders cost: a cloth dropped over a sphere, the same without it, among twenty, and hung.

# All variants take turns after so much simulated time [s].
_TURN = 0.02
_SPHERE = {'shape': 'sphere', 'size': [0.15], 'friction': 0.3}
# Bodies beside the sphere that the cloth never comes near to.
_OTHERS = 19
_HUNG = 'hung, no collider'


@dataclass(frozen=True)
class ContactSpeed:
    """
    Wall time of one mode.

    :param seconds: wall time of a simulated second in each round, by variant [s]
    :param ratios: of each variant to the one without colliders in each round
    :param ratios_to_hung: the same to a cloth that hangs from two corners, without colliders: in
        an implicit mode a cloth that falls freely has next to nothing to solve
    :param substeps: of a dt in each round, the mean of those looked at, by variant
    :param solves: of a substep, likewise; 0 in a mode without a solver
    """

    mode: str
    nodes: int
    device: str
    seconds: dict[str, list[float]]
    ratios: dict[str, list[float]]
    ratios_to_hung: dict[str, list[float]]
    substeps: dict[str, list[float]]
    solves: dict[str, list[float]]

    def as_dict(self) -> dict[str, Any]:
        """Return it for JSON."""
        return asdict(self)

    def in_words(self) -> str:
        """Return lines for people."""
        lines = [f'{self.mode}, {self.nodes} x {self.nodes} on {self.device}']
        for variant, rounds in self.seconds.items():
            ratios = self.ratios[variant]
            to_hung = self.ratios_to_hung[variant]
            lines.append(
                f'  {variant:22}{statistics.median(rounds):7.2f} s for a simulated second, '
                f'{statistics.median(ratios):5.2f} x ({min(ratios):.2f} to {max(ratios):.2f}), '
                f'{statistics.median(to_hung):5.2f} x the one that hangs '
                f'({min(to_hung):.2f} to {max(to_hung):.2f}); '
                f'{statistics.median(self.substeps[variant]):.2f} substeps a dt, '
                f'{statistics.median(self.solves[variant]):.2f} solves a substep')
        return '\n'.join(lines)


def variants(mode: str, nodes: int) -> dict[str, Scene]:
    """Return the scenes that are compared, by name; the first falls without colliders."""
    cloth: dict[str, Any] = {
        'mode': mode, 'rows': nodes, 'cols': nodes, 'width': 1.0, 'height': 1.0,
        'areal_density': 0.15, 'material.preset': 'none', 'start.pose': 'horizontal',
        'start.z': 0.2, 'pins': ['none'], 'dt': 0.005}
    places: dict[str, Sequence[float]] = {'ball': (0.0, 0.0, 0.0), **{
        f'other_{number}': (
            5.0 * math.cos(number), 5.0 * math.sin(number), 0.0) for number in range(_OTHERS)}}
    return {
        'no collider': Scene(cloth), 'a sphere': Scene({**cloth, **_spheres(places, 1)}),
        f'{_OTHERS + 1} spheres': Scene({**cloth, **_spheres(places, None)}),
        _HUNG: Scene({**cloth, 'pins': ['top_left', 'top_right']})}


def measure_contact(
        mode: str, nodes: int, *, seconds: float = 1.0, rounds: int = 3) -> ContactSpeed:
    """Run the variants in turns from the drop on, ``rounds`` times."""
    scenes = variants(mode, nodes)
    walls: dict[str, list[float]] = {name: [] for name in scenes}
    substeps: dict[str, list[float]] = {name: [] for name in scenes}
    solves: dict[str, list[float]] = {name: [] for name in scenes}
    with closing(Context(single_thread=nodes * nodes < SINGLE_THREAD_NODES)) as context:
        for _ in range(rounds):
            for name, work in _round(scenes, context, seconds).items():
                walls[name].append(work.wall / seconds)
                substeps[name].append(work.substeps / work.looks)
                solves[name].append(work.solves / work.substeps)
        device = context.device
    return ContactSpeed(
        mode, nodes, device, walls, _ratios(walls, next(iter(walls))), _ratios(walls, _HUNG),
        substeps, solves)


@dataclass
class _Work:
    """
    What a variant does in a round.

    :param wall: time of it [s]
    :param looks: at the last dt of each turn
    :param substeps: of these dt
    :param solves: of them
    """

    wall: float = 0.0
    looks: int = 0
    substeps: int = 0
    solves: int = 0


def _ratios(walls: dict[str, list[float]], base: str) -> dict[str, list[float]]:
    """Return the ratios to the variant ``base``, round by round."""
    return {
        name: [wall / other for wall, other in zip(rounds_of, walls[base])]
        for name, rounds_of in walls.items()}


def _round(scenes: dict[str, Scene], context: Context, seconds: float) -> dict[str, _Work]:
    works = {name: _Work() for name in scenes}
    with ExitStack() as stack:
        runs = {
            name: stack.enter_context(Simulation(scene, context=context))
            for name, scene in scenes.items()}
        for run in runs.values():
            run.warm_up()
            run.finish()
        for _ in range(round(seconds / _TURN)):
            for name, run in runs.items():
                work = works[name]
                begin = time.perf_counter()
                run.advance(_TURN)
                run.finish()
                work.wall += time.perf_counter() - begin
                work.looks += 1
                work.substeps += run.substeps
                work.solves += run.snapshot().solves
    return works


def _spheres(places: dict[str, Sequence[float]], count: int | None) -> dict[str, Any]:
    names = list(places)[:count]
    return {
        'colliders.names': names,
        **{f'colliders.{name}.{part}': value for name in names
           for part, value in {**_SPHERE, 'position': list(places[name])}.items()}}
