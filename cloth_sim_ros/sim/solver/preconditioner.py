# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The preconditioners of conjugate gradients: block-Jacobi and geometric multigrid."""

from typing import Protocol

from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.solver_buffers import COARSEST_SIDE
from cloth_sim_ros.sim.solver.solver_buffers import Levels
from cloth_sim_ros.sim.solver.solver_buffers import MOST_TOGETHER
from cloth_sim_ros.sim.solver.solver_buffers import PRECONDITIONED
from cloth_sim_ros.sim.solver.solver_buffers import PRODUCT
from cloth_sim_ros.sim.solver.solver_buffers import SURFACE_VALUE
from cloth_sim_ros.sim.solver.solver_programs import SolverPass
from cloth_sim_ros.sim.solver.solver_programs import SolverPrograms
from cloth_sim_ros.sim.solver.solver_programs import TOGETHER_LOCAL
from cloth_sim_ros.sim.solver.surface_contacts import DEFECT
from cloth_sim_ros.sim.solver.surface_contacts import SMOOTHED
from cloth_sim_ros.sim.solver.surface_contacts import SolverSurface

# Chebyshev steps on the coarsest level [1]; chosen: 5 and 20 change iterations by +3 and 0 %
# (constants.py --only _COARSEST_STEPS).
_COARSEST_STEPS = 10
_OF_COARSEST = {'COARSEST_SIDE': COARSEST_SIDE, 'COARSEST_STEPS': _COARSEST_STEPS}
# Spread of the eigenvalues there [1] by the weight of the heaviest edge, over the mass of a coarse
# node; chosen: iterations change by 1 % from 2.5 to 40 (constants.py --only _SPREAD_OF_WEIGHT).
_SPREAD_OF_WEIGHT = 10.0
# Range of that spread [1]; chosen: same bits from 2 to 8, and iterations change by 2 % from 4 to
# 120 (constants.py --only _LEAST_SPREAD _MOST_SPREAD). At a spread of 1 the steps divide by 0.
_LEAST_SPREAD = 4.0
_MOST_SPREAD = 60.0
# Largest eigenvalue of an edge system over its diagonal blocks [1], an upper bound: of an edge
# with the weight a, 2 a (v1^2 + v2^2) >= a (v1 - v2)^2.
_LARGEST_EIGENVALUE = 2.0


class Preconditioner(Protocol):
    """
    Makes PRECONDITIONED from RESIDUAL; begin.comp and update.comp make the first smoothing.

    :param assembly: run once for each system, in stages of passes that do not need each other;
        the first needs no inverse of a block
    :param cycle: run in each iteration
    :param cycle_in_contact: the same where edges or faces are in contact
    """

    is_multigrid: bool
    assembly: list[list[SolverPass]]
    cycle: list[SolverPass]
    cycle_in_contact: list[SolverPass]

    def __init__(
            self, programs: SolverPrograms, levels: Levels,
            surface: SolverSurface | None = None) -> None:
        """Compile the passes."""

    def set_law(self, law: EdgeLaw) -> None:
        """Set what depends on the weights of the edges, besides the weights."""


class BlockJacobi:
    """The inverse of each node's diagonal block. Needs no pass of its own."""

    is_multigrid = False

    def __init__(
            self, programs: SolverPrograms, levels: Levels,
            surface: SolverSurface | None = None) -> None:
        """Leave it all to the update."""
        self.assembly: list[list[SolverPass]] = []
        self.cycle: list[SolverPass] = []
        self.cycle_in_contact: list[SolverPass] = []

    def set_law(self, law: EdgeLaw) -> None:
        """Set nothing."""


# Geometric multigrid: smooth, solve what is left on a lattice half as fine, smooth again.


class Multigrid:
    """
    A V-cycle with two Chebyshev steps of block-Jacobi before and after each coarser level.

    Levels that together fit one workgroup have one pass where a dispatch costs more than it
    computes (a GPU).
    """

    is_multigrid = True

    def __init__(
            self, programs: SolverPrograms, levels: Levels,
            surface: SolverSurface | None = None) -> None:
        """Compile the passes of all levels; one program serves all coarse levels."""
        self._levels = levels
        self._together = _Together(programs, levels) if programs.has_few_dispatches else None
        self._coarsest = self._together.cycle_program if self._together else programs.make(
            'coarsest.comp', **_OF_COARSEST)
        # Levels from here on have no passes of their own.
        self._end = levels.first_together if self._together else levels.coarsest + 1
        self.assembly = self._assembly(programs)
        down, coarse, up = self._cycle(programs)
        self.cycle = [*down, *coarse, *up]
        self.cycle_in_contact = self.cycle if surface is None else [
            *_with_contact(surface, down, _DOWN), *coarse, *_with_contact(surface, up, _UP)]

    def set_law(self, law: EdgeLaw) -> None:
        """Set the eigenvalues to damp on the coarsest level."""
        cloth, coarsest = self._levels.cloth, self._levels.layouts[-1]
        share = coarsest.rows * coarsest.cols / (cloth.rows * cloth.cols)
        spread = 1.0 + _SPREAD_OF_WEIGHT * law.largest_weight * share
        spread = min(max(spread, _LEAST_SPREAD), _MOST_SPREAD)
        least = _LARGEST_EIGENVALUE / spread
        self._coarsest.use()
        self._coarsest.set_float('middle', (_LARGEST_EIGENVALUE + least) / 2.0)
        self._coarsest.set_float('half_width', (_LARGEST_EIGENVALUE - least) / 2.0)

    def _assembly(self, programs: SolverPrograms) -> list[list[SolverPass]]:
        layouts = self._levels.layouts
        stages = [[SolverPass(
            programs.make('coarsen_cloth.comp'), layouts[1].node_groups, level=1)]]
        coarsen, invert = programs.make('coarsen.comp'), programs.make('invert.comp')
        for level in range(1, self._end):
            stages.append([SolverPass(invert, layouts[level].node_groups, level=level)])
            if level + 1 < self._end:
                stages[-1].append(
                    SolverPass(coarsen, layouts[level + 1].node_groups, level=level + 1))
        if self._together:
            if self._end == 1:
                stages.append([])
            stages[-1].append(self._together.assembly)
        return stages

    def _cycle(
            self, programs: SolverPrograms,
            ) -> tuple[list[SolverPass], list[SolverPass], list[SolverPass]]:
        """Return the passes over the cloth, over what is coarser, and over the cloth again."""
        layouts, last = self._levels.layouts, self._levels.coarsest
        restrict = programs.make('restrict.comp')
        of_cloth, of_level = _Smoothing(programs, 'cloth_'), _Smoothing(programs, '')
        down: list[SolverPass] = []
        up: list[SolverPass] = []
        passes = [
            self._together.cycle if self._together
            else SolverPass(self._coarsest, (1, 1), level=last)]
        for level in reversed(range(min(self._end, last))):
            smoothing = of_level if level else of_cloth
            if level + 1 < self._end:
                passes.insert(0, SolverPass(
                    restrict, _restrict_groups(layouts[level + 1]), level=level + 1))
            down = smoothing.down(level, layouts[level].groups)
            up = smoothing.up(level, layouts[level].groups)
            if level:
                passes = [*down, *passes, *up]
        return down, passes, up


class _Together:
    """
    The passes over all levels that fit one workgroup.

    ``cycle_program`` is the program of ``cycle``; it takes the uniforms of coarsest.comp as well.
    """

    def __init__(self, programs: SolverPrograms, levels: Levels) -> None:
        """Compile both."""
        defines = {'TOGETHER_LOCAL': TOGETHER_LOCAL, 'MOST_TOGETHER': MOST_TOGETHER}
        ends = {'first_level': levels.first_together, 'coarsest': levels.coarsest}
        # It reads what other invocations of it have written, which textures need not show.
        systems = programs.make('coarse_systems.comp', **defines, LOADS_TEXTURE=0)
        self.cycle_program = programs.make('coarse_levels.comp', **defines, **_OF_COARSEST)
        self.assembly, self.cycle = (
            SolverPass(program, (1, 1), **ends) for program in (systems, self.cycle_program))


# What the passes over the cloth multiply, and where they leave what: by solver_fields.py SMOOTHED,
# DEFECT and CORRECTED are in the place of PRODUCT, SMOOTHED_TWICE in that of PRECONDITIONED.
_DOWN = ((PRODUCT, PRECONDITIONED, SMOOTHED, 0), (PRECONDITIONED, PRODUCT, DEFECT, 0))
_UP = (
    (SURFACE_VALUE, PRODUCT, SMOOTHED, 0), (PRODUCT, PRECONDITIONED, SMOOTHED, 1))


def _with_contact(
        surface: SolverSurface, passes: list[SolverPass],
        fields: tuple[tuple[int, int, int, int], ...]) -> list[SolverPass]:
    """Return each of ``passes`` with that of the contacts after it."""
    return [each for made, (field, into, kind, goes_up) in zip(passes, fields) for each in (
        made, surface.adds_to(kind, field, into, goes_up=goes_up))]


def _restrict_groups(layout: Layout) -> tuple[int, int]:
    # Two nodes along each side an invocation.
    across, down = (-(-groups // 2) for groups in layout.node_groups)
    return across, down


class _Smoothing:
    """The smoothing of the cloth or of the coarse levels; restrict.comp makes its first step."""

    def __init__(self, programs: SolverPrograms, prefix: str) -> None:
        self._smooth = programs.make(f'{prefix}smooth.comp')
        self._correct = programs.make(f'{prefix}correct.comp')

    def down(self, level: int, groups: tuple[int, int]) -> list[SolverPass]:
        smooth, find_defect = (SolverPass(
            self._smooth, groups, level=level, goes_up=False, finds_defect=finds_defect)
            for finds_defect in (False, True))
        return [smooth, find_defect]

    def up(self, level: int, groups: tuple[int, int]) -> list[SolverPass]:
        return [SolverPass(self._correct, groups, level=level), SolverPass(
            self._smooth, groups, level=level, goes_up=True, finds_defect=False)]
