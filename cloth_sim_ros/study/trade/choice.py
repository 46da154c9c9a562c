# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A chosen setting as a parameter file that node and `cloth_sim run` take."""

from pathlib import Path
from typing import Any

from cloth_sim_ros.files.checked_yaml import MOST_BYTES
from cloth_sim_ros.files.regular_file import read_regular
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.given_values import load_parameters
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.results import Run
from cloth_sim_ros.study.trade.budget import Budget
from cloth_sim_ros.study.trade.budget import BUDGETS
from cloth_sim_ros.study.trade.row import Row
import yaml

_OWN_ERROR, _OWN_SPEED, _OWN_STRAIN = 'error', 'real-time factor', 'largest strain'


def write_choice(
        path: Path, row: Row, budget: Budget, scene_name: str, scene: Scene, *,
        only_changes: bool = True) -> None:
    """
    Write the parameters of ``row``, and where they come from.

    :param only_changes: leave out those that ``scene`` has already
    :raises ClothSimError: when the file can't be written
    """
    values = row.setting.values
    if only_changes:
        changed = Scene({**scene.values, **values})
        values = {name: value for name, value in values.items() if changed[name] != scene[name]}
    head = [
        f'For {scene_name}: {budget.in_words()}.',
        'Written by `cloth_sim study`; give it after the file of the scene.',
        f'device: {row.run.device}',
        f'version: {row.run.version}',
        f'scene sha256: {Run("", dict(scene.values)).scene_sha256}',
        f'nodes: {scene.rows} x {scene.cols}',
        f'{budget.option}: {budget.limit:g}',
        *([f'{_OWN_ERROR}: {row.scene.position:.2e} of the side'] if row.scene else []),
        f'{_OWN_SPEED}: {1.0 / row.cost:.2f}',
        f'{_OWN_STRAIN}: {row.peak_strain:.3f}']
    body = yaml.safe_dump({'/**': {'ros__parameters': values}}, sort_keys=False)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(''.join(f'# {line}\n' for line in head) + body, encoding='utf-8')
    except OSError as error:
        raise ClothSimError(f'{path} cannot be written: {error}') from error


def read_choice(path: Path) -> tuple[dict[str, Any], Budget, str]:
    """Return parameters and budget of a file that ``write_choice`` made, and what it tells."""
    values = load_parameters(path)
    told = dict(
        line.removeprefix('# ').split(': ', 1)
        for line in read_regular(path, MOST_BYTES).decode().splitlines()
        if line.startswith('# ') and ': ' in line)
    summary = ', '.join(
        f'{name} {told[name]}' for name in (_OWN_ERROR, _OWN_SPEED, _OWN_STRAIN) if name in told)
    for budget in BUDGETS:
        if budget.option in told:
            try:
                return values, budget(float(told[budget.option])), summary
            except ValueError:
                break  # a word where a number should be tells no more than nothing
    raise ClothSimError(
        f'{path} does not state its budget: give a file that '
        f'{" or ".join(f"--{budget.option}" for budget in BUDGETS)} wrote')
