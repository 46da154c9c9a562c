# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Fig. 10 and 11 of the paper: the runs they are made of, all of one scene file."""

from collections.abc import Mapping
from dataclasses import dataclass
from dataclasses import field
from pathlib import Path
from typing import Any

from cloth_sim_ros.gl.shared_directory import shader_directory
from cloth_sim_ros.sim.scene import FAMILIES

# [N/m]; explicit springs as stiff as this are stable up to dt = 0.0045 s in that scene.
STIFF = 15000.0
PAPER_CONSTRAINT = {
    'mode': 'constraint', 'constraint.newton_iterations': 1, 'auto_substeps': False}
PAPER_ADAPTIVE = {'mode': 'adaptive', 'adaptive.scheme': 'paper', 'auto_substeps': False}
_MASS_SPRING = {'mode': 'mass_spring'}
_CONSTRAINT = {'mode': 'constraint'}
_ADAPTIVE = {'mode': 'adaptive'}


@dataclass(frozen=True)
class PaperRun:
    """
    One row of a figure.

    :param name: of its recording
    :param label: of its row
    :param changes: parameters that differ from those of the scene file
    :param check_stability: False lets dt pass the stability limit
    """

    name: str
    label: str
    changes: Mapping[str, Any] = field(default_factory=dict)
    check_stability: bool = True


@dataclass(frozen=True)
class PaperFigure:
    """
    A sheet with a row for each run.

    :param times: of its columns [s]
    """

    title: str
    runs: tuple[PaperRun, ...]
    times: tuple[float, ...]


def paper_scene_file() -> Path:
    """Return the scene file; config/ lies beside the shaders, installed or not."""
    return shader_directory().parent / 'config' / 'paper' / 'pushed_cloth.yaml'


def _figure_10() -> PaperFigure:
    stiff = {**_MASS_SPRING, **{f'stiffness.{family}': STIFF for family in FAMILIES}}
    ways = (
        ('mass_spring', 'mass-spring', _MASS_SPRING),
        ('stiff', f'mass-spring, {STIFF:g} N/m', stiff),
        ('stiff_paper', 'the same (paper)', {**stiff, 'auto_substeps': False}),
        ('constraint', 'constraint', _CONSTRAINT),
        ('adaptive', 'adaptive', _ADAPTIVE),
        ('adaptive_paper', 'adaptive (paper)', PAPER_ADAPTIVE))
    return PaperFigure('Fig. 10: pushed from below, dt = 0.005 s', tuple(
        PaperRun(
            name, label, {**changes, 'dt': 0.005}, check_stability='paper' not in name)
        for name, label, changes in ways
    ), (0.2, 0.9, 1.15, 1.5, 2.4))


def _figure_11() -> PaperFigure:
    ways = (
        ('constraint', 'constraint', _CONSTRAINT),
        ('constraint_paper', 'constraint (paper)', PAPER_CONSTRAINT),
        ('adaptive', 'adaptive', _ADAPTIVE),
        ('adaptive_paper', 'adaptive (paper)', PAPER_ADAPTIVE))
    return PaperFigure('Fig. 11: the same push, dt = 0.01 and 0.02 s', tuple(
        PaperRun(
            f'{name}_dt_{dt:g}', f'{label}, dt {dt:g}', {**changes, 'dt': dt},
            check_stability='paper' not in name)
        for name, label, changes in ways for dt in (0.01, 0.02)
    ), (0.9, 1.15, 1.5, 2.0, 2.4))


FIGURES = {'fig10': _figure_10(), 'fig11': _figure_11()}
