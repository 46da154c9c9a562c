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
NO_PRESET = 'none'
PRESETS = ('fast', 'balanced', 'accurate')

SCENE_FIELDS = (
    Field('preset', str, NO_PRESET, 'measured choice of how to step the scene, of what is not set '
          'here: config/presets/ tells', choices=(NO_PRESET, *PRESETS)),
    Field('mode', str, 'mass_spring', 'simulation mode at the start', choices=MODES, live=True),
    Field('rows', int, 32, 'nodes along the height', low=1, high=8192),
    Field('cols', int, 32, 'nodes along the width', low=1, high=8192),
    Field('width', float, 1.0, 'side along a row', 'm', low=1e-4, high=1e5),
    Field('height', float, 1.0, 'side along a column', 'm', low=1e-4, high=1e5),
    Field('areal_density', float, 0.2, 'mass of the cloth per area, shared evenly by the nodes; '
          '0 when total_mass is given', 'kg/m2', low=0.0, high=1e6),
    Field('total_mass', float, 0.0, 'mass of the whole cloth, shared evenly by the nodes; 0 takes '
          'it from areal_density', 'kg', low=0.0, high=1e12),
    Field('node_mass', float, 0.0, 'mass of each node; 0 takes it from total_mass or '
          'areal_density', 'kg', low=0.0, high=1e6),
    Field('stiffness.structural', float, 100.0, 'of the springs to the 4 nearest nodes',
          'N/m', low=0.0, high=1e9),
    Field('stiffness.shear', float, 100.0, 'of the springs to the 4 diagonal nodes',
          'N/m', low=0.0, high=1e9),
    Field('stiffness.bend', float, 10.0, 'of the springs to the 4 nodes two places away',
          'N/m', low=0.0, high=1e9),
    Field('damping.structural', float, 0.01, 'of the structural springs', 'N s/m',
          low=0.0, high=1e6),
    Field('damping.shear', float, 0.01, 'of the shear springs', 'N s/m', low=0.0, high=1e6),
    Field('damping.bend', float, 0.001, 'of the bend springs', 'N s/m', low=0.0, high=1e6),
    Field('gravity', float, (0.0, 0.0, -9.81), 'acceleration on every free node, x y z', 'm/s2',
          low=-1e4, high=1e4, is_array=True),
    Field('pins', str, ('top_left', 'top_right'), f'nodes held in place: {PIN_NAMES}',
          words=PIN_NAMES, is_array=True),
    Field('pin_points.positions', float, (), 'points of the start pose, x y z one after the '
          'other: the node nearest to each is held in place too, or instead of the default pins',
          'm', low=-1e6, high=1e6, is_array=True),
    Field('pin_points.max_distance', float, 0.0, 'how far that node may be from its point; 0 '
          'takes the longer distance between neighbouring nodes', 'm', low=0.0, high=1e6),
    Field('pin_speed', float, 1.0, 'speed of a moving pin where none is given', 'm/s',
          low=1e-6, high=1e6),
    Field('pin.max_force', float, 0.0, 'pull of its edges at which a moving pin stands still for '
          'the next dt; 0 for none', 'N', low=0.0, high=1e9),
    Field('start.pose', str, 'horizontal', 'horizontal: flat at start.z; hanging: upright, '
          'row 0 on top', choices=('horizontal', 'hanging')),
    Field('start.z', float, 1.0, 'height of the cloth centre at the start', 'm',
          low=-1e5, high=1e5),
    Field('start.jitter', float, 0.0, 'random offset of each free node at the start, over the '
          'node spacing', low=0.0, high=0.5),
    Field('start.seed', int, 0, 'of the random offsets', low=0, high=2**31 - 1),
    Field('dt', float, 0.005, 'time step', 's', low=1e-7, high=1.0),
    Field('auto_substeps', bool, True, 'split dt so that each substep keeps to 0.85 of the '
          'stability limit, and is stable in any shape'),
    Field('refine', int, 1, 'times the substeps that auto_substeps finds necessary: more are '
          'slower and more exact', low=1, high=1000),
    Field('substeps', int, 1, 'substeps in each dt when auto_substeps is false',
          low=1, high=MOST_SUBSTEPS),
    Field('constraint.hard', str, ('structural', 'shear'), 'edges that keep their length in mode '
          'constraint', choices=FAMILIES, is_array=True),
    Field('constraint.springs', str, (), 'edges that are implicit springs there, with their '
          'stiffness and damping; all others are left out', choices=FAMILIES, is_array=True),
    Field('constraint.newton_iterations', int, 2, 'linear solves in each substep; 1 is the '
          "paper's method", low=1, high=20),
    Field('constraint.strain', float, 0.008, 'strain of a hard edge that carries the weight of '
          'the whole cloth; less is harder and takes more solver iterations', low=1e-5, high=1.0),
    Field('constraint.max_substeps', int, 32, 'most substeps of dt that auto_substeps takes '
          'there', low=1, high=MOST_SUBSTEPS),
    Field('solver.tolerance', float, 0.005, 'error at which the linear solver stops, over the '
          'change of velocity that it solves for', low=1e-6, high=0.5),
    Field('solver.max_iterations', int, 60, 'iterations after which it stops in any case',
          low=1, high=10000),
    Field('solver.preconditioner', str, 'multigrid', 'multigrid, or block_jacobi, which needs '
          'many more iterations', choices=('multigrid', 'block_jacobi')),
    Field('adaptive.scheme', str, 'constraint', 'what holds a spring at its limit: constraint '
          '(the implicit step), or paper (explicit steps that pull it to rest length)',
          choices=('constraint', 'paper')),
    Field('adaptive.threshold', float, 0.1, 'strain at which a structural or shear spring '
          'becomes a constraint in mode adaptive', low=0.005, high=0.5),
    Field('pushes.start', float, (), 'start of each timed push', 's', low=0.0, high=1e9,
          is_array=True),
    Field('pushes.duration', float, (), 'length of each timed push', 's', low=0.0, high=1e9,
          is_array=True),
    Field('pushes.force', float, (), 'total force of each timed push, x y z one after the other',
          'N', low=-1e9, high=1e9, is_array=True),
    Field('pushes.center', float, (), 'centre of each timed push, x y z one after the other; '
          'used where the radius is above 0', 'm', low=-1e6, high=1e6, is_array=True),
    Field('pushes.radius', float, (), 'radius of each timed push; 0 pushes the whole cloth',
          'm', low=0.0, high=1e6, is_array=True),
    Field('pin_moves.start', float, (), 'start of each timed move of a pin', 's', low=0.0,
          high=1e9, is_array=True),
    Field('pin_moves.node', str, (), 'the pinned node of each timed move: a corner or "row,col"',
          words='a corner, or a node as "row,col"', is_array=True),
    Field('pin_moves.target', float, (), 'the point each timed move leads to in a straight line, '
          'x y z one after the other', 'm', low=-1e6, high=1e6, is_array=True),
    Field('pin_moves.speed', float, (), 'speed of each timed move; left out, all have pin_speed',
          'm/s', low=1e-6, high=1e6, is_array=True),
    Field('layout', str, 'fused', 'fused: force and update in one pass; paper: the two passes '
          'of the paper, a baseline for benchmarks', choices=('fused', 'paper')),
    Field('loads', str, 'auto', 'how shaders read the state: texture, storage, or the faster '
          'one for the device', choices=('auto', 'texture', 'storage')),
    Field('block', int, 0, 'nodes along each side of one shader invocation; 0 takes the best '
          'for the device', low=0, high=4),
)
