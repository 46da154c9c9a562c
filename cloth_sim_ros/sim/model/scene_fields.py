# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Every parameter of a scene: what Scene reads is what the node declares."""

from collections.abc import Sequence
from dataclasses import dataclass
import math
from typing import Any

from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.pins import PIN_NAMES

# Max. elements of a list [1].
MOST_ELEMENTS = 100_000
# Max. substeps of a dt [1].
MOST_SUBSTEPS = 100000
# Max. speed of the wind along an axis [m/s]: three times that of sound.
FASTEST_WIND = 1000.0
MODES = ('mass_spring', 'constraint', 'adaptive')
FAMILIES = ('structural', 'shear', 'bend')
NO_PRESET = 'none'
PRESETS = ('fast', 'balanced', 'accurate', 'stiff')
MATERIALS = (
    't_shirt', 'underwear', 'denim', 'tablecloth', 'trousers', 'blanket', 'ponte_roma',
    'polyester_jacket', 'sweater', 'swimsuit')
# Which layers of cloth a grasp takes.
ALL_LAYERS = 'all'
TOP_LAYER = 'top'
LAYERS = (ALL_LAYERS, TOP_LAYER)
# Patterns of a cloth.
PLAIN, CHECKED, WOVEN = FABRICS = ('plain', 'checked', 'woven')
_NAMES = {
    bool: 'true or false', int: 'a whole number', float: 'a number', str: 'a word',
}


@dataclass(frozen=True)
class Field:
    """
    A parameter of the scene or of the node.

    :param name: ROS parameter name, dots group
    :param kind: bool, int, float or str; of the elements when ``is_array``
    :param default: used when nothing is given; a tuple when ``is_array``
    :param text: one line for people
    :param unit: SI unit, empty when there is none
    :param low: smallest value allowed
    :param high: largest value allowed
    :param choices: the values allowed, for words
    :param words: what may be given, for words that cannot be counted
    :param is_array: True for a list of ``kind``
    :param is_pair: True for one value, or a list of two: of warp and of weft
    :param live: True when a running node accepts a new value
    """

    name: str
    kind: type
    default: Any
    text: str
    unit: str = ''
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] = ()
    words: str = ''
    is_array: bool = False
    is_pair: bool = False
    live: bool = False

    def check(self, value: Any) -> Any:
        """Return ``value`` in this field's type; ClothSimError says what is wrong with it."""
        if self.is_pair and isinstance(value, Sequence) and not isinstance(value, str):
            return self._check_pair(value)
        if not self.is_array:
            return self._check_one(value)
        if isinstance(value, str) or not isinstance(value, Sequence):
            raise ClothSimError(
                f'{self.name} must be a list, got {shown(value)}: write {self._list_with(value)}')
        if len(value) > MOST_ELEMENTS:
            raise ClothSimError(
                f'{self.name} has {len(value)} elements: give at most {MOST_ELEMENTS}')
        return tuple(self._check_one(element) for element in value)

    def _check_pair(self, values: Sequence[Any]) -> tuple[Any, ...]:
        if len(values) != 2:
            raise ClothSimError(
                f'{self.name} takes one value, or one for warp and one for weft, got '
                f'{len(values)}: write a number or [warp, weft]')
        return tuple(self._check_one(value) for value in values)

    def _check_one(self, value: Any) -> Any:
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        if self.kind is float and is_number:
            value = _as_float(value)
        if self.choices and not (isinstance(value, str) and value in self.choices):
            raise ClothSimError(
                f'{self.name} must be one of {", ".join(self.choices)}, got {shown(value)}')
        is_kind = type(value) is self.kind
        if not is_kind:
            raise ClothSimError(
                f'{self.name} must be {_NAMES[self.kind]}, got {shown(value)}{self._way_out()}')
        if self.kind is float and not math.isfinite(value):
            raise ClothSimError(f'{self.name} must be finite, got {shown(value)}{self._way_out()}')
        too_low = self.low is not None and value < self.low
        too_high = self.high is not None and value > self.high
        if too_low or too_high:
            raise ClothSimError(
                f'{self.name} {shown(value)} is outside its range{self._way_out()}')
        return value

    def _list_with(self, value: Any) -> str:
        if self.kind is str and isinstance(value, str):
            return f'["{cut(value)}"]'
        return f'[...], as in {list(self.default)}' if self.default else '[...]'

    def _way_out(self) -> str:
        if self.words:
            return f': give {self.words}'
        unit = f' {self.unit}' if self.unit else ''
        if self.low is not None and self.high is not None:
            return f': give a value from {self.low:g} to {self.high:g}{unit}'
        return f': give a value in {self.unit}' if self.unit else ''


def _as_float(number: int | float) -> float:
    try:
        return float(number)
    except OverflowError:
        return math.inf if number > 0 else -math.inf


SCENE_FIELDS = (
    Field('preset', str, NO_PRESET, 'measured values for time-stepping parameters that are not '
          'set explicitly; see config/presets/', choices=(NO_PRESET, *PRESETS)),
    Field('mode', str, 'mass_spring', 'initial simulation mode', choices=MODES, live=True),
    Field('rows', int, 32, 'number of rows of nodes, along the height', low=1, high=8192),
    Field('cols', int, 32, 'number of columns of nodes, along the width', low=1, high=8192),
    Field('width', float, 1.0, 'length of a row', 'm', low=1e-4, high=1e5),
    Field('height', float, 1.0, 'length of a column', 'm', low=1e-4, high=1e5),
    Field('shape.outline', float, (), 'corners of the cloth that is cut out of width x height: x '
          'and y of each, from its middle, y towards row 0; empty for all of it', 'm', low=-1e5,
          high=1e5, is_array=True),
    Field('shape.disc', float, 0.0, 'diameter of a round cloth; 0 for another shape', 'm', low=0.0,
          high=1e5),
    Field('shape.holes', float, (), 'corners of holes, x and y of each, hole after hole', 'm',
          low=-1e5, high=1e5, is_array=True),
    Field('shape.hole_corners', int, (), 'how many corners each hole has; empty for a single hole',
          low=3, high=100000, is_array=True),
    Field('shape.mask', str, '', 'image that is laid over width x height: white is cloth; a path, '
          'from the folder of the scene file, or a data URL of a PNG',
          words='the path of an image'),
    Field('shape.pieces', int, 1, 'max. number of pieces that the shape may fall into', low=1,
          high=1000),
    Field('areal_density', float, 0.2, 'mass per unit area, distributed equally over the nodes; '
          'defaults to 0 if total_mass is given', 'kg/m2', low=0.0, high=1e6),
    Field('total_mass', float, 0.0, 'mass of the whole cloth, distributed equally over the nodes; '
          '0 to derive it from areal_density', 'kg', low=0.0, high=1e12),
    Field('node_mass', float, 0.0, 'mass of each node; 0 to derive it from total_mass or '
          'areal_density', 'kg', low=0.0, high=1e6),
    Field('material.preset', str, NO_PRESET, 'measured fabric that gives mass, stretch and '
          'bending where they are not set explicitly; see `cloth_sim materials`; a cloth without '
          'any material.* and stiffness.* is of trousers, with air.density 1.225',
          choices=(NO_PRESET, *MATERIALS)),
    Field('material.warp', float, 0.0, 'stiffness to stretch along the rows at unchanged width, '
          'from which the springs follow for any grid; 0 to give stiffness.structural and '
          'stiffness.shear instead', 'N/m', low=0.0, high=1e9),
    Field('material.weft', float, 0.0, 'stiffness to stretch along the columns at unchanged '
          'width; 0 for that of material.warp', 'N/m', low=0.0, high=1e9),
    Field('material.shear', float, 0.0, 'shear stiffness, used with material.warp', 'N/m',
          low=0.0, high=1e9),
    Field('stiffness.structural', float, 100.0, 'stiffness of the springs to the 4 adjacent nodes '
          'or, as [warp, weft], along rows and along columns', 'N/m', low=0.0, high=1e9,
          is_pair=True),
    Field('stiffness.shear', float, 100.0, 'stiffness of the springs to the 4 diagonal neighbours',
          'N/m', low=0.0, high=1e9),
    Field('stiffness.bend', float, 10.0, 'stiffness of the springs to the 4 nodes two steps away',
          'N/m', low=0.0, high=1e9),
    Field('bending.rigidity', float, 0.0, 'bending rigidity of the cloth, or [warp, weft] for '
          'bending along rows and along columns; independent of the grid, unlike stiffness.bend',
          'N m', low=0.0, high=1e6, is_pair=True),
    Field('bending.damping', float, 0.0, 'damping of bending.rigidity, as a time: bending that '
          'changes at a rate is resisted like bending by this time the rate (Kelvin-Voigt)', 's',
          low=0.0, high=1e3),
    Field('damping.structural', float, 0.01, 'damping coefficient of the structural springs, or '
          '[warp, weft]', 'N s/m', low=0.0, high=1e6, is_pair=True),
    Field('damping.shear', float, 0.01, 'damping coefficient of the shear springs', 'N s/m',
          low=0.0, high=1e6),
    Field('damping.bend', float, 0.001, 'damping coefficient of the bend springs', 'N s/m',
          low=0.0, high=1e6),
    Field('gravity', float, (0.0, 0.0, -9.81), 'gravitational acceleration, x y z', 'm/s2',
          low=-1e4, high=1e4, is_array=True),
    Field('pins', str, ('top_left', 'top_right'), f'pinned nodes: {PIN_NAMES}',
          words=PIN_NAMES, is_array=True),
    Field('pin_points.positions', float, (), 'positions in the initial pose, as a flat list of '
          'x y z; the node nearest to each is pinned, in addition to pins, which then default to '
          'none', 'm', low=-1e6, high=1e6, is_array=True),
    Field('pin_points.max_distance', float, 0.0, 'largest accepted distance of that node from its '
          'position; 0 for the larger node spacing', 'm', low=0.0, high=1e6),
    Field('pin_speed', float, 1.0, 'speed of a moving pin unless the request specifies one', 'm/s',
          low=1e-6, high=1e6),
    Field('pin.max_force', float, 0.0, 'edge force on a moving pin above which it does not move '
          'during a time step; 0 for no limit', 'N', low=0.0, high=1e9),
    Field('start.pose', str, 'horizontal', 'initial pose: horizontal (flat at start.z) or hanging '
          '(upright, with row 0 at the top)', choices=('horizontal', 'hanging')),
    Field('start.z', float, 1.0, 'initial height of the centre of the cloth', 'm',
          low=-1e5, high=1e5),
    Field('start.jitter', float, 0.0, 'largest random initial offset of each free node along each '
          'axis, as a fraction of the node spacing', low=0.0, high=0.5),
    Field('start.seed', int, 0, 'random seed of start.jitter', low=0, high=2**31 - 1),
    Field('dt', float, 0.005, 'time step', 's', low=1e-7, high=1.0),
    Field('auto_substeps', bool, True, 'split each time step into substeps of at most 0.85 times '
          'the stability limit, which covers every shape of the cloth'),
    Field('refine', int, 1, 'multiplier of the number of substeps that auto_substeps chooses; '
          'larger is slower and more accurate', low=1, high=1000),
    Field('substeps', int, 1, 'substeps per time step if auto_substeps is false',
          low=1, high=MOST_SUBSTEPS),
    Field('constraint.hard', str, ('structural', 'shear'), 'edge families constrained to their '
          'rest length in mode constraint', choices=FAMILIES, is_array=True),
    Field('constraint.springs', str, (), 'edge families integrated as implicit springs in '
          'mode constraint; families in neither list are left out there',
          choices=FAMILIES, is_array=True),
    Field('constraint.newton_iterations', int, 2, 'linear solves per implicit substep; 1 as in '
          'the paper', low=1, high=20),
    Field('constraint.strain', float, 0.008, 'strain of a hard edge under the weight of the '
          'whole cloth; smaller is stiffer and needs more solver iterations',
          low=1e-5, high=1.0),
    Field('constraint.max_substeps', int, 32, 'largest number of implicit substeps per time step '
          'that auto_substeps chooses', low=1, high=MOST_SUBSTEPS),
    Field('solver.tolerance', float, 0.02, 'relative error of the change in velocity at which '
          'the linear solver stops; the next solve makes up for it', low=1e-6, high=0.5),
    Field('solver.max_iterations', int, 60, 'maximum number of iterations of the linear '
          'solver', low=1, high=10000),
    Field('solver.preconditioner', str, 'multigrid', 'preconditioner of the linear solver; '
          'block_jacobi needs many more iterations', choices=('multigrid', 'block_jacobi')),
    Field('adaptive.scheme', str, 'constraint', 'how the strain limit is enforced: constraint '
          '(the fastest of the next three at each time), list (the edges at their limit one by '
          'one), lattice (those edges, in passes over all nodes), whole (an implicit step of the '
          'whole cloth) or paper (edges beyond it are pulled to their rest length)',
          choices=('constraint', 'list', 'lattice', 'whole', 'paper')),
    Field('adaptive.threshold', float, 0.1, 'strain limit at which a structural or shear spring '
          'becomes a constraint in mode adaptive', low=0.005, high=0.5),
    Field('air.density', float, 0.0, 'air density, 1.225 at sea level; 0 for no air; 1.225 by '
          'default for a cloth without any material.* and stiffness.*', 'kg/m3',
          low=0.0, high=1e4),
    Field('air.drag', float, 1.17, 'drag coefficient normal to the surface; the default is '
          'that of a square plate', low=0.0, high=1e3),
    Field('air.friction', float, 0.02, 'friction coefficient tangential to the surface',
          low=0.0, high=1e3),
    Field('air.wind', float, (0.0, 0.0, 0.0), 'velocity of the air, x y z', 'm/s',
          low=-FASTEST_WIND, high=FASTEST_WIND, is_array=True),
    Field('gusts.start', float, (), 'start time of each timed gust', 's', low=0.0, high=1e9,
          is_array=True),
    Field('gusts.duration', float, (), 'duration of each timed gust', 's', low=1e-9, high=1e9,
          is_array=True),
    Field('gusts.wind', float, (), 'velocity that each timed gust adds to the wind, as a flat '
          'list of x y z', 'm/s', low=-FASTEST_WIND, high=FASTEST_WIND, is_array=True),
    Field('pushes.start', float, (), 'start time of each timed push', 's', low=0.0, high=1e9,
          is_array=True),
    Field('pushes.duration', float, (), 'duration of each timed push', 's', low=0.0, high=1e9,
          is_array=True),
    Field('pushes.force', float, (), 'total force of each timed push, as a flat list of x y z',
          'N', low=-1e9, high=1e9, is_array=True),
    Field('pushes.center', float, (), 'centre of each pushed sphere, as a flat list of x y z; '
          'ignored if its radius is 0', 'm', low=-1e6, high=1e6, is_array=True),
    Field('pushes.radius', float, (), 'radius of each pushed sphere; 0 to push the whole cloth',
          'm', low=0.0, high=1e6, is_array=True),
    Field('pin_moves.start', float, (), 'start time of each timed pin move', 's', low=0.0,
          high=1e9, is_array=True),
    Field('pin_moves.node', str, (), 'pinned node of each timed move: a corner or "row,col"',
          words='a corner, or a node as "row,col"', is_array=True),
    Field('pin_moves.target', float, (), 'target of each timed move, reached in a straight line, '
          'as a flat list of x y z', 'm', low=-1e6, high=1e6, is_array=True),
    Field('pin_moves.speed', float, (), 'speed of each timed move; empty for pin_speed',
          'm/s', low=1e-6, high=1e6, is_array=True),
    Field('colliders.names', str, (), 'names of the rigid bodies that the cloth touches, each '
          'described by its parameters colliders.NAME.*',
          words='lower-case letters, digits and underscores', is_array=True),
    Field('collider_moves.start', float, (), 'start time of each timed move of a collider', 's',
          low=0.0, high=1e9, is_array=True),
    Field('collider_moves.name', str, (), 'collider of each timed move',
          words='one of colliders.names', is_array=True),
    Field('collider_moves.target', float, (), 'target of the centre in each timed move, reached '
          'in a straight line, as a flat list of x y z', 'm', low=-1e5, high=1e5, is_array=True),
    Field('collider_moves.orientation', float, (), 'orientation at the end of each timed move, '
          'as a flat list of quaternions x y z w; empty to keep the present one',
          low=-1e3, high=1e3, is_array=True),
    Field('collider_moves.speed', float, (), 'speed of each timed move; empty for motion.speed',
          'm/s', low=1e-6, high=1e3, is_array=True),
    Field('collider_moves.angular_speed', float, (), 'angular speed of each timed move; empty '
          'for motion.angular_speed', 'rad/s', low=1e-6, high=1e3, is_array=True),
    Field('grasps.start', float, (), 'time of each timed grasp', 's', low=0.0, high=1e9,
          is_array=True),
    Field('grasps.name', str, (), 'name of each timed grasp',
          words='lower-case letters, digits and underscores', is_array=True),
    Field('grasps.position', float, (), 'position of each timed grasp, as a flat list of x y z',
          'm', low=-1e5, high=1e5, is_array=True),
    Field('grasps.orientation', float, (), 'orientation of each timed grasp, as a flat list of '
          'quaternions x y z w; empty for none', low=-1e3, high=1e3, is_array=True),
    Field('grasps.radius', float, (), 'distance within which each timed grasp takes the free '
          'nodes; 0 to take grasps.count of them', 'm', low=0.0, high=1e5, is_array=True),
    Field('grasps.count', int, (), 'number of nodes that each timed grasp without a radius takes, '
          'the nearest ones; empty for 1', low=1, high=100000, is_array=True),
    Field('grasps.layers', str, (), 'which layers of cloth each timed grasp takes: all within '
          'reach, or the top one of them; empty for all', choices=LAYERS, is_array=True),
    Field('grasps.max_force', float, (), 'pull of the cloth at which each timed grasp loses it; '
          '0 or empty for never', 'N', low=0.0, high=1e9, is_array=True),
    Field('grasps.release', float, (), 'time at which each timed grasp is released; 0 or empty '
          'for never', 's', low=0.0, high=1e9, is_array=True),
    Field('grasp_moves.start', float, (), 'start time of each timed move of a grasp', 's',
          low=0.0, high=1e9, is_array=True),
    Field('grasp_moves.name', str, (), 'grasp of each timed move', words='one of grasps.name',
          is_array=True),
    Field('grasp_moves.target', float, (), 'target of the grasp in each timed move, reached in a '
          'straight line, as a flat list of x y z', 'm', low=-1e5, high=1e5, is_array=True),
    Field('grasp_moves.orientation', float, (), 'orientation at the end of each timed move, as a '
          'flat list of quaternions x y z w; empty to keep the present one', low=-1e3, high=1e3,
          is_array=True),
    Field('grasp_moves.speed', float, (), 'speed of each timed move; empty for motion.speed',
          'm/s', low=1e-6, high=1e3, is_array=True),
    Field('grasp_moves.angular_speed', float, (), 'angular speed of each timed move; empty for '
          'motion.angular_speed', 'rad/s', low=1e-6, high=1e3, is_array=True),
    Field('motion.speed', float, 0.5, 'speed of colliders and grasps whose move sets none, and '
          'the most of those that follow a topic', 'm/s', low=1e-6, high=1e3),
    Field('motion.angular_speed', float, 1.5, 'angular speed of colliders and grasps whose move '
          'sets none, and the most of those that follow a topic', 'rad/s', low=1e-6, high=1e3),
    Field('contact.thickness', float, 0.001, 'thickness of the cloth, half of which its nodes '
          'keep from colliders', 'm', low=0.0, high=1.0),
    Field('contact.features', bool, True, 'let colliders that are thinner than 1.4 cells act on '
          'edges and faces as well, not on nodes alone'),
    Field('contact.compression', float, 1e4, 'pressure at which a cloth between two colliders '
          'would be compressed to nothing; it grows in proportion to the compression', 'Pa',
          low=0.0, high=1e9),
    Field('self_contact.enabled', bool, False, 'let layers of the cloth touch each other instead '
          'of passing through; in mode mass_spring'),
    Field('self_contact.thickness', float, 0.001, 'least distance of two layers, from middle to '
          'middle; at most half a cell', 'm', low=1e-6, high=1.0),
    Field('self_contact.friction', float, 0.3, 'coefficient of friction of the cloth on itself',
          low=0.0, high=10.0),
    Field('cameras.names', str, (), 'names of the cameras that look at the cloth, each described '
          'by its parameters cameras.NAME.*',
          words='lower-case letters, digits and underscores', is_array=True),
    Field('look.fabric', str, 'plain', 'pattern of the cloth in pictures of cameras: of one '
          'colour, checks of two, or warp and weft of two', choices=FABRICS),
    Field('look.color', float, (0.45, 0.60, 0.76), 'red green blue of the side of the cloth that '
          'is up when it lies flat, of every other check, or of the warp', low=0.0, high=1.0,
          is_array=True),
    Field('look.back_color', float, (0.52, 0.64, 0.77), 'the same of its other side', low=0.0,
          high=1.0, is_array=True),
    Field('look.second_color', float, (0.97, 0.96, 0.93), 'red green blue of the ground of '
          'checks, or of the weft', low=0.0, high=1.0, is_array=True),
    Field('look.pitch', float, 0.02, 'side of a check, or distance of two threads', 'm', low=1e-5,
          high=1e3),
    Field('look.texture', str, '', 'image that is printed on the side of the cloth that is up '
          'when it lies flat, instead of a fabric; a path, from the folder of the scene file',
          words='the path of an image'),
    Field('look.backdrop', str, '', 'image that fills the picture where nothing is, instead of '
          'look.background; likewise', words='the path of an image'),
    Field('look.background', float, (0.75, 0.80, 0.86), 'red green blue where nothing is',
          low=0.0, high=1.0, is_array=True),
    Field('look.sun', float, (0.4, 0.5, 1.0), 'direction to the sun, x y z of any length',
          low=-1e3, high=1e3, is_array=True),
    Field('look.shadow', float, 0.008, 'radius of the soft edge of shadows', 'm', low=1e-4,
          high=1e2),
    Field('layout', str, 'fused', 'fused: forces and update in one shader pass; paper: the two '
          'passes of the paper, a baseline for benchmarks', choices=('fused', 'paper')),
    Field('loads', str, 'auto', 'how shaders read the state; auto chooses for the device: what '
          '`cloth_sim tune` has found, or texture on software devices and storage on a GPU',
          choices=('auto', 'texture', 'storage')),
    Field('block', int, 0, 'side of the block of nodes that one shader invocation computes; 0 '
          'to choose it for the device, as loads auto does', low=0, high=4),
)
