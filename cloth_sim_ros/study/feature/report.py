# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The tables of the cost study."""

from collections import Counter
from collections.abc import Mapping
from collections.abc import Sequence
from typing import Any

from cloth_sim_ros.study.feature.costs import WHOLE
from cloth_sim_ros.study.feature.features import SCENE_FEATURES
from cloth_sim_ros.study.feature.pass_list import modelled
from cloth_sim_ros.study.feature.pass_list import pass_table


def cost_table(
        timing: Mapping[str, Any], losses: Mapping[str, Mapping[str, Any]],
        absent: Sequence[str], seconds: float, device: str) -> str:
    """
    Return a row for each feature: time without it over that with everything, and what is lost.

    :param losses: of the features of the scene, by name
    :param absent: features the scene has not
    :param seconds: simulated until results are compared [s]
    """
    lines = [
        '| left out | wall time over that with everything, median (rounds) | processor time '
        '| substeps a dt '
        f'| RMS distance of nodes after {seconds:g} s, over the side | largest strain: change |',
        '|---|---|---|---|---|---|']
    for name, variant in timing['variants'].items():
        if name == WHOLE:
            continue
        ratios = variant['ratios']
        loss = losses.get(name)
        lost = 'none, the same bits |' if loss is None or loss['same_bits'] else (
            f'{loss["rms_position"]:.2g} | {loss["strain_difference"]:+.2g} '
            f'of {loss["whole_strain"]:.2g}')
        lines.append(
            f'| {name} | {variant["ratio"]:.2f} ({min(ratios):.2f} to {max(ratios):.2f}) '
            f'| {variant["processor_ratio"]:.2f} | {variant["substeps"]} | {lost} |')
    for name in absent:
        lines.append(f'| {name} | not in this scene | | | none, the same bits | |')
    whole = timing['variants'][WHOLE]
    lines += ['', f'With everything a round takes {whole["seconds"]:.3g} s of wall time, in '
              f'{whole["substeps"]} substeps a dt, on {device}.']
    return '\n'.join(lines) + '\n'


def passes_report(
        whole: Mapping[str, Any], others: Mapping[str, Mapping[str, Any]],
        absent: Sequence[str]) -> str:
    """Return the passes of the scene, and what is different without each feature."""
    lines = ['## Passes of the scene', '', pass_table(whole)]
    lines += ['## What is gone without a feature', '',
              '| left out | passes compiled otherwise, or gone | passes | runs a step of dt '
              '| buffers | bytes |', '|---|---|---|---|---|---|',
              _row('nothing', '', whole)]
    for name in SCENE_FEATURES:
        if name in others:
            lines.append(_row(name, _differences(whole, others[name]), others[name]))
        elif name in absent:
            lines.append(f'| {name} | not in this scene: nothing of it is compiled | | | | |')
    return '\n'.join(lines) + '\n'


def compiled(listed: Mapping[str, Any]) -> Counter[tuple[str, str]]:
    """Return the passes of a list by shader and by what of the model is compiled in."""
    return Counter((each['shader'], modelled(each['defines'])) for each in listed['passes'])


def _differences(whole: Mapping[str, Any], other: Mapping[str, Any]) -> str:
    """Return what ``other`` compiles otherwise, shaders with the same difference together."""
    gone, come = compiled(whole) - compiled(other), compiled(other) - compiled(whole)
    changes: dict[str, list[str]] = {}
    for shader, what in gone:
        others = [set(choices.split(', ')) for name, choices in come if name == shader]
        choices = set(what.split(', '))
        # Of several forms of a shader, the one that is nearest.
        nearest = max(others, key=lambda each: len(each & choices), default=None)
        words = 'gone' if nearest is None else ', '.join(
            [f'without {name}' for name in sorted(choices - nearest)]
            + [f'with {name}' for name in sorted(nearest - choices)])
        changes.setdefault(words, []).append(shader)
    return '; '.join(f'{words}: {", ".join(shaders)}' for words, shaders in changes.items()) or (
        'none')


def _row(name: str, words: str, listed: Mapping[str, Any]) -> str:
    runs = sum(each['runs_per_step'] for each in listed['passes'])
    return (f'| {name} | {words} | {len(listed["passes"])} | {runs:.4g} | {listed["buffers"]} '
            f'| {listed["buffer_bytes"]} |')
