# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The static description of a cloth, read from parameters."""

from collections import Counter
from collections.abc import Iterable
from collections.abc import Mapping
from functools import cached_property
from itertools import repeat
from typing import Any

from cloth_sim_ros.files.close_name import close_name
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.arguments import integer
from cloth_sim_ros.sim.arguments import mapping
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model import grid
from cloth_sim_ros.sim.model.cameras import cameras_of
from cloth_sim_ros.sim.model.cells import Cells
from cloth_sim_ros.sim.model.colliders import colliders_of
from cloth_sim_ros.sim.model.colliders import is_thin
from cloth_sim_ros.sim.model.frame_paths import FrameMove
from cloth_sim_ros.sim.model.given_values import completed
from cloth_sim_ros.sim.model.grasp_request import GraspRequest
from cloth_sim_ros.sim.model.grid import near_node
from cloth_sim_ros.sim.model.look import look_of
from cloth_sim_ros.sim.model.materials import of_direction
from cloth_sim_ros.sim.model.materials import spring_stiffness
from cloth_sim_ros.sim.model.materials import WARP
from cloth_sim_ros.sim.model.materials import WEFT
from cloth_sim_ros.sim.model.named_fields import all_fields
from cloth_sim_ros.sim.model.pins import checked_node
from cloth_sim_ros.sim.model.pins import only_node
from cloth_sim_ros.sim.model.pins import PinMove
from cloth_sim_ros.sim.model.pins import pinned_nodes
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.model.scene_fields import ALL_LAYERS
from cloth_sim_ros.sim.model.scene_fields import FAMILIES
from cloth_sim_ros.sim.model.scene_fields import Field
from cloth_sim_ros.sim.model.shape import cells_of
from cloth_sim_ros.sim.model.shape import embedded_mask
from cloth_sim_ros.sim.model.shape import is_shaped
from cloth_sim_ros.sim.model.wind import Gust
import numpy as np

GIVE_SCENE = "write Scene({'rows': 32}), or load_scene(path)"
# Max. suggestions for a name that several groups have [1], so that the message is read.
_MOST_MEMBERS = 4
# Groups of parameters in which each body has a group of its own.
_WITH_NAMES = ('colliders', 'cameras')


class Scene:
    """
    A checked, immutable set of scene parameters.

    :param values: dotted parameter names and values; omitted ones have their defaults
    :raises ClothSimError: for an unknown name, a wrong type or a value outside its range
    """

    def __init__(self, values: Mapping[str, Any] | None = None) -> None:
        """Check ``values`` against the field table."""
        values = {} if values is None else mapping(
            values, 'the values of a scene', "give parameters by name, {'rows': 32}")
        fields = all_fields(values)
        refuse_unknown(values, fields)
        by_name = {field.name: field for field in fields}
        given = completed({name: by_name[name].check(value) for name, value in values.items()})
        self.values = {
            field.name: field.check(given.get(field.name, field.default)) for field in fields}
        if self.rows * self.cols < 2:
            raise ClothSimError(
                f'a cloth needs 2 nodes or more, got rows {self.rows} x cols {self.cols}: '
                'raise one of them')
        for name in ('gravity', 'air.wind'):
            if len(self[name]) != 3:
                raise ClothSimError(
                    f'{name} needs 3 components, got {len(self[name])}: write [x, y, z]')
        if self.has_air and min(self.rows, self.cols) < 2:
            raise ClothSimError(
                f'air acts on areas, and a chain of rows {self.rows} x cols {self.cols} has none: '
                'give 2 or more of both, or set air.density: 0')
        self._stiffness = spring_stiffness(self.values, self.spacing, (self.rows, self.cols))
        for family in FAMILIES:
            if family in self['constraint.hard'] and family in self['constraint.springs']:
                raise ClothSimError(
                    f'{family} edges are in constraint.hard and in constraint.springs: remove '
                    'them from one')
        self._check_mass()
        # The file may be gone when a recording is simulated again.
        self.values['shape.mask'] = embedded_mask(self['shape.mask'])
        self.cells = self._make_cells()
        self.colliders = colliders_of(self.values)
        self.cameras = cameras_of(self.values)
        self.look = look_of(self.values)
        if self.cameras and min(self.rows, self.cols) < 2:
            raise ClothSimError(
                f'cameras see surfaces, and a chain of rows {self.rows} x cols {self.cols} has '
                'none: give 2 or more of both, or leave cameras.names out')
        self._check_contact()
        self._check_self_contact()
        self.pinned_nodes()
        self.timed_pushes()
        self.timed_pin_moves()
        self.gusts()
        self.timed_collider_moves()
        self.timed_grasps()
        self.timed_grasp_moves()

    def __getitem__(self, name: str) -> Any:
        """Return the value of the parameter ``name``; ClothSimError when there is none."""
        try:
            return self.values[name]
        except (KeyError, TypeError):
            known = list(self.values)
        hint = _hint(name, known) if isinstance(name, str) else 'give its name'
        raise ClothSimError(f'there is no parameter {shown(name)}: {hint}')

    @property
    def rows(self) -> int:
        """Nodes along the height."""
        return self['rows']

    @property
    def cols(self) -> int:
        """Nodes along the width."""
        return self['cols']

    @property
    def node_count(self) -> int:
        """Nodes in all."""
        return self.rows * self.cols

    @property
    def spacing(self) -> tuple[float, float]:
        """Rest distance of neighbours along a row and along a column [m]."""
        return grid.spacing(self.rows, self.cols, self['width'], self['height'])

    @property
    def mass(self) -> float:
        """Mass of the cloth [kg]; a chain's areal mass counts the whole width x height."""
        count = self.node_count if self.cells is None else self.cells.count
        return count * self.node_mass

    @property
    def node_mass(self) -> float:
        """Mass of a node [kg]; of one inside a cloth of cells, which has that of a cell."""
        if self['node_mass'] > 0.0:
            return self['node_mass']
        if self.cells is not None and not self['total_mass']:
            dx, dy = self.spacing
            return self['areal_density'] * dx * dy
        total = self['total_mass'] or self['areal_density'] * self['width'] * self['height']
        return total / (self.node_count if self.cells is None else self.cells.count)

    @property
    def mass_per_area(self) -> float:
        """Mass per area of the cloth at rest [kg/m2]."""
        if self.cells is None:
            return self.node_mass * self.node_count / (self['width'] * self['height'])
        dx, dy = self.spacing
        return self.node_mass / (dx * dy)

    @cached_property
    def node_shares(self) -> np.ndarray:
        """Mass of each node over ``node_mass``, (rows, cols)."""
        if self.cells is None:
            # Takes no memory: a cloth can have millions of nodes.
            return np.broadcast_to(1.0, (self.rows, self.cols))
        return self.cells.node_shares

    @cached_property
    def present_nodes(self) -> np.ndarray:
        """Which nodes there are, (rows, cols) bool: those of a cell, where a shape is cut."""
        return self.node_shares > 0.0

    @property
    def has_gaps(self) -> bool:
        """Return whether some nodes of the lattice are not there."""
        return self.cells is not None and not bool(self.present_nodes.all())

    def checked_node(self, row: int, col: int) -> tuple[int, int]:
        """Return ``row`` and ``col`` as ints; ClothSimError when there is no such node."""
        return checked_node(row, col, self.rows, self.cols, self.present_nodes)

    @property
    def thin_colliders(self) -> tuple[int, ...]:
        """Return the numbers of the colliders that act on edges and faces, in modes that can."""
        if not self['contact.features'] or min(self.rows, self.cols) < 2:
            return ()
        return tuple(
            number for number, collider in enumerate(self.colliders)
            if is_thin(collider, self.spacing))

    @cached_property
    def spanned(self) -> tuple[int, int]:
        """Return how many rows and columns of nodes the cloth spans; a shape may leave some."""
        if not self.has_gaps:
            return self.rows, self.cols
        rows, cols = np.nonzero(self.present_nodes)
        return int(np.ptp(rows)) + 1, int(np.ptp(cols)) + 1

    @property
    def cut_cells(self) -> np.ndarray | None:
        """Return which cells there are, (rows - 1, cols - 1) bool; None where all are."""
        if self.cells is None or bool(self.cells.present.all()):
            return None
        return self.cells.present

    def stiffness(self, family: str, direction: int | None = None) -> float:
        """
        Return the stiffness of the springs of a family [N/m].

        :param family: structural, shear or bend
        :param direction: WARP for those along rows, WEFT for those along columns; None for the
            larger of both
        """
        return of_direction(
            self._stiffness[checked_family(family)], checked_direction(direction))

    def damping(self, family: str, direction: int | None = None) -> float:
        """Return the damping of the springs of a family [N s/m]; as ``stiffness``."""
        return of_direction(
            self[f'damping.{checked_family(family)}'], checked_direction(direction))

    @property
    def has_rigidity(self) -> bool:
        """Return whether the cloth resists bending by its rigidity."""
        return max(self.bending) > 0.0

    @property
    def has_bending_damping(self) -> bool:
        """Return whether the cloth resists being bent the more the faster that is."""
        return self.has_rigidity and self['bending.damping'] > 0.0

    @property
    def bending(self) -> tuple[float, float]:
        """Return the resistance to bending along a row and a column [N/m], held/pin_forces.py."""
        (dx, dy), rigidity = self.spacing, self['bending.rigidity']
        return (
            of_direction(rigidity, WARP) * dy / dx**3 if self.cols > 2 else 0.0,
            of_direction(rigidity, WEFT) * dx / dy**3 if self.rows > 2 else 0.0)

    def models(self, family: str) -> bool:
        """Return whether springs of ``family`` do anything in this scene."""
        return self.stiffness(family) > 0.0 or self.damping(family) > 0.0

    @property
    def families(self) -> tuple[str, ...]:
        """Families whose springs do anything in this scene."""
        return tuple(family for family in FAMILIES if self.models(family))

    def rest_positions(self) -> np.ndarray:
        """Return the start pose without random offsets [m], (rows, cols, 3) float64."""
        return grid.rest_positions(
            self.rows, self.cols, self.spacing, self['start.pose'], self['start.z'])

    def start_positions(self) -> np.ndarray:
        """Return the start pose with the random offsets of free nodes [m], (rows, cols, 3)."""
        positions = self.rest_positions()
        if self['start.jitter'] > 0.0:
            random = np.random.default_rng(self['start.seed'])
            reach = self['start.jitter'] * min(self.spacing)
            offsets = random.uniform(-reach, reach, positions.shape)
            positions += np.where(self.pinned_nodes()[..., None], 0.0, offsets)
        return positions

    def pinned_nodes(self) -> np.ndarray:
        """Return which nodes are pinned at the start, (rows, cols) bool."""
        pinned = pinned_nodes(
            self['pins'], self.rows, self.cols,
            present=self.present_nodes if self.has_gaps else None)
        for node in self._nodes_at_points():
            pinned[node] = True
        return pinned

    def timed_pushes(self) -> tuple[Push, ...]:
        """Return the pushes that are part of the scene, in the order given."""
        columns = zip(
            self['pushes.start'], self._timed('pushes.duration'), self._timed('pushes.force', 3),
            self._timed('pushes.center', 3, default=0.0),
            self._timed('pushes.radius', default=0.0))
        return tuple(
            Push.checked(
                force=force, start=start, duration=duration,
                region='sphere' if radius > 0.0 else 'all', center=center, radius=radius)
            for start, (duration,), force, center, (radius,) in columns)

    @property
    def has_air(self) -> bool:
        """Return whether air acts on the cloth."""
        return self['air.density'] > 0.0 and (self['air.drag'] > 0.0 or self['air.friction'] > 0.0)

    def gusts(self) -> tuple[Gust, ...]:
        """Return the gusts that are part of the scene, in the order given."""
        columns = zip(
            self['gusts.start'], self._timed('gusts.duration'), self._timed('gusts.wind', 3))
        return tuple(
            Gust(start, duration, velocity) for start, (duration,), velocity in columns)

    def timed_pin_moves(self) -> tuple[PinMove, ...]:
        """Return the moves of pins that are part of the scene, in the order given."""
        columns = zip(
            self['pin_moves.start'], self._timed('pin_moves.node'),
            self._timed('pin_moves.target', 3),
            self._timed('pin_moves.speed', default=self['pin_speed']))
        moves = []
        pinned = self.pinned_nodes()
        for start, (name,), target, (speed,) in columns:
            row, col = only_node(name, self.rows, self.cols, 'pin_moves.node')
            if not pinned[row, col]:
                raise ClothSimError(
                    f'pin_moves.node has {shown(name)}, which is not pinned: add it to pins')
            moves.append(
                PinMove.checked(row=row, col=col, target=target, speed=speed, start=start))
        return tuple(moves)

    @property
    def has_contact(self) -> bool:
        """Return whether there is anything that the cloth can touch."""
        return bool(self.colliders)

    def timed_collider_moves(self) -> tuple[FrameMove, ...]:
        """Return the moves of colliders that are part of the scene, in the order given."""
        return self._frame_moves('collider_moves', 'colliders.names')

    def timed_grasp_moves(self) -> tuple[FrameMove, ...]:
        """Return the moves of grasps that are part of the scene, in the order given."""
        return self._frame_moves('grasp_moves', 'grasps.name')

    def timed_grasps(self) -> tuple[GraspRequest, ...]:
        """Return the grasps that are part of the scene, in the order given."""
        columns = zip(
            self['grasps.start'], self._timed('grasps.name'), self._timed('grasps.position', 3),
            self._orientations('grasps.orientation'), self._timed('grasps.radius', default=0.0),
            self._timed('grasps.count', default=0),
            self._timed('grasps.layers', default=ALL_LAYERS),
            self._timed('grasps.max_force', default=0.0),
            self._timed('grasps.release', default=0.0))
        return tuple(
            GraspRequest.checked(
                name=name, position=position, orientation=orientation, radius=radius,
                count=0 if radius else count, layers=layers, max_force=max_force, start=start,
                release=release)
            for start, (name,), position, orientation, (radius,), (count,), (layers,),
            (max_force,), (release,) in columns)

    def _frame_moves(self, group: str, names: str) -> tuple[FrameMove, ...]:
        moved = self._timed(f'{group}.name')
        for (name,) in moved:
            if name not in self[names]:
                raise ClothSimError(
                    f'{group}.name has {shown(name)}, which is not one of {names}: add it there')
        columns = zip(
            self[f'{group}.start'], moved, self._timed(f'{group}.target', 3),
            self._orientations(f'{group}.orientation'),
            self._timed(f'{group}.speed', default=self['motion.speed']),
            self._timed(f'{group}.angular_speed', default=self['motion.angular_speed']))
        return tuple(
            FrameMove.checked(
                name=name, target=target, orientation=orientation, speed=speed,
                angular_speed=angular_speed, start=start)
            for start, (name,), target, orientation, (speed,), (angular_speed,) in columns)

    def _orientations(self, name: str) -> Iterable[tuple[float, ...] | None]:
        return self._timed(name, 4) if self[name] else repeat(None)

    def _check_contact(self) -> None:
        if not self.has_contact:
            return
        if self['layout'] == 'paper':
            raise ClothSimError(
                'layout paper has no contact, and colliders.names is not empty: set '
                'layout: fused, or remove the colliders')
        if self['adaptive.scheme'] == 'paper':
            raise ClothSimError(
                'adaptive.scheme paper has no contact, and colliders.names is not empty: set '
                'adaptive.scheme: constraint, or remove the colliders')

    def _check_self_contact(self) -> None:
        if not self['self_contact.enabled']:
            return
        for name, is_other, way_out in (
                ('layout', self['layout'] == 'paper', 'fused'),
                ('adaptive.scheme', self['adaptive.scheme'] == 'paper', 'constraint')):
            if is_other:
                raise ClothSimError(
                    f'{name} paper has no self-contact, and self_contact.enabled is true: set '
                    f'{name}: {way_out}, or self_contact.enabled: false')
        if min(self.rows, self.cols) < 2:
            raise ClothSimError(
                f'a chain of rows {self.rows} x cols {self.cols} has no surface to touch itself '
                'with: give 2 or more of both, or set self_contact.enabled: false')
        thickness, most = self['self_contact.thickness'], 0.5 * min(self.spacing)
        if thickness > most:
            raise ClothSimError(
                f'self_contact.thickness {thickness:g} m is above half a cell, {most:.4g} m: give '
                'a smaller one, or fewer rows and cols')

    def _make_cells(self) -> Cells | None:
        """Return the cells of a fabric; None for the nodes and springs of the paper."""
        is_fabric = self['material.warp'] > 0.0 and self['node_mass'] == 0.0
        is_paper = self['layout'] == 'paper' or self['adaptive.scheme'] == 'paper'
        if is_shaped(self.values):
            self._check_shape()
            return Cells(cells_of(self.values))
        if not is_fabric or is_paper or min(self.rows, self.cols) < 2:
            return None
        return Cells(np.ones((self.rows - 1, self.cols - 1), dtype=bool))

    def _check_shape(self) -> None:
        if min(self.rows, self.cols) < 2:
            raise ClothSimError(
                f'a shape is cut out of cells, and rows {self.rows} x cols {self.cols} have none: '
                'give 2 or more of both')
        others = (
            ('node_mass', self['node_mass'] > 0.0, '0'),
            ('layout', self['layout'] == 'paper', 'fused'),
            ('adaptive.scheme', self['adaptive.scheme'] == 'paper', 'constraint'))
        for name, is_other, none in others:
            if is_other:
                raise ClothSimError(
                    f'{name} {self[name]} is of nodes of equal mass, and a shape is cut out of '
                    f'cells: set {name}: {none}, or leave the shape out')

    def _check_mass(self) -> None:
        given = [name for name in ('total_mass', 'node_mass') if self[name] > 0.0]
        if self['areal_density'] > 0.0 and self['total_mass'] > 0.0:
            given.append('areal_density')
        if len(given) > 1:
            values = ' and '.join(f'{name} {self[name]:g}' for name in given)
            raise ClothSimError(
                f'{values} each set the mass of the cloth: give one of them, and set the others '
                'to 0')
        if not given and self['areal_density'] == 0.0:
            raise ClothSimError(
                'the cloth has no mass, as areal_density is 0: give total_mass [kg], or an '
                'areal_density above 0')

    def _nodes_at_points(self) -> list[tuple[int, int]]:
        flat = self['pin_points.positions']
        if not flat:
            return []  # a cloth of millions of nodes is not laid out for nothing
        if len(flat) % 3:
            raise ClothSimError(
                f'pin_points.positions needs 3 numbers per point, got {len(flat)} in all: give '
                'x, y and z of each point one after the other')
        reach = self['pin_points.max_distance'] or max(
            distance for distance, nodes in zip(self.spacing, (self.cols, self.rows)) if nodes > 1)
        rest = self.rest_positions()
        rest[~self.present_nodes] = np.inf
        found = (
            near_node(rest, flat[i:i + 3], reach, parameter='pin_points.max_distance')
            for i in range(0, len(flat), 3))
        return [(node.row, node.col) for node in found]

    def _timed(
            self, name: str, width: int = 1,
            default: float | str | None = None) -> list[tuple[Any, ...]]:
        """Return the ``width`` entries that each one has in the parameter ``name``."""
        group = name.partition('.')[0]
        entry = {'pushes': 'push', 'gusts': 'gust', 'grasps': 'grasp'}.get(group, 'move')
        count = len(self[f'{group}.start'])
        flat = self[name]
        if not flat and default is not None:
            flat = (default,) * (count * width)
        if len(flat) != count * width:
            raise ClothSimError(
                f'{name} needs {width} per {entry}, {count * width} for the {count} in '
                f'{group}.start, got {len(flat)}: give one entry for each {entry}')
        return [flat[i * width:(i + 1) * width] for i in range(count)]


def checked_family(family: str) -> str:
    """Return ``family``, or raise ClothSimError when there are no such springs."""
    if not isinstance(family, str) or family not in FAMILIES:
        raise ClothSimError(
            f'there are no springs of the family {shown(family)}: give one of '
            f'{", ".join(FAMILIES)}')
    return family


def checked_direction(direction: int | None) -> int | None:
    """Return ``direction``, or raise ClothSimError when it is not WARP, WEFT or None."""
    if direction is not None and integer(direction, 'the direction') not in (WARP, WEFT):
        raise ClothSimError(
            f'the direction must be {WARP} for warp or {WEFT} for weft, got {shown(direction)}: '
            'give one of them, or None for the larger')
    return direction


def refuse_unknown(given: Iterable[str], fields: tuple[Field, ...]) -> None:
    """Raise ClothSimError when ``fields`` lacks one of the names ``given``."""
    known = [field.name for field in fields]
    for name in given:
        if name not in known:
            raise ClothSimError(f'there is no parameter {cut(name)}: {_hint(name, known)}')


def _hint(name: str, known: list[str]) -> str:
    group, _, rest = name.partition('.')
    if group in _WITH_NAMES and '.' in rest:
        body = rest.partition('.')[0]
        if not any(each.startswith(f'{group}.{body}.') for each in known):
            return f'list {cut(body)} in {group}.names'
    counts = Counter(each.partition('.')[0] for each in known if '.' in each)
    groups = sorted(group for group, count in counts.items() if count > 1)
    close = close_name(name, known + groups)
    if close is None:
        members = [each for each in known if each.endswith(f'.{name}')]
        if 1 <= len(members) <= _MOST_MEMBERS:
            return f'did you mean {" or ".join(members)}?'
        return 'docs/reference/parameters.md lists them all'
    if close in known:
        return f'did you mean {close}?'
    *others, last = [each for each in known if each.startswith(f'{close}.')]
    return f'did you mean {", ".join(others)} or {last}?'
