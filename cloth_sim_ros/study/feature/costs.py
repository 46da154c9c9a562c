# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The runs of the cost study: wall time in turn, what a result loses, and compiled passes."""

from collections.abc import Mapping
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
import statistics
from tempfile import TemporaryDirectory
import time
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.feature.features import SCENE_FEATURES
from cloth_sim_ros.study.feature.features import without
from cloth_sim_ros.study.feature.pass_list import pass_list
from cloth_sim_ros.study.workers import process_context
import numpy as np

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
        run = Simulation(Scene(values), context=context)
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
                from cloth_sim_ros.study.feature.frame_maker import FrameMaker
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
        # What a recording writes beside the steps belongs to this turn.
        maker.close()
    return time.perf_counter() - begin, time.process_time() - begin_processor


def _variant(scene: Mapping[str, Any], feature: str) -> dict[str, Any]:
    return without(scene, feature) if feature in SCENE_FEATURES else dict(scene)
