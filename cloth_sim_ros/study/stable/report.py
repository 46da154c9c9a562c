# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The tables of the stability study."""

from collections import Counter
from collections.abc import Sequence

from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.scene_fields import MODES
from cloth_sim_ros.study.results import Result
from cloth_sim_ros.study.stable.probe_outcome import REFUSED
from cloth_sim_ros.study.stable.probe_outcome import STABLE
from cloth_sim_ros.study.stable.probe_outcome import UNSTABLE

PROBES = {'rest': 'at rest', 'hanging': 'hanging', 'moving': 'moving'}


def edge_table(results: Sequence[Result]) -> str:
    """Return the edges as a table in Markdown: predicted, measured, and their ratio."""
    lines = [
        '| mode | cloth | varied | value | predicted [s] | this lattice [s] | measured [s] '
        '| measured / predicted |', '|---|---|---|---|---|---|---|---|']
    for result in results:
        settings, found = result.settings, result.values
        start = (f'| {result.scene["mode"]} | {PROBES[settings["probe"]]} | {settings["vary"]} '
                 f'| {settings["value"]:g} |')
        if not result.is_done:
            lines.append(f'{start} | | {result.outcome}: {result.reason} | |')
            continue
        lattice = f'{found["lattice"]:.4g}' if 'lattice' in found else ''
        lines.append(
            f'{start} {found["predicted"]:.4g} | {lattice} | '
            + (f'{found["measured"]:.4g} | {found["ratio"]:.3f} |' if found['measured']
               else f'stable at {found["stable"]:.4g} | |'))
    return '\n'.join(lines) + '\n'


def map_table(results: Sequence[Result]) -> str:
    """Return how many points of each map are stable, unstable, refused."""
    lines = ['| mode | steps | stable | unstable | refused |', '|---|---|---|---|---|']
    for mode in MODES:
        for forced in (True, False):
            counts = Counter(
                result.values['outcome'] if result.is_done else result.outcome
                for result in points_of(results, mode, forced))
            others = ', '.join(
                f'{count} {name}' for name, count in counts.items()
                if name not in (STABLE, UNSTABLE, REFUSED))
            lines.append(
                f'| {mode} | {steps_of(mode, forced)} | {counts[STABLE]} | {counts[UNSTABLE]} '
                f'| {counts[REFUSED]} |'
                + (f' {others}' if others else ''))
    return '\n'.join(lines) + '\n'


def steps_of(mode: str, forced: bool) -> str:
    """Return how the steps of a map are made, and what its cloth does."""
    if not forced:
        return 'by default, moving'
    return f'one step a dt, {"hanging" if AVAILABLE[mode].is_implicit else "at rest"}'


def points_of(results: Sequence[Result], mode: str, forced: bool) -> list[Result]:
    """Return the points of one map."""
    return [result for result in results
            if result.scene['mode'] == mode and result.settings['forced'] == forced]
