# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Bodies that are thinner than cells hold the cloth between its nodes."""

import warnings

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.stop import StepAbandoned
from cloth_sim_ros.study.energy_account import EnergyAccount
from momenta import momenta_of
import numpy as np
import pytest

# Orientation, quaternion x y z w, of a body whose axis is along y.
ALONG_Y = (0.5**0.5, 0.0, 0.0, 0.5**0.5)
CLEARANCE = 0.0005
CLOTH = {
    'material.preset': 'trousers', 'width': 0.5, 'height': 0.5, 'rows': 9, 'cols': 9, 'dt': 0.005,
    'damping.structural': 0.02, 'damping.shear': 0.01, 'air.density': 0.0, 'pins': ('none',),
    'contact.thickness': 2.0 * CLEARANCE, 'colliders.names': ('body',),
    'colliders.body.friction': 0.5}
CELL = 0.5 / 8
# Between two lines of nodes, and in the middle of a cell.
BETWEEN = (0.5 * CELL, 0.0, 0.0)
WITHIN = (0.5 * CELL, 0.35 * CELL, 0.0)
BODIES = {
    **{f'rod of {radius} m': {'shape': 'capsule', 'size': (radius, 2.0), 'orientation': ALONG_Y}
       for radius in (0.001, 0.003, 0.01, 0.02)},
    'cylinder': {'shape': 'cylinder', 'size': (0.005, 2.0), 'orientation': ALONG_Y},
    'bar': {'shape': 'box', 'size': (0.01, 2.0, 0.006)},
    'edge of a blade': {
        'shape': 'box', 'size': (0.002, 2.0, 0.2), 'position': (*BETWEEN[:2], -0.1)},
    **{f'sphere of {share} cell': {
        'shape': 'sphere', 'size': (share * CELL,), 'position': WITHIN}
       for share in (0.2, 0.5, 0.69)},
    'finger': {'shape': 'capsule', 'size': (0.01, 0.2), 'position': (*WITHIN[:2], -0.1)},
    'small box': {'shape': 'box', 'size': (0.03, 0.02, 0.02), 'position': WITHIN}}

# What each of them is run in.
MODES = {
    'mass_spring': {'mode': 'mass_spring'},
    'adaptive': {'mode': 'adaptive'},
    'adaptive at its limit': {
        'mode': 'adaptive', 'adaptive.threshold': 0.005, 'adaptive.scheme': 'list'},
    'adaptive, the whole cloth': {
        'mode': 'adaptive', 'adaptive.threshold': 0.005, 'adaptive.scheme': 'whole'},
    'constraint': {'mode': 'constraint'}}
# Bodies that modes other than mass_spring meet without --long.
FEW = {'rod of 0.003 m', 'edge of a blade', 'sphere of 0.5 cell', 'finger'}


def in_modes(names, few):
    """Return the cases of modes and names of bodies; few in other modes are short."""
    return pytest.mark.parametrize(('mode', 'name'), [
        pytest.param(
            values, name, id=f'{mode}, {name}',
            marks=[] if mode == 'mass_spring' or name in few else [pytest.mark.long])
        for mode, values in MODES.items() for name in names])


@pytest.fixture(params=MODES.values(), ids=MODES)
def values_of_mode(request):
    """Return the values of each mode."""
    return request.param


def scene_with(body, **more):
    """Return a level cloth just above a body."""
    given = {'position': BETWEEN, **body}
    return Scene({
        **CLOTH, 'start.z': 0.03,
        **{f'colliders.body.{name}': value for name, value in given.items()}, **more})


def deepest(simulation, samples=12):
    """Return how deep the triangles of the cloth are in the body at most [m], by sampling."""
    body, = simulation.colliders
    p = simulation.positions().astype(float)
    upper, lower = p[:-1, :-1], p[1:, 1:]
    right, left = p[:-1, 1:], p[1:, :-1]
    least = np.inf
    for first, second, third in ((upper, left, right), (lower, left, right)):
        for i in range(samples + 1):
            for j in range(samples + 1 - i):
                points = first + (second - first) * (i / samples) + (third - first) * (j / samples)
                least = min(least, float(body.distance(points).min()))
    return CLEARANCE - least


class ForceAccount:
    """What bodies and pins have to have taken, by the momentum of the cloth and its weight."""

    def __init__(self, simulation):
        self._simulation = simulation
        self._scene = simulation.scene
        self._begin = simulation.time
        self._length = self._scene['dt'] / max(simulation.snapshot().substeps, 1)
        self._before = momenta_of(simulation)[0]
        self._window = simulation.open_force_window()

    def close(self):
        """Return the force on all bodies, and by how much all is off; both over the weight."""
        simulation, scene = self._simulation, self._scene
        forces = simulation.frame_forces(self._window)
        force = np.sum([contact.force for contact in forces.contacts], axis=0)
        weight, time = scene.mass * 9.81, simulation.time - self._begin
        # A velocity is that of the middle of its substep, and substeps change.
        fallen = time + 0.5 * (self._length - scene['dt'] / simulation.snapshot().substeps)
        expected = np.array((0.0, 0.0, -weight * fallen))
        expected -= momenta_of(simulation)[0] - self._before
        taken = force + forces.pins.forces.sum(axis=0)
        return force / weight, float(np.abs(taken - expected / time).max() / weight)


# How far the force may be off [1]: solves leave residuals, each of which the next one takes over;
# with limits, a pass that has not found them all after 32 solves drops it (solver_reached).
OFF = {'mass_spring': 1e-4, 'adaptive': 1e-4, 'whole': 5e-3, 'constraint': 1e-3}


def most_off(values):
    """Return it for the values of a mode."""
    return OFF['whole' if values.get('adaptive.scheme') == 'whole' else values['mode']]


@in_modes(BODIES, FEW)
def test_a_thin_body_holds_the_cloth(context, within, mode, name):
    """Cloth would fall through a rod between two lines of nodes."""
    scene = scene_with(BODIES[name], **mode)
    assert scene.thin_colliders == (0,)
    worst = -np.inf
    with Simulation(scene, context=context) as simulation:
        simulation.step(1)
        account = ForceAccount(simulation)
        for _ in range(20):
            simulation.step(5)
            worst = max(worst, deepest(simulation))
        force, off = account.close()
        # Its middle is still above the body.
        assert simulation.positions()[..., 2].max() > -0.05
    within('force, relative to the weight', off, most_off(mode))
    assert force[2] < -0.2
    within('depth of a triangle [m]', worst, 1e-6)


@pytest.mark.parametrize('speed', [5.0, 10.0])
@pytest.mark.parametrize('radius', [0.0005, 0.003])
def test_a_thin_rod_is_not_passed_at_speed(context, within, values_of_mode, radius, speed):
    """Cloth would be on the other side of a rod in one substep."""
    scene = scene_with(
        {'shape': 'capsule', 'size': (radius, 2.0), 'orientation': ALONG_Y}, **values_of_mode)
    with Simulation(scene, context=context) as simulation:
        rest = scene.rest_positions()
        simulation.set_state(rest, np.broadcast_to((0.0, 0.0, -speed), rest.shape))
        worst = -np.inf
        for _ in range(8):
            simulation.step(1)
            worst = max(worst, deepest(simulation))
        heights = simulation.positions()[:, 4:6, 2]
    within('depth of a triangle [m]', worst, 1e-6)
    assert heights.max(axis=1).min() > -0.01


@pytest.mark.parametrize(('nodes', 'radius'), [
    pytest.param(nodes, radius, marks=[] if (nodes, radius) == (16, 0.003) else [pytest.mark.long])
    for nodes in (16, 33, 65) for radius in (0.001, 0.003, 0.01, 0.02)
    # Others are not thin.
    if 2.0 * radius < 1.4 / (nodes - 1)])
@pytest.mark.parametrize('speed', [0.0, 5.0])
def test_a_metre_of_cloth_is_held_at_any_resolution(
        context, within, values_of_mode, nodes, radius, speed):
    """Cloth of other cells would fall through the same rod, or be torn by it."""
    # Between two lines of nodes.
    place = (0.5 / (nodes - 1) if nodes % 2 else 0.0, 0.0, 0.0)
    scene = scene_with(
        {'shape': 'capsule', 'size': (radius, 3.0), 'orientation': ALONG_Y, 'position': place},
        **{'width': 1.0, 'height': 1.0, 'rows': nodes, 'cols': nodes, **values_of_mode})
    worst = -np.inf
    with Simulation(scene, context=context) as simulation:
        rest = scene.rest_positions()
        simulation.set_state(rest, np.broadcast_to((0.0, 0.0, -speed), rest.shape))
        simulation.step(1)
        account = ForceAccount(simulation)
        for _ in range(15):
            simulation.step(3)
            worst = max(worst, deepest(simulation))
        force, off = account.close()
        strain = simulation.measure().max_strain
    within('depth of a triangle [m]', worst, 1e-6)
    within('force, relative to the weight', off, most_off(values_of_mode) * (1.0 + speed))
    within('strain', strain, 0.2)
    assert force[2] < -0.1


def test_a_rod_that_moves_lifts_the_cloth(context, within, values_of_mode):
    """A hand would go through the cloth that it lifts."""
    scene = scene_with(
        {'shape': 'capsule', 'size': (0.004, 2.0), 'orientation': ALONG_Y},
        **{'start.z': 0.02, **values_of_mode})
    with Simulation(scene, context=context) as simulation:
        simulation.move_collider('body', (BETWEEN[0], 0.0, 0.4), speed=1.0)
        worst = -np.inf
        for _ in range(40):
            simulation.step(2)
            worst = max(worst, deepest(simulation))
        middle = simulation.positions()[:, 4:6, 2]
    within('depth of a triangle [m]', worst, 1e-6)
    assert middle.min() > 0.3


def test_an_edge_of_a_pinned_node_is_held(context, within, values_of_mode):
    """Cloth would pass a rod beside the nodes it hangs from, which bear what the rod does not."""
    along_x = (0.0, 0.5**0.5, 0.0, 0.5**0.5)
    rod = {'shape': 'capsule', 'size': (0.004, 2.0), 'orientation': along_x,
           'position': (0.0, 0.25 - 0.5 * CELL, 0.0)}
    scene = scene_with(rod, **{'pins': ('top_edge',), 'start.z': 0.02, **values_of_mode})
    worst = -np.inf
    with Simulation(scene, context=context) as simulation:
        simulation.step(1)
        account = ForceAccount(simulation)
        for _ in range(40):
            simulation.step(5)
            worst = max(worst, deepest(simulation))
        force, off = account.close()
    within('depth of a triangle [m]', worst, 1e-6)
    within('force on rod and pins, relative to the weight', off, most_off(values_of_mode))
    assert force[2] < -0.1


def test_two_fingers_lift_the_cloth(context, within, values_of_mode):
    """A gripper with thin fingers would come up without the cloth."""
    radius, gap = 0.008, 0.00101
    place = {'orientation': ALONG_Y, 'shape': 'capsule', 'size': (radius, 0.02), 'friction': 1.0}
    fingers = {
        f'colliders.{name}.{key}': value for name, height in (
            ('upper', radius + 0.01), ('lower', -radius - CLEARANCE))
        for key, value in {**place, 'position': (*WITHIN[:2], height)}.items()}
    scene = Scene({
        **{name: value for name, value in CLOTH.items() if not name.startswith('colliders.')},
        **fingers, 'colliders.names': ('upper', 'lower'), 'start.z': 0.0, **values_of_mode})
    assert scene.thin_colliders == (0, 1)
    with Simulation(scene, context=context) as simulation:
        simulation.move_collider(
            'upper', (*WITHIN[:2], radius - CLEARANCE + gap), speed=0.1)
        simulation.step(40)
        for name, height in (('upper', radius + gap), ('lower', -radius)):
            simulation.move_collider(name, (*WITHIN[:2], height - CLEARANCE + 0.15), speed=0.3)
        simulation.step(110)
        account = ForceAccount(simulation)
        simulation.step(50)
        _, off = account.close()
        heights = simulation.positions()[..., 2]
    # It hangs from the fingers by their friction.
    assert heights.max() > 0.14
    within('height that the cloth hangs down [m]', 0.15 - heights.min(), 0.36)
    within('force on both fingers, relative to the weight', off, most_off(values_of_mode))


def random_scene(random, values):
    """Return the scene of a random thin body below a cloth, and whether it moves; or None."""
    def length(least, most):
        return float(10.0**random.uniform(np.log10(least), np.log10(most)))

    shape = str(random.choice(['sphere', 'capsule', 'box', 'cylinder']))
    size = {
        'sphere': (length(0.005, 0.04),), 'capsule': (length(0.001, 0.03), length(0.05, 1.0)),
        'cylinder': (length(0.001, 0.03), length(0.02, 1.0)),
        'box': (length(0.002, 0.06), length(0.01, 0.3), length(0.01, 0.3))}[shape]
    nodes = int(random.integers(6, 14))
    x, y = random.uniform(-0.1, 0.1, 2)
    scene = scene_with(
        {'shape': shape, 'size': size, 'orientation': tuple(random.normal(size=4).tolist()),
         'position': (float(x), float(y), -max(size) - 0.02)},
        rows=nodes, cols=nodes, **{
            'start.z': 0.02, 'colliders.body.friction': float(random.choice([0.0, 0.3, 1.0])),
            **values})
    return scene if scene.thin_colliders else None


@pytest.mark.parametrize('count', [4, pytest.param(200, marks=pytest.mark.long)])
def test_random_thin_bodies_are_not_passed(context, within, values_of_mode, count):
    """A corner, a rim or a turn would let cloth through that the usual scenes hold."""
    seed = int(np.random.default_rng().integers(1_000_000))
    print(f'seed {seed}')
    worst = force_error = -np.inf
    for number in range(count):
        random = np.random.default_rng((seed, number))
        scene = random_scene(random, values_of_mode)
        if scene is None:
            continue
        with Simulation(scene, context=context) as simulation:
            if random.integers(2):
                simulation.move_collider(
                    'body', random.uniform(-0.1, 0.1, 3).tolist(),
                    random.normal(size=4).tolist(), speed=float(random.uniform(0.2, 2.0)),
                    angular_speed=float(random.uniform(0.5, 6.0)))
            simulation.step(1)
            account = ForceAccount(simulation)
            for _ in range(40):
                simulation.step(3)
                worst = max(worst, deepest(simulation, 8))
            force_error = max(force_error, account.close()[1])
    within('depth of a triangle [m]', worst, 1e-6)
    within('force, relative to the weight', force_error, most_off(values_of_mode))


@in_modes(['rod of 0.01 m', 'bar', 'sphere of 0.5 cell'], {'bar'})
def test_a_thin_body_gives_no_energy(context, within, mode, name):
    """Cloth would be thrown by a body at rest."""
    with Simulation(scene_with(BODIES[name], **mode), context=context) as simulation:
        account = EnergyAccount(simulation)
        while simulation.time < 0.5:
            account.step()
    # A sphere within a cell turns the edges over it: their ways out give some.
    most = 1e-3 if mode in (MODES['mass_spring'], MODES['adaptive']) else 2e-3
    within('energy gained, relative to the largest kinetic energy', account.gained, most)


def test_a_run_on_thin_bodies_has_the_same_bits_twice(context, values_of_mode):
    """No recording of it could be made again: contacts are found in any order."""
    found = []
    for _ in range(2):
        scene = scene_with(BODIES['rod of 0.003 m'], **values_of_mode)
        with Simulation(scene, context=context) as simulation:
            simulation.step(100)
            found.append(simulation.snapshot().state_sha256)
            simulation.reset()
            simulation.step(100)
            found.append(simulation.snapshot().state_sha256)
    assert len(set(found)) == 1


def test_springs_on_a_rod_after_an_abandoned_step(context):
    """Impulses of a step that was abandoned would be where the next one begins."""
    found = []
    for asks in ((), (False, False)):
        scene = scene_with(BODIES['rod of 0.003 m'], **MODES['mass_spring'])
        with Simulation(scene, context=context) as simulation:
            simulation.step(60)
            if asks:
                answers = iter(asks)
                simulation.stepping.aim_steps(10)
                with pytest.raises(StepAbandoned):
                    simulation.work(stop=lambda: next(answers, True))
            simulation.step(10)
            found.append(simulation.positions())
    np.testing.assert_array_equal(*found)


def test_a_body_that_is_not_thin_acts_on_nodes_alone(context):
    """Scenes of before would move otherwise, and take longer."""
    found = []
    for features in (True, False):
        scene = scene_with(
            {'shape': 'sphere', 'size': (0.1,), 'position': (0.0, 0.0, -0.09)},
            **{'contact.features': features})
        assert scene.thin_colliders == ()
        with Simulation(scene, context=context) as simulation:
            simulation.step(60)
            found.append(simulation.snapshot().state_sha256)
    assert found[0] == found[1]


def test_a_hole_lets_a_rod_pass(context):
    """Cells that are not there would be held."""
    hole = tuple(float(each) for each in np.array((-1, -1, 1, -1, 1, 1, -1, 1)) * 1.5 * CELL)
    rod = {'shape': 'capsule', 'size': (0.005, 0.1), 'position': (0.0, 0.0, -0.08)}
    for holes, passes in (((), False), (hole, True)):
        scene = scene_with(rod, **{'shape.holes': holes, 'start.z': 0.0})
        with Simulation(scene, context=context) as simulation:
            window = simulation.open_force_window()
            simulation.advance(0.15)
            force, = simulation.frame_forces(window).contacts
            assert (force.force[2] == 0.0) == passes


@pytest.mark.parametrize('given', [
    {'mode': 'constraint', 'contact.features': False}, {'contact.features': False}])
def test_a_thin_body_that_nodes_pass_is_told_of(context, given):
    """A user would see cloth fall through a rod, and all flags well."""
    scene = scene_with(BODIES['rod of 0.003 m'], **given)
    with pytest.warns(UserWarning, match=r'body is 0.006 m thick, 0.096 of a cell') as told:
        Simulation(scene, context=context).close()
    assert len(told) == 1
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        Simulation(scene_with(BODIES['rod of 0.003 m']), context=context).close()


def test_edges_too_long_to_be_held_are_reported(context):
    """Cloth that is torn apart would pass a body, and nobody know."""
    with Simulation(scene_with(BODIES['sphere of 0.5 cell']), context=context) as simulation:
        height = 0.5 * CELL + CLEARANCE + 1e-4
        torn = simulation.scene.rest_positions() * (8.0, 8.0, 0.0) + (0.0, 0.0, height)
        simulation.set_state(torn, np.broadcast_to((0.0, 0.0, -1.0), torn.shape))
        simulation.step(1)
        with pytest.warns(UserWarning, match='edges or faces were not held'):
            simulation.snapshot()


@pytest.mark.long
@pytest.mark.parametrize('second', ['finger', 'table'])
@pytest.mark.parametrize('mode', ['mass_spring', 'adaptive'])
def test_fingers_that_close_compress_the_cloth(context, within, mode, second):
    """Without bounds they would throw the cloth, or feel other forces than each other."""
    thickness, radius, compressed, cells = 0.004, 0.01, 0.5, 16
    room = (1.0 - compressed) * thickness
    height = -0.6 / cells
    across = (0.0, 0.5**0.5, 0.0, 0.5**0.5)
    finger = {'shape': 'capsule', 'size': (radius, 1.2), 'orientation': across, 'friction': 0.5}
    behind = {
        'finger': {**finger, 'position': (0.0, -0.5 * room - radius, height)},
        'table': {'shape': 'box', 'size': (1.0, 0.2, 1.0), 'friction': 0.5,
                  'position': (0.0, -0.5 * room - 0.1, height)}}[second]
    bodies = {'front': {**finger, 'position': (0.0, 0.03, height)}, 'behind': behind}
    scene = Scene({
        **{name: value for name, value in CLOTH.items() if not name.startswith('colliders.')},
        'mode': mode, 'rows': cells + 1, 'cols': cells + 1, 'width': 1.0, 'height': 1.0,
        'pins': ('top_edge',), 'start.pose': 'hanging', 'start.z': 0.0,
        'contact.thickness': thickness, 'contact.compression': 1e4,
        'colliders.names': tuple(bodies), **{
            f'colliders.{name}.{key}': value
            for name, body in bodies.items() for key, value in body.items()}})
    with Simulation(scene, context=context) as simulation:
        simulation.move_collider('front', (0.0, 0.5 * room + radius, height), speed=0.1)
        simulation.step(160)
        assert np.abs(simulation.snapshot().velocities).max() < 0.5, 'it is not thrown'
        pressed = []
        for _ in range(20):
            simulation.step()
            front, back = simulation.contact_forces()
            pressed.append((front.force[1], back.force[1]))
    own, other = np.mean(pressed, axis=0)
    # The cloth is in the middle of two fingers, or on the table; the gap beside it is that of
    # circles.
    across = np.linspace(-0.01, 0.01, 2001)
    axis, faces = {'finger': (0.5 * room + radius, 2), 'table': (radius, 1)}[second]
    lacking = compressed * thickness - faces * (np.hypot(axis, across) - axis)
    force = 1e4 / thickness * float(np.sum(np.maximum(lacking, 0.0))) * (across[1] - across[0])
    within('force on the finger', abs(own / force - 1.0), 0.02)
    within('force on what is behind', abs(other / force + 1.0), 0.02)


def pinched_strip(mode, friction):
    """Return a strip that hangs from pins, and two fingers between its second and third row."""
    thickness, radius, cell = 0.004, 0.01, 0.03
    across = (0.0, 0.5**0.5, 0.0, 0.5**0.5)
    values = {
        **{name: value for name, value in CLOTH.items() if not name.startswith('colliders.')},
        'mode': mode, 'rows': 13, 'cols': 5, 'width': 4 * cell, 'height': 12 * cell,
        'pins': ('top_edge',), 'start.pose': 'hanging', 'start.z': 0.0, 'air.drag': 2.0,
        'contact.thickness': thickness, 'contact.compression': 2000.0,
        'colliders.names': ('front', 'behind')}
    for name, y in (('front', radius + 0.002), ('behind', -radius - 0.25 * thickness)):
        values |= {
            f'colliders.{name}.shape': 'capsule', f'colliders.{name}.size': (radius, 0.3),
            f'colliders.{name}.orientation': across, f'colliders.{name}.friction': friction,
            f'colliders.{name}.position': (0.0, y, 4.5 * cell)}
    return Scene(values)


@pytest.mark.long
@pytest.mark.parametrize('mode', ['mass_spring', 'adaptive'])
def test_fingers_hold_up_to_the_friction_limit(context, within, mode):
    """A gripper would hold what is too heavy for it, or lose what is not."""
    def pressed(scene):
        """Return a cloth between closed fingers, and the force that they press with [N]."""
        simulation = Simulation(scene, context=context)
        x, y, z = scene.colliders[0].position
        simulation.move_collider('front', (x, 0.011, z), speed=0.1)
        simulation.step(80)
        return simulation, simulation.contact_forces()[0].force[1]

    simulation, normal = pressed(pinched_strip(mode, 0.5))
    weight = simulation.scene.mass * 9.81
    simulation.close()
    for share in (1.05, 0.95):
        simulation, _ = pressed(pinched_strip(mode, share * weight / (2.0 * normal)))
        with simulation:
            for col in range(simulation.scene.cols):
                simulation.release(0, col)
            begin = simulation.positions()[1:3, :, 2]
            simulation.step(60)
            slip = np.abs(simulation.positions()[1:3, :, 2] - begin).max()
            carried = -sum(body.force[2] for body in simulation.contact_forces())
        print(f'at {share} of the limit the strip slips by {slip:.1e} m; {carried / weight:.4f} '
              'of its weight')
        if share > 1.0:
            within('slip [m]', slip, 1e-4)
            within('weight that both carry, less 1', abs(carried / weight - 1.0), 0.01)
        else:
            # Until the next line of nodes comes between the fingers, and is pressed as well.
            assert slip > 5e-3
