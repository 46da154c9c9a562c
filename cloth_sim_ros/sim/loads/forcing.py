# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What accelerates the nodes in one step besides the springs."""

from dataclasses import dataclass
from typing import Protocol
from typing import TYPE_CHECKING

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.sim.device import bindings

if TYPE_CHECKING:
    from cloth_sim_ros.sim.state import State


class Layers(Protocol):
    """The contact of the cloth with itself in a substep."""

    @property
    def impulse_unit(self) -> float:
        """Get the unit of the impulses of nodes [m/s]."""

    def let_act(self) -> None:
        """Let the contacts act on the velocities that nodes have now."""

    def give(self, held_at: int, *, notes_changes: bool = False) -> None:
        """
        Write the state to come of the nodes that touch.

        :param notes_changes: whether changes of velocity are noted for the limits of edges
        """


class Touch(Protocol):
    """The contacts of the cloth in one step."""

    def set_in(self, program: Program, length: float) -> None:
        """Set contact.glsl in the program in use to a time of ``length`` [s]; bind its record."""

    def begin_explicit(self, step: Program, length: float, *, on_surface: bool) -> None:
        """
        Have ``step``, which is in use, list what is near colliders in explicit substeps.

        :param on_surface: whether thin colliders act on edges and faces as well
        """

    def list_none(self) -> None:
        """Empty that list: an explicit substep is about to be made."""

    def act_after_limits(
            self, state: 'State', length: float, changes: Buffer, held_at: int,
            layers: Layers | None = None) -> None:
        """
        Act on such a substep after its velocities were changed, and add up what is done.

        :param layers: of the cloth that touch, as in act_beside
        """

    def act(self, held_at: int, *, on_surface: bool) -> None:
        """
        Act on an explicit substep that was made, both states of which are bound.

        :param held_at: where its entries of held.glsl are, bound by now; below 0: nowhere
        """

    def move_out(self, state: 'State', length: float) -> None:
        """Move edges and faces out of thin colliders at the end of an implicit substep."""

    def act_beside(self, layers: Layers, held_at: int) -> None:
        """Do the same where ``layers`` of the cloth touch, in turns with them."""

    def begin_try(self) -> None:
        """Begin a substep that may be made again: remember what was done before it."""

    def undo_try(self) -> None:
        """Undo the impulses of that substep."""

    def has_acted(self) -> bool:
        """Return whether colliders may have acted on a node in the explicit substep."""

    def foresee(self, state: 'State', forcing: 'Forcing', ahead: float) -> None:
        """Write the velocities that nodes have on their way through ``ahead`` [s] from now."""

    def begin_substep(self) -> None:
        """Reset whether anything is touched, in an implicit substep."""

    def is_touched(self) -> bool:
        """Return whether a node has touched a collider in the implicit substep."""

    def begin_decision(self) -> None:
        """Reset whether another solve is due."""

    def is_solve_due(self, *, is_exact: bool = False) -> bool:
        """Return whether the last decision has moved nodes by more than a solve leaves."""


@dataclass(frozen=True, eq=False)
class Forcing:
    """
    The loads over one step, weighted by how much of the step they act in.

    :param everywhere: on every free node [m/s2]
    :param pushed_everywhere: True when a push has part in ``everywhere``
    :param regions: what comes on top at each node [m/s2], and how many pushes on regions act
        there; None where there are none
    :param parts: pushes and shares that it was composed of; equal parts act alike
    :param reads_texture: whether shaders read ``regions`` as they read the state, by textures
    :param stand_in: a buffer of the same size, bound where there are no ``regions`` and textures
        would be read: llvmpipe recompiles a shader when a texture is bound that was not there
    :param touch: the colliders in the step; None where there are none
    """

    everywhere: tuple[float, float, float]
    pushed_everywhere: bool = False
    regions: Buffer | None = None
    parts: tuple[object, ...] = ()
    reads_texture: bool = False
    stand_in: Buffer | None = None
    touch: 'Touch | None' = None

    @property
    def has_regions(self) -> bool:
        """Return whether accelerations differ between nodes."""
        return self.regions is not None

    def apply(self, program: Program) -> None:
        """Set the uniforms of applied_acceleration.glsl in the program in use."""
        program.set_vectors('acceleration', self.everywhere)
        program.set_int('has_region_pushes', int(self.has_regions))

    def bind(self) -> None:
        """Bind the regions for the next dispatch, or their stand-in, if there is one."""
        buffer = self.stand_in if self.regions is None else self.regions
        if buffer is not None:
            if self.reads_texture:
                buffer.bind_texture(bindings.REGION_PUSHES)
            else:
                buffer.bind_storage(bindings.REGION_PUSHES)


def touch_of(forcing: Forcing) -> Touch:
    """Return the colliders of ``forcing``, which has some."""
    assert forcing.touch is not None
    return forcing.touch
