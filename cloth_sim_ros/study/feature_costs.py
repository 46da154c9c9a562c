# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The features of a scene that can be left out: time, passes, memory and results."""

from collections.abc import Mapping
from collections.abc import Sequence
from contextlib import closing
from contextlib import ExitStack
from pathlib import Path
import statistics
from tempfile import TemporaryDirectory
import time
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.inventory import take_inventory
from cloth_sim_ros.sim.model.edge_kinds import EACH_EDGE
from cloth_sim_ros.sim.model.given_values import with_default_fabric
from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.modes.mass_spring import MassSpring
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.workers import process_context
import numpy as np

# Outputs of a frame besides the steps.
OUTPUTS = ('points', 'markers', 'stats', 'wrenches', 'recording')
_BEND, _SHEAR = 'bend springs', 'shear springs'
_DAMPING, _MODE = 'damping', 'mode'
_AIR, _PUSHES, _PIN_MOVES = 'air', 'pushes', 'pins that move'
_RIGIDITY = 'bending rigidity'
SCENE_FEATURES = (_BEND, _RIGIDITY, _SHEAR, _DAMPING, _MODE, _AIR, _PUSHES, _PIN_MOVES)
# Prefixes of the parameters that are removed to disable a feature.
_PREFIXES = {_AIR: ('air.', 'gusts.'), _PUSHES: ('pushes.',), _PIN_MOVES: ('pin_moves.',)}


def has_feature(values: Mapping[str, Any], feature: str) -> bool:
    """Return whether the scene of ``values`` has one of SCENE_FEATURES."""
    scene = Scene(values)
    if feature in (_BEND, _SHEAR):
        return _has_edges(scene, feature.split()[0])
    return {
        _DAMPING: scene.has_bending_damping or any(
            scene.damping(family) > 0.0 for family in ('structural', 'shear', 'bend')),
        _MODE: scene['mode'] != MassSpring.name,
        _AIR: scene.has_air,
        _RIGIDITY: scene.has_rigidity,
        _PUSHES: bool(scene['pushes.start']),
        _PIN_MOVES: bool(scene['pin_moves.start']),
    }[feature]


def without(values: Mapping[str, Any], feature: str) -> dict[str, Any]:
    """Return the scene of ``values`` without one of SCENE_FEATURES; plain springs for the mode."""
    values = with_default_fabric(values)
    if feature in (_BEND, _SHEAR):
        return _without_family(values, feature.split()[0])
    if feature == _DAMPING:
        return {**values, 'bending.damping': 0.0, **{
            f'damping.{family}': 0.0 for family in ('structural', 'shear', 'bend')}}
    if feature == _RIGIDITY:
        return {**values, 'bending.rigidity': 0.0}
    if feature == _MODE:
        return {**values, 'mode': MassSpring.name}
    prefixes = _PREFIXES[feature]
    return {name: value for name, value in values.items() if not name.startswith(prefixes)}


def _has_edges(scene: Scene, family: str) -> bool:
    return family in AVAILABLE[scene['mode']].edge_families(scene)


def _without_family(values: Mapping[str, Any], family: str) -> dict[str, Any]:
    scene = Scene(values)
    return {
        **values, f'stiffness.{family}': 0.0, f'damping.{family}': 0.0,
        **({'material.shear': 0.0} if family == 'shear' else {}),
        **{name: [other for other in scene[name] if other != family]
           for name in ('constraint.hard', 'constraint.springs')}}


# The passes that a scene compiles, how often a step runs each, and the memory they need.

# Choices that say what is modelled; the others say how the work is laid out.
_MODELLED = (
    'HAS_', 'STRAIN_LIMIT', 'MULTIGRID', 'FORESEES_TURN', 'RECORDS_WANTED')


def pass_list(
        values: Mapping[str, Any], *, context: Context | None = None, seconds: float = 0.0,
        looks: bool = True) -> dict[str, Any]:
    """
    Return the passes of the scene of ``values``, its buffers and their bytes, as plain values.

    A pass has its file, the choices it was compiled with and reads, and its runs in each step of
    dt: the mean over ``seconds`` [s] and one step at least. Runs of the solver's iterations count
    as submitted: the device leaves out those it does not need.

    :param looks: take a snapshot at the end, and list its pass; its run is no part of a step
    """
    with take_inventory() as inventory, closing(
            Simulation(Scene(values), context=context, records_forces=False)) as run:
        before = inventory.dispatches()
        steps = max(1, round(seconds / run.dt))
        run.step(steps)
        after = inventory.dispatches()
        before += [0] * (len(after) - len(before))
        if looks:
            run.snapshot()
        after += [0] * (len(inventory.programs) - len(after))
        before += [0] * (len(inventory.programs) - len(before))
        passes = [
            {'shader': program.name,
             'defines': {name: str(value) for name, value in program.source.used_defines.items()},
             'runs_per_step': (late - early) / steps}
            for program, early, late in zip(inventory.programs, before, after)]
        return {
            'passes': passes, 'buffers': len(inventory.buffers),
            'buffer_bytes': inventory.buffer_bytes, 'substeps': run.substeps, 'steps': steps,
            'device': run.device}


def modelled(defines: Mapping[str, str]) -> str:
    """Return the choices among ``defines`` that say what is modelled, in words."""
    chosen = {name: value for name, value in defines.items() if name.startswith(_MODELLED)}
    there = [name[len('HAS_'):].lower() for name, value in chosen.items()
             if name.startswith('HAS_') and value == '1']
    edges = defines.get(EACH_EDGE, '')
    there += [family for family in FAMILIES if family not in there and family.upper() in edges]
    others = [f'{name.lower().replace("_", " ")} {value}' for name, value in chosen.items()
              if not name.startswith('HAS_') and value != '0']
    return ', '.join(there + others)


def pass_table(listed: Mapping[str, Any]) -> str:
    """Return a pass list as a table in Markdown."""
    lines = ['| shader | compiled with | runs a step of dt |', '|---|---|---|']
    for each in listed['passes']:
        lines.append(
            f'| {each["shader"]} | {modelled(each["defines"])} | {each["runs_per_step"]:.4g} |')
    total = sum(each['runs_per_step'] for each in listed['passes'])
    lines += ['', f'{len(listed["passes"])} passes, {total:.4g} runs in a step of dt of '
              f'{listed["substeps"]} substeps, {listed["buffers"]} buffers of '
              f'{listed["buffer_bytes"]} bytes.']
    return '\n'.join(lines) + '\n'


# The runs of the cost study: wall time in turn, what a result loses, and compiled passes.

WHOLE = 'everything'
# Left out to see how far the ratios of equal variants are from 1.
NOTHING = 'nothing, to compare'
ALL_OUTPUTS = 'all messages and the recording'
_SINGLE_THREAD_NODES = 128 * 128


def list_passes(scene: Mapping[str, Any], *, feature: str, seconds: float) -> dict[str, Any]:
    """Return the pass list of ``scene`` without ``feature``."""
    return pass_list(_variant(scene, feature), context=process_context(), seconds=seconds)


def compare_results(scene: Mapping[str, Any], *, feature: str, seconds: float) -> dict[str, Any]:
    """
    Return how far ``scene`` without ``feature`` is from the whole after ``seconds``.

    :return: rms_position, over the longer side of the cloth; strain_difference, of the largest
        strains at the end; and same_bits
    """
    context = process_context()
    ends = []
    for values in (scene, _variant(scene, feature)):
        run = Simulation(Scene(values), context=context, records_forces=False)
        run.advance(seconds)
        ends.append(run.snapshot())
        run.close()
    whole, other = ends
    side = max(Scene(scene)['width'], Scene(scene)['height'])
    apart = whole.positions.astype(float) - other.positions
    return {
        'rms_position': float(np.sqrt(np.mean(np.sum(apart**2, axis=-1)))) / side,
        'strain_difference': float(other.max_strain - whole.max_strain),
        'whole_strain': whole.max_strain,
        'same_bits': whole.state_sha256 == other.state_sha256, 'device': context.device}


def time_variants(
        scene: Mapping[str, Any], *, features: Sequence[str], outputs: Sequence[str],
        rounds: int, round_seconds: float, frame_seconds: float) -> dict[str, Any]:
    """
    Return the wall time of ``scene`` without each of ``features``, over that with everything.

    Variants are timed in turn, so that their ratio holds on a machine whose speed drifts.

    :param features: left out, one at a time; of SCENE_FEATURES or of ``outputs``, or ALL_OUTPUTS
    :param outputs: that are made of each frame, of OUTPUTS
    :param rounds: how often each has its turn
    :param round_seconds: simulated in a turn [s]
    :param frame_seconds: simulated between frames [s]
    :return: for each feature the ratios of all rounds and their median, that of processor times,
        which a busy machine disturbs less, and the substeps
    """
    names = [WHOLE, NOTHING, *features]
    context = Context(single_thread=Scene(scene).node_count < _SINGLE_THREAD_NODES)
    with ExitStack() as stack:
        stack.callback(context.close)
        folder = Path(stack.enter_context(TemporaryDirectory()))
        turns = []
        for number, name in enumerate(names):
            run = Simulation(Scene(_variant(scene, name)), context=context)
            stack.callback(run.close)
            kept = [] if name == ALL_OUTPUTS else [
                output for output in outputs if output != name]
            maker = None
            if kept:
                # ROS packages are needed for messages alone.
                from cloth_sim_ros.study.frame_maker import FrameMaker
                maker = FrameMaker(run, kept, folder / str(number))
            turns.append((run, maker))
        frames = max(1, round(round_seconds / frame_seconds))
        # The first turn compiles what the device puts off until then.
        times = [_round(turns, number, frames, frame_seconds)
                 for number in range(rounds + 1)][1:]
        substeps = [run.substeps for run, _ in turns]
    return {
        'variants': {
            name: {**_ratios([row[number] for row in times], [row[0] for row in times]),
                   'substeps': substeps[number]}
            for number, name in enumerate(names)},
        'device': context.device}


def _round(
        turns: Sequence[tuple[Simulation, Any]], first: int, frames: int,
        frame_seconds: float) -> list[tuple[float, float]]:
    """Return the times of all variants, beginning with another one in each round."""
    count = len(turns)
    order = [(first + place) % count for place in range(count)]
    made = {number: _turn(*turns[number], frames, frame_seconds) for number in order}
    return [made[number] for number in range(count)]


def _ratios(
        turns: Sequence[tuple[float, float]], whole: Sequence[tuple[float, float]]
        ) -> dict[str, Any]:
    """Return wall and processor times over those of the whole, and the wall time itself [s]."""
    walls, processors = (
        [turn[kind] / other[kind] for turn, other in zip(turns, whole)] for kind in (0, 1))
    return {
        'ratios': walls, 'ratio': statistics.median(walls),
        'processor_ratio': statistics.median(processors),
        'seconds': statistics.median(wall for wall, _ in turns)}


def _turn(
        run: Simulation, maker: Any, frames: int, frame_seconds: float) -> tuple[float, float]:
    """Return the wall time and the processor time of a turn [s]."""
    # Each turn is the same motion from the start: pushes come again, and nothing drifts.
    run.reset()
    if maker is not None:
        maker.begin()
    run.finish()
    begin, begin_processor = time.perf_counter(), time.process_time()
    for _ in range(frames):
        run.advance(frame_seconds)
        if maker is not None:
            maker.make()
    run.finish()
    if maker is not None:
        # The recorder writes in another thread; its time belongs to this turn.
        maker.close()
    return time.perf_counter() - begin, time.process_time() - begin_processor


def _variant(scene: Mapping[str, Any], feature: str) -> dict[str, Any]:
    return without(scene, feature) if feature in SCENE_FEATURES else dict(scene)
