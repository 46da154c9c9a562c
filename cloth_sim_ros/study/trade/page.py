# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a study of the trade found, in plain words and as a table."""

from collections import Counter
from collections.abc import Iterable
from collections.abc import Sequence
import csv
import json
from pathlib import Path

from cloth_sim_ros.study.trade.accuracy import distances
from cloth_sim_ros.study.trade.front import front
from cloth_sim_ros.study.trade.front import Row
from cloth_sim_ros.study.trade.front import WORST_ERROR
from cloth_sim_ros.study.trade.grid import Variant
from cloth_sim_ros.study.trade.measured import Measured
import numpy as np

_SPEEDS = (0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0)
_ERRORS = (3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4)


def write_table(folder: Path, rows: Sequence[Row]) -> None:
    """Write table.csv and table.jsonl into ``folder``, a line for each row."""
    lines = [row.as_dict() for row in rows]
    with open(folder / 'table.csv', 'w', encoding='utf-8', newline='') as file:
        writer = csv.DictWriter(file, lines[0])
        writer.writeheader()
        writer.writerows(lines)
    text = ''.join(f'{json.dumps(line)}\n' for line in lines)
    (folder / 'table.jsonl').write_text(text, encoding='utf-8')


def page(measured: Measured, scene_name: str) -> str:
    """Return the page as Markdown."""
    scene = measured.scene
    device = next(row.run.device for row in measured.rows if row.run.is_done)
    parts = [
        f'# Error against cost: {scene_name}',
        f'{scene.rows} x {scene.cols} nodes, {measured.grid.times[-1]:g} s simulated, on '
        f'{device}. An error is the RMS distance of nodes from the reference over the times that '
        'count, over the longer side of the cloth. Cost is the time that a simulated second takes '
        f'with nothing beside it, by the median of {measured.grid.rounds} rounds in turn: '
        'processor time on software, wall time on a GPU. With a ~ it is what the run that errors '
        'are measured on lets expect, of settings that were not near the front. '
        f'Settings off by more than {WORST_ERROR:g} of the side are left out.',
        '## What it was measured against', _references(measured),
        '## What settings cost', _costs(measured),
        '## What a real-time budget buys on this scene', _speeds(measured),
        '## Which mode is fastest within an error', _winners(measured),
        '## Floors: what a model is off by, however finely it is stepped', _floors(measured),
        '## What did not run to its end', _ends(measured)]
    return '\n\n'.join(parts) + '\n'


def _references(measured: Measured) -> str:
    times = measured.grid.times
    rows = []
    for (variant, model), reference in measured.references.items():
        changes = reference.changes / _side(measured)
        rows.append((
            variant.name, model, reference.device,
            ' '.join(f'{change:.0e}' for change in changes),
            f'{measured.allowed[variant]:g}',
            _list(times[:measured.times[variant]]) if measured.times[variant] else 'none'))
    moments = _list(times)
    return (
        'Springs: mass-spring runs finer and finer, extrapolated. Hard edges and limited springs: '
        'the finest setting of the grid. The change is what the last refinement did to the '
        f'reference, at t = {moments} s, over the side. Times count while that of the springs is '
        'as allowed: later the cloth is chaotic, and two runs differ whatever made them differ. '
        'Errors below the change are not told apart.\n\n' + _table(
            ('scene', 'model', 'computed on', 'change', 'allowed', 'times that count [s]'), rows))


def _costs(measured: Measured) -> str:
    base = measured.grid.settings[0]
    rows = []
    for variant in measured.grid.variants:
        own = measured.rows_of(variant)
        first = next(row for row in own if row.setting == base)
        for row in (row for row in own if row.rounds):
            error, ratio = row.error(variant.is_scene), row.cost_over(first)
            rows.append((
                variant.name, f'{row.setting.method}, {row.setting.label}', row.setting.model,
                f'{error:.1e}' if error else '-', f'{row.peak_strain:.2g}',
                '{:.2f} ({:.2f}-{:.2f})'.format(*ratio) if ratio else '-', _cost(row),
                f'{row.run.values["substeps"]:.0f}', f'{row.run.values["passes"]:.0f}'))
    head = (
        'scene', 'setting', 'model', 'error', 'largest strain', 'ratio', 'cost [s]', 'substeps',
        'passes')
    return (
        'The cheapest setting of each method, and those near the front. The error is that against '
        'the scene as it is, or in a variant against its own model; '
        f'the ratio is the cost over that of {base.method}, {base.label} in the same round, '
        'median and range. Substeps and passes over the springs are in a simulated second.\n\n'
        + _table(head, rows))


def _speeds(measured: Measured) -> str:
    timed = [row for row in measured.rows_of(Variant()) if row.is_choice(True)]
    rows = []
    for speed in _SPEEDS:
        fitting = [row for row in timed if 1.0 / row.cost >= speed]
        best = min(fitting, key=lambda row: row.known_error(True), default=None)
        rows.append(
            (f'{speed:g}', *(_texts(best) if best else ('nothing is as fast', '', '', ''))))
    return _table(
        ('real-time factor', 'most exact setting', 'error', 'largest strain', 'cost [s]'), rows)


def _winners(measured: Measured) -> str:
    rows = []
    for variant in measured.grid.variants:
        cells = []
        resolved = _resolved(measured, variant)
        for error in _ERRORS:
            if error < resolved:
                cells.append('not resolved')
                continue
            fitting = [row for row in measured.rows_of(variant)
                       if row.is_choice(False) and row.own_errors.position <= error]
            best = min(fitting, key=lambda row: row.cost, default=None)
            cells.append(
                f'{best.setting.method}, {best.setting.label}: {_cost(best)}' if best else '-')
        rows.append((variant.name, *cells))
    text = _table(('scene', *(f'{error:g}' for error in _ERRORS)), rows)
    return (
        'Of settings that step the springs as they are, against the reference of the same scene: '
        f'the fastest one, with its cost [s].\n\n{text}\n\n{_crossing(measured)}')


def _resolved(measured: Measured, variant: Variant) -> float:
    """Return what the reference of the springs changes by at most at the times that count."""
    reference, times = measured.references.get((variant, 'springs')), measured.times[variant]
    return float(reference.changes[:times].max()) / _side(measured) if reference and times else 0.0


def _crossing(measured: Measured) -> str:
    sentences = []
    for variant in measured.grid.variants:
        best = front(measured.rows_of(variant), of_scene=False)
        explicit = [row for row in best if row.setting.method == 'mass_spring']
        if not explicit:
            continue
        cheaper = [row for row in best if row.cost < explicit[0].cost]
        if cheaper:
            first = cheaper[-1]
            sentences.append(
                f'- {variant.name}: below the {_cost(explicit[0])} s of mass_spring there is '
                f'{first.setting.method}, {first.setting.label}: {_cost(first)} s, with an error '
                f'of {first.own_errors.position:.1e} against '
                f'{explicit[0].own_errors.position:.1e}, and a largest strain of '
                f'{first.own_errors.peak_strain:.2g} against '
                f'{explicit[0].own_errors.peak_strain:.2g}.')
        else:
            sentences.append(
                f'- {variant.name}: nothing that was measured is cheaper than mass_spring with '
                f'{explicit[0].setting.label} ({_cost(explicit[0])} s).')
    return '\n'.join(sentences)


def _floors(measured: Measured) -> str:
    truth = measured.references[measured.truth]
    count = measured.times[Variant()]
    rows = []
    for (variant, model), reference in measured.references.items():
        if (variant, model) == measured.truth:
            continue
        path = reference.path.on_nodes_of(measured.scene.rows, measured.scene.cols)
        apart = np.sqrt(np.mean(distances(path, truth.path)[:count]**2)) / _side(measured)
        rows.append((variant.name, model, f'{apart:.1e}'))
    least = min(
        (row for row in measured.rows_of(Variant()) if row.scene is not None),
        key=lambda row: row.scene_errors.position)
    return (
        'Distance of each reference from that of the scene as it is, at common points of the '
        'cloth (bilinear between nodes). Another number of nodes has other random offsets at the '
        'start, where the scene asks for them.\n\n'
        + _table(('scene', 'model', 'model error'), rows)
        + '\n\nThe least error of any setting on the scene itself is '
        f'{least.scene_errors.position:.1e} ({least.setting.method}, '
        f'{least.setting.label}). {_rounding(measured)}')


def _rounding(measured: Measured) -> str:
    finer = [row for row in measured.rows_of(Variant())
             if row.setting.method == 'mass_spring' and row.own is not None][-2:]
    if len(finer) < 2:
        return ''
    gain = finer[0].own_errors.position / finer[1].own_errors.position
    told = f'The last refinement of mass_spring made it {gain:.1f} times as exact'
    if gain > 1.5:
        return f'{told}: finer ones would be more exact still.'
    return (
        f'{told}: what is left is the rounding of float32, which grows in a cloth that buckles.')


def _ends(measured: Measured) -> str:
    ended = Counter(
        (row.variant.name, row.setting.method, row.run.outcome)
        for row in measured.rows if not row.run.is_done)
    if not ended:
        return 'All settings did.'
    return 'Reasons are in table.csv.\n\n' + _table(
        ('scene', 'method', 'outcome', 'settings'),
        [(*key, str(count)) for key, count in ended.items()])


def _texts(row: Row) -> tuple[str, str, str, str]:
    return (
        f'{row.setting.method}, {row.setting.label}', f'{row.scene_errors.position:.1e}',
        f'{row.scene_errors.peak_strain:.3f}', _cost(row))


def _cost(row: Row) -> str:
    return f'{"" if row.rounds else "~"}{row.cost:.2g}'


def _side(measured: Measured) -> float:
    return max(measured.scene['width'], measured.scene['height'])


def _list(numbers: Iterable[float]) -> str:
    return ', '.join(f'{number:g}' for number in numbers)


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [head, ['---'] * len(head), *rows]
    return '\n'.join(f'| {" | ".join(line)} |' for line in lines)
