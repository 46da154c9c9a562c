# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
States of all modes and loads against those of llvmpipe and of the float64 reference.

states.npz has both, by `python benchmarks/gpu_suite.py --store-states`, so that the suite needs
no SciPy. It also has how far the state moves when the start is off by rounding, which depends on
the case: friction and a cloth that buckles make the least rounding grow. A device may be a few
times as far away. Each case is run twice: the bits of both runs have to agree.
"""

from collections.abc import Iterator
from pathlib import Path

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from gpu.cases import Case
from gpu.cases import CASES
from gpu.section import FAULT
from gpu.section import Row
from gpu.section import Section
import numpy as np

_FILE = Path(__file__).with_name('states.npz')
# Standard deviation of the offsets of a start [m]: coordinates of 1 m are rounded by up to 6e-8.
_ROUNDING = 1e-7
_OFFSETS = 3
# Allowed distance over the largest that the offsets have led to.
_ALLOWED = 3.0
# Least allowed distance [m]: some ten roundings of a coordinate.
_LEAST_ALLOWED = 1e-6


def positions_after(
        scene: Scene, steps: int, context: Context, seed: int | None = None) -> np.ndarray:
    """
    Return the positions after ``steps`` of dt [m], (rows, cols, 3) float32.

    :param seed: of offsets by rounding at the start; None for none
    """
    with Simulation(scene, context=context) as run:
        if seed is not None:
            start = run.positions()
            offsets = np.random.default_rng(seed).normal(0.0, _ROUNDING, start.shape)
            run.set_state(start + offsets, np.zeros_like(start))
        run.step(steps)
        return run.positions()


def distance(positions: np.ndarray, others: np.ndarray) -> float:
    """Return the largest distance between nodes of two states [m]; infinite where one is NaN."""
    found = float(np.linalg.norm(positions.astype(np.float64) - others, axis=-1).max())
    return found if np.isfinite(found) else float('inf')


def store() -> None:
    """Compute the states on llvmpipe and by the reference, and print how far apart they are."""
    context = Context(single_thread=True)
    if not context.is_software:
        raise SystemExit(f'states are those of llvmpipe, not of {context.device}: set '
                         'LIBGL_ALWAYS_SOFTWARE=1')
    found = {}
    for case in CASES:
        scene = case.scene()
        found[case.name] = positions_after(scene, case.steps, context)
        moved = max(
            distance(found[case.name], positions_after(scene, case.steps, context, seed))
            for seed in range(_OFFSETS))
        found[_moved_name(case)] = np.array(moved)
        print(f'{case.name}: {moved:.2g} m from offsets of {_ROUNDING:g} m')
        if case.has_reference:
            found[_reference_name(case)] = _reference(case)
            print(f'  {distance(found[case.name], found[_reference_name(case)]):.2g} m from the '
                  'reference')
    np.savez_compressed(_FILE, **found)
    context.close()


def _reference(case: Case) -> np.ndarray:
    """Return the positions by the float64 reference [m]; needs SciPy."""
    from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
    from cloth_sim_ros.reference.implicit_cloth import ImplicitCloth
    scene = case.scene()
    cloth = (ImplicitCloth if scene['mode'] == 'constraint' else MassSpringReference)(scene)
    cloth.step(case.steps)
    return cloth.positions


def _reference_name(case: Case) -> str:
    return f'{case.name}, reference'


def _moved_name(case: Case) -> str:
    return f'{case.name}, moved by'


def _measure(quick: bool) -> Iterator[Row]:
    stored = np.load(_FILE)
    context = Context(single_thread=True)
    for case in CASES:
        found, again = (
            positions_after(case.scene(), case.steps, context) for _ in range(2))
        to_llvmpipe = distance(found, stored[case.name])
        allowed = max(_ALLOWED * float(stored[_moved_name(case)]), _LEAST_ALLOWED)
        same = np.array_equal(found, again)
        faults = [] if same else ['other bits in a second run']
        row: Row = {'case': case.name, 'to llvmpipe [m]': to_llvmpipe, 'allowed [m]': allowed,
                    'to the reference [m]': '-', 'llvmpipe to it [m]': '-',
                    'same bits twice': same}
        if to_llvmpipe > allowed:
            faults.append('far from llvmpipe')
        if case.has_reference:
            exact = stored[_reference_name(case)]
            ours, theirs = distance(found, exact), distance(stored[case.name], exact)
            row |= {'to the reference [m]': ours, 'llvmpipe to it [m]': theirs}
            if ours > theirs + allowed:
                faults.append('far from the reference')
        yield {**row, FAULT: ', '.join(faults)}
    context.close()


SECTION = Section('states', 'States against llvmpipe and the float64 reference', 60.0, _measure)
