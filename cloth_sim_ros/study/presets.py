# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Derive the values of the parameter `preset` from a tradeoff study of a scene.

Only settings that keep the springs of the scene are considered: a preset does not change the
cloth. The file of each preset states its scene, criterion, error and real-time factor. The preset
stiff is for scenes of stiff springs and light nodes, and is only made if it is requested.

For example:
  cloth_sim study presets config/studies/two_corners.yaml
  cloth_sim study presets config/studies/two_corners.yaml --write config/presets
  cloth_sim study presets config/studies/light_cloth.yaml --only stiff --write config/presets
"""

from argparse import ArgumentParser
from argparse import Namespace
from dataclasses import replace
from pathlib import Path

from cloth_sim_ros.sim.model.scene_fields import PRESETS
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.trade.choice import ErrorBudget
from cloth_sim_ros.study.trade.choice import write_choice
from cloth_sim_ros.study.trade.grid import default_grid_path
from cloth_sim_ros.study.trade.grid import load_grid
from cloth_sim_ros.study.trade.grid import Variant
from cloth_sim_ros.study.trade.measured import measure
from cloth_sim_ros.study.workers import add_run_arguments
from cloth_sim_ros.study.workers import workers_of

TAKES_SCENE = True

# Each is the fastest setting within an error, over the side of the cloth.
BUDGETS = {name: ErrorBudget(error) for name, error in zip(PRESETS, (1e-2, 1e-4, 5e-5, 5e-3))}
# Presets for any scene. Stiff light cloth buckles at once, so that an error of 0.01 % can't be
# resolved: its preset has its own bound.
_USUAL = tuple(name for name in PRESETS if name != 'stiff')


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this study."""
    parser.add_argument('--grid', metavar='GRID.yaml',
                        help='settings to compare (default: those of config/studies/'
                             'tradeoff.yaml)')
    parser.add_argument('--only', nargs='+', choices=PRESETS, default=_USUAL, metavar='NAME',
                        help=f'presets to make, of {", ".join(PRESETS)} (default: '
                             f'{", ".join(_USUAL)})')
    parser.add_argument('--write', metavar='DIR',
                        help='folder of the presets (default: presets in --out)')
    add_run_arguments(parser, 'studies/tradeoff')


def main(args: Namespace) -> int:
    """Choose and write the presets."""
    grid = load_grid(args.grid or default_grid_path())
    grid = replace(grid, variants=(Variant(),), settings=tuple(
        setting for setting in grid.settings if setting.model == 'springs'))
    with ResultsFolder(args.out) as results:
        measured = measure(args.scene, grid, results, workers_of(args))
    folder = Path(args.write or Path(args.out) / 'presets')
    for name in args.only:
        budget = BUDGETS[name]
        row = budget.choose(measured.rows_of(Variant()))
        write_choice(
            folder / f'{name}.yaml', row, budget, args.scene_file, args.scene,
            only_changes=False)
        print(f'{name}: {budget.in_words()}: {row.setting.method}, {row.setting.label}')
    print(f'written to {folder}')
    return 0
