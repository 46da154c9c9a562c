# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Every parameter of a scene: what Scene reads is what the node declares."""

from cloth_sim_ros.sim.field import Field
from cloth_sim_ros.sim.pins import PIN_NAMES

MOST_SUBSTEPS = 100000
MODES = ('mass_spring', 'constraint', 'adaptive')
FAMILIES = ('structural', 'shear', 'bend')
FASTEST_WIND = 1000.0
NO_PRESET = 'none'
PRESETS = ('fast', 'balanced', 'accurate')

SCENE_FIELDS = (
    Field('preset', str, NO_PRESET, 'measured values for the stepping parameters that are not set '
          'explicitly; see config/presets/', choices=(NO_PRESET, *PRESETS)),
    Field('mode', str, 'mass_spring', 'initial simulation mode', choices=MODES, live=True),
    Field('rows', int, 32, 'number of nodes along the height', low=1, high=8192),
    Field('cols', int, 32, 'number of nodes along the width', low=1, high=8192),
    Field('width', float, 1.0, 'side length along a row', 'm', low=1e-4, high=1e5),
    Field('height', float, 1.0, 'side length along a column', 'm', low=1e-4, high=1e5),
    Field('areal_density', float, 0.2, 'mass per unit area, distributed equally over the nodes; '
          '0 where total_mass is given', 'kg/m2', low=0.0, high=1e6),
    Field('total_mass', float, 0.0, 'mass of the whole cloth, distributed equally over the nodes; '
          '0 derives it from areal_density', 'kg', low=0.0, high=1e12),
    Field('node_mass', float, 0.0, 'mass of each node; 0 derives it from total_mass or '
          'areal_density', 'kg', low=0.0, high=1e6),
    Field('material.warp', float, 0.0, 'stiffness to stretch along the rows at unchanged width; '
          'with it the springs follow for any grid, 0 leaves them to stiffness.structural and '
          'stiffness.shear', 'N/m', low=0.0, high=1e9),
    Field('material.weft', float, 0.0, 'stiffness to stretch along the columns at unchanged '
          'width; 0 takes material.warp', 'N/m', low=0.0, high=1e9),
    Field('material.shear', float, 0.0, 'stiffness to shear, beside material.warp', 'N/m',
          low=0.0, high=1e9),
    Field('stiffness.structural', float, 100.0, 'stiffness of the springs to the 4 nearest nodes, '
          'or [warp, weft] of those along rows and along columns', 'N/m', low=0.0, high=1e9,
          is_pair=True),
    Field('stiffness.shear', float, 100.0, 'stiffness of the springs to the 4 diagonal nodes',
          'N/m', low=0.0, high=1e9),
    Field('stiffness.bend', float, 10.0, 'stiffness of the springs to the 4 nodes two places away',
          'N/m', low=0.0, high=1e9),
    Field('bending.rigidity', float, 0.0, 'bending rigidity of the cloth, or [warp, weft] of '
          'bends along rows and along columns; the same for any grid, unlike stiffness.bend', 'N m',
          low=0.0, high=1e6, is_pair=True),
    Field('damping.structural', float, 0.01, 'damping of the structural springs, or [warp, weft]',
          'N s/m', low=0.0, high=1e6, is_pair=True),
    Field('damping.shear', float, 0.01, 'damping of the shear springs', 'N s/m',
          low=0.0, high=1e6),
    Field('damping.bend', float, 0.001, 'damping of the bend springs', 'N s/m',
          low=0.0, high=1e6),
    Field('gravity', float, (0.0, 0.0, -9.81), 'gravitational acceleration, x y z', 'm/s2',
          low=-1e4, high=1e4, is_array=True),
    Field('pins', str, ('top_left', 'top_right'), f'nodes held in place: {PIN_NAMES}',
          words=PIN_NAMES, is_array=True),
    Field('pin_points.positions', float, (), 'points of the initial pose, as one flat list of '
          'x y z; the node nearest to each is pinned too, or instead of the default pins',
          'm', low=-1e6, high=1e6, is_array=True),
    Field('pin_points.max_distance', float, 0.0, 'largest distance of that node from its point; 0 '
          'takes the longer distance between neighbouring nodes', 'm', low=0.0, high=1e6),
    Field('pin_speed', float, 1.0, 'speed of a moving pin unless a request gives one', 'm/s',
          low=1e-6, high=1e6),
    Field('pin.max_force', float, 0.0, 'force from its edges above which a moving pin waits for '
          'the next time step; 0 for no limit', 'N', low=0.0, high=1e9),
    Field('start.pose', str, 'horizontal', 'initial pose: horizontal is flat at start.z, hanging '
          'is upright with row 0 at the top', choices=('horizontal', 'hanging')),
    Field('start.z', float, 1.0, 'initial height of the centre of the cloth', 'm',
          low=-1e5, high=1e5),
    Field('start.jitter', float, 0.0, 'largest random offset of each free node along each axis at '
          'the start, as a fraction of the node spacing', low=0.0, high=0.5),
    Field('start.seed', int, 0, 'seed of the random offsets', low=0, high=2**31 - 1),
    Field('dt', float, 0.005, 'time step', 's', low=1e-7, high=1.0),
    Field('auto_substeps', bool, True, 'split each time step into substeps of at most 0.85 of the '
          'stability limit that are stable in any shape of the cloth'),
    Field('refine', int, 1, 'factor on the number of substeps that auto_substeps chooses; larger '
          'is slower and more accurate', low=1, high=1000),
    Field('substeps', int, 1, 'substeps per time step when auto_substeps is false',
          low=1, high=MOST_SUBSTEPS),
    Field('constraint.hard', str, ('structural', 'shear'), 'edge families that keep their length '
          'in mode constraint', choices=FAMILIES, is_array=True),
    Field('constraint.springs', str, (), 'edge families that are implicit springs in mode '
          'constraint; families in neither list are not simulated there',
          choices=FAMILIES, is_array=True),
    Field('constraint.newton_iterations', int, 2, 'linear solves per implicit substep; 1 is the '
          "paper's method", low=1, high=20),
    Field('constraint.strain', float, 0.008, 'strain of a hard edge that carries the weight of '
          'the whole cloth; smaller is stiffer and needs more solver iterations',
          low=1e-5, high=1.0),
    Field('constraint.max_substeps', int, 32, 'largest number of implicit substeps per time step '
          'that auto_substeps chooses', low=1, high=MOST_SUBSTEPS),
    Field('solver.tolerance', float, 0.005, 'relative error of the change in velocity at which '
          'the linear solver stops', low=1e-6, high=0.5),
    Field('solver.max_iterations', int, 60, 'iterations after which the linear solver stops in '
          'any case', low=1, high=10000),
    Field('solver.preconditioner', str, 'multigrid', 'preconditioner of the linear solver; '
          'block_jacobi needs many more iterations', choices=('multigrid', 'block_jacobi')),
    Field('adaptive.scheme', str, 'constraint', 'how a spring is held at its strain limit: '
          'constraint (implicit step) or paper (explicit steps that pull it to rest length)',
          choices=('constraint', 'paper')),
    Field('adaptive.threshold', float, 0.1, 'strain limit at which a structural or shear spring '
          'becomes a constraint in mode adaptive', low=0.005, high=0.5),
    Field('air.density', float, 0.0, 'density of the air, 1.225 at sea level; 0 for no air',
          'kg/m3', low=0.0, high=1e4),
    Field('air.drag', float, 1.17, 'drag coefficient of the surface across its plane, '
          'that of a square plate by default', low=0.0, high=1e3),
    Field('air.friction', float, 0.02, 'friction coefficient of the surface along its plane',
          low=0.0, high=1e3),
    Field('air.wind', float, (0.0, 0.0, 0.0), 'velocity of the air, x y z', 'm/s',
          low=-FASTEST_WIND, high=FASTEST_WIND, is_array=True),
    Field('gusts.start', float, (), 'start time of each timed gust', 's', low=0.0, high=1e9,
          is_array=True),
    Field('gusts.duration', float, (), 'duration of each timed gust', 's', low=1e-9, high=1e9,
          is_array=True),
    Field('gusts.wind', float, (), 'velocity that each timed gust adds to the wind, as one flat '
          'list of x y z', 'm/s', low=-FASTEST_WIND, high=FASTEST_WIND, is_array=True),
    Field('pushes.start', float, (), 'start time of each timed push', 's', low=0.0, high=1e9,
          is_array=True),
    Field('pushes.duration', float, (), 'duration of each timed push', 's', low=0.0, high=1e9,
          is_array=True),
    Field('pushes.force', float, (), 'total force of each timed push, as one flat list of x y z',
          'N', low=-1e9, high=1e9, is_array=True),
    Field('pushes.center', float, (), 'centre of each pushed sphere, as one flat list of x y z; '
          'ignored where the radius is 0', 'm', low=-1e6, high=1e6, is_array=True),
    Field('pushes.radius', float, (), 'radius of each pushed sphere; 0 pushes the whole cloth',
          'm', low=0.0, high=1e6, is_array=True),
    Field('pin_moves.start', float, (), 'start time of each timed pin move', 's', low=0.0,
          high=1e9, is_array=True),
    Field('pin_moves.node', str, (), 'pinned node of each timed move: a corner or "row,col"',
          words='a corner, or a node as "row,col"', is_array=True),
    Field('pin_moves.target', float, (), 'end point of each timed move, reached in a straight '
          'line, as one flat list of x y z', 'm', low=-1e6, high=1e6, is_array=True),
    Field('pin_moves.speed', float, (), 'speed of each timed move; an empty list uses pin_speed',
          'm/s', low=1e-6, high=1e6, is_array=True),
    Field('layout', str, 'fused', 'fused computes forces and update in one pass; paper uses the '
          'two passes of the paper, as a baseline for benchmarks', choices=('fused', 'paper')),
    Field('loads', str, 'auto', 'how shaders read the state; auto chooses the faster way for the '
          'device', choices=('auto', 'texture', 'storage')),
    Field('block', int, 0, 'nodes along each side of the block that one shader invocation '
          'computes; 0 chooses a good value for the device', low=0, high=4),
)
