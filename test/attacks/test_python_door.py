# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Programs that pass anything to any method of the Python API."""

from collections.abc import Callable
from collections.abc import Iterator
from dataclasses import replace
import inspect
import math
from pathlib import Path
from typing import Any

from cloth_sim_ros import Batch
from cloth_sim_ros import Camera
from cloth_sim_ros import CameraModel
from cloth_sim_ros import ClothSimError
from cloth_sim_ros import DeviceError
from cloth_sim_ros import load_scene
from cloth_sim_ros import Look
from cloth_sim_ros import Pose
from cloth_sim_ros import Push
from cloth_sim_ros import randomise
from cloth_sim_ros import Recording
from cloth_sim_ros import resimulate
from cloth_sim_ros import Scene
from cloth_sim_ros import Simulation
from cloth_sim_ros import SimulationRecorder
from cloth_sim_ros import write_mesh
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gym import CarryCloth
from cloth_sim_ros.gym import CarryCloths
from cloth_sim_ros.gym import make_vec
from cloth_sim_ros.sim.held.force_window import ForceWindow
from cloth_sim_ros.sim.inputs import Pin
from cloth_sim_ros.sim.mesh import mesh_of_nodes
from hostile_values import HOSTILE
from hostile_values import hostile
import numpy as np
import pytest

BAG = Path(__file__).resolve().parents[2] / 'bags' / 'example'
ROWS, COLS = 4, 5
SMALL = {
    'rows': ROWS, 'cols': COLS, 'dt': 0.01, 'air.density': 1.2, 'air.drag': 1.0,
    'stiffness.structural': 50.0, 'pins': ['top_left', 'top_right']}
TOUCHING = {
    **SMALL, 'colliders.names': ['ball'], 'colliders.ball.shape': 'sphere',
    'colliders.ball.size': [0.1], 'colliders.ball.position': [0.0, 0.0, 0.5]}
BATCHED = {
    **{key: value for key, value in TOUCHING.items() if not key.startswith('air')},
    'contact.features': False}
STATE = np.zeros((ROWS, COLS, 3))
PINNED = np.zeros((ROWS, COLS), bool)
CENTER = (0.0, 0.0, 1.0)
MESH = mesh_of_nodes(STATE, STATE, np.ones((ROWS - 1, COLS - 1), bool))

# What may be passed to each method; each argument is replaced by each hostile value in turn.
OF_SIMULATION: dict[str, dict[str, Any]] = {
    'warm_up': {}, 'advance': {'seconds': 0.01}, 'step': {'count': 1},
    'work': {'is_due': lambda: False, 'stop': lambda: False}, 'apply': {'given': Pin(3, 3)},
    'positions': {}, 'stored_positions': {}, 'velocities': {},
    'set_mode': {'name': 'mass_spring'}, 'take_over': {'prepared': None},
    'set_state': {'positions': STATE, 'velocities': STATE},
    'go_on_from': {
        'steps': 3, 'positions': STATE, 'velocities': STATE, 'pinned': PINNED,
        'pushes': [Push((0.0, 0.0, 1.0), 0.0, 1.0)], 'colliders': {'ball': Pose(CENTER)}},
    'replace_state': {'positions': STATE, 'velocities': STATE}, 'begin_anew': {},
    'reset': {}, 'measure': {}, 'snapshot': {'tension': False, 'pin_forces': False},
    'begin_snapshot': {}, 'pin_forces': {}, 'contact_forces': {}, 'grasp_forces': {
        'snapshot': None}, 'finish': {}, 'open_force_window': {},
    'close_force_window': {'window': ForceWindow()},
    'frame_forces': {'window': ForceWindow(), 'snapshot': None},
    'push': {'force': CENTER, 'duration': 0.1, 'region': 'sphere', 'center': CENTER,
             'radius': 9.0, 'start': 5.0},
    'clear_pushes': {}, 'set_wind': {'velocity': CENTER}, 'pin': {'row': 3, 'col': 3},
    'release': {'row': 3, 'col': 3},
    'move_pin': {'row': 0, 'col': 0, 'target': CENTER, 'speed': 1.0}, 'pinned_nodes': {},
    'nearest_node': {'point': CENTER, 'max_distance': 9.0},
    'nearest_pin': {'point': CENTER, 'max_distance': 9.0}, 'grasped_nodes': {},
    'grasp': {'name': 'other', 'position': CENTER, 'orientation': (0.0, 0.0, 0.0, 1.0),
              'radius': 0.0, 'count': 1, 'layers': 'all', 'max_force': 1.0,
              'nodes': [(3, 3), (3, 2)]},
    'release_grasp': {'name': 'hand'},
    'move_grasp': {
        'name': 'hand', 'target': CENTER, 'orientation': (0.0, 0.0, 0.0, 1.0), 'speed': 1.0,
        'angular_speed': 1.0, 'duration': 1.0},
    'move_collider': {
        'name': 'ball', 'target': CENTER, 'orientation': (0.0, 0.0, 0.0, 1.0), 'speed': 1.0,
        'angular_speed': 1.0, 'duration': 1.0},
}
OF_BATCH: dict[str, dict[str, Any]] = {
    'step': {'count': 1}, 'positions': {}, 'velocities': {},
    'set_state': {'positions': STATE[None], 'velocities': STATE[None], 'cloths': [1]},
    'reset': {'cloths': [1]}, 'pinned_nodes': {'cloth': 1}, 'max_strains': {},
    'cloth': {'number': 1}, 'pin': {'cloths': [0], 'nodes': [(3, 3)]},
    'release': {'cloths': [0], 'nodes': [(3, 3)]},
    'move_pins': {
        'cloths': [0, 1], 'nodes': [(0, 0), (0, 0)], 'targets': [CENTER] * 2,
        'speeds': [1.0, 1.0]},
    'move_collider': {
        'cloths': [0, 1], 'name': 'ball', 'targets': [CENTER] * 2,
        'orientations': [(0.0, 0.0, 0.0, 1.0)] * 2, 'speeds': [1.0, 1.0],
        'angular_speeds': [1.0, 1.0], 'durations': [1.0, 1.0]},
    'finish': {},
}
OF_SCENE: dict[str, dict[str, Any]] = {
    '__getitem__': {'name': 'rows'}, 'stiffness': {'family': 'structural', 'direction': 0},
    'damping': {'family': 'structural', 'direction': 0}, 'models': {'family': 'bend'},
    'checked_node': {'row': 0, 'col': 1},
    'rest_positions': {}, 'start_positions': {}, 'pinned_nodes': {}, 'timed_pushes': {},
    'gusts': {}, 'timed_pin_moves': {}, 'timed_collider_moves': {}, 'timed_grasp_moves': {},
    'timed_grasps': {},
}
CAMERA: dict[str, Any] = {
    'position': [0.0, -1.0, 1.0], 'target': [0.0, 0.0, 0.5], 'width': 16, 'height': 12}
OF_CAMERA: dict[str, dict[str, Any]] = {
    'capture': {
        'cloth': None, 'colliders': None, 'frame': Pose(CENTER), 'color': True, 'depth': True,
        'labels': True, 'normals': True, 'visible': True, 'look': None}}
OF_CAMERA_MODEL: dict[str, dict[str, Any]] = {
    'placed': {'frame': Pose(CENTER)}, 'project': {'points': STATE}, 'rays': {}}
OF_RECORDING: dict[str, dict[str, Any]] = {
    'count': {'*keys': 'stats'}, 'keys': {}, 'entries': {'*keys': 'stats'},
    'arrays': {'key': 'stats'}, 'raw_messages': {}, 'decode': {'message': None}, 'no_frame': {},
}
OF_RECORDER: dict[str, dict[str, Any]] = {
    'advance': {'seconds': 0.01}, 'write': {'step_wall_time': 0.0, 'real_time_factor': 0.0}}
OF_ENVIRONMENT: dict[str, dict[str, Any]] = {
    'reset': {'seed': 1, 'options': None}, 'step': {'action': np.zeros((2, 3), np.float32)},
    'move_collider': OF_SIMULATION['move_collider'], 'render': {}}
OF_ENVIRONMENTS: dict[str, dict[str, Any]] = {
    'reset': {'seed': 1, 'options': {'reset_mask': np.array([True, False])}},
    'step': {'actions': np.zeros((2, 2, 3), np.float32)},
    'move_collider': OF_BATCH['move_collider'], 'render': {}}
# What makes an environment, or many.
_OF_TASK = (
    'scene', 'goal', 'frame', 'speed', 'observation', 'jitter', 'tolerance', 'camera',
    'picture_size', 'hands', 'start', 'reward', 'render_size', 'render_mode')
# Ends what the others are called on; it takes no argument.
_CLOSE = {'close', 'close_extras'}


def methods_of(kind: type) -> set[str]:
    """Return the public methods that ``kind`` defines."""
    return {
        name for name, value in vars(kind).items()
        if inspect.isfunction(value) and not name.startswith('_')} - _CLOSE


def calls(table: dict[str, dict[str, Any]]) -> Iterator[tuple[str, str, str]]:
    """Yield each method with each of its arguments and the name of each hostile value."""
    for method, arguments in table.items():
        for argument in arguments:
            for name in HOSTILE:
                yield method, argument, name


def call(target: Any, table: dict[str, dict[str, Any]], method: str, argument: str,
         value: Any) -> str:
    """Call ``method`` with ``value`` for one argument; return why it was refused, or ''."""
    given = {**table[method], argument: value}
    names = [given.pop(name) for name in list(given) if name.startswith('*')]
    try:
        made = getattr(target, method)(*names, **given)
        if inspect.isgenerator(made):
            list(made)
    except ClothSimError as error:
        text = str(error)
        assert text.strip() and '\n' not in text, text
        return text
    return ''


def attack(target: Any, table: dict[str, dict[str, Any]], look: Callable[[], list[Any]],
           bring_back: Callable[[], None] = lambda: None) -> tuple[int, int]:
    """
    Make all calls; return how many, and how many were refused.

    :param look: returns what must not change by a call that is refused
    :param bring_back: undoes a call that was carried out
    """
    bad, count, refused = [], 0, 0
    bring_back()
    before = look()
    for method, argument, name in calls(table):
        count += 1
        try:
            reason = call(target, table, method, argument, hostile(name))
        except Exception as error:
            bad.append(f'{method}({argument}={name}): {type(error).__name__} {error}'[:200])
            reason = 'none'
        refused += bool(reason)
        if not reason:
            bring_back()
            before = look()
        elif look() != before:
            bad.append(f'{method}({argument}={name}) changed the state, refused')
            bring_back()
    assert not bad, f'{len(bad)} of {count} calls:\n' + '\n'.join(bad)
    return count, refused


def look_at(simulation: Simulation) -> list[Any]:
    """Return all that a refused call must leave as it is, to the bit."""
    return [
        simulation.positions().tobytes(), simulation.velocities().tobytes(), simulation.steps,
        simulation.time, simulation.mode, simulation.pinned_nodes().tobytes(),
        simulation.grasped_nodes().tobytes(), simulation.pushes, simulation.pin_moves,
        simulation.loads.wind, simulation.colliders, [grasp.name for grasp in simulation.grasps],
        [path.move for path in simulation.grasp_paths], simulation.stepping.is_behind,
        [moved.name for moved in simulation.moved_colliders]]


@pytest.fixture(autouse=True)
def in_a_folder_of_its_own(tmp_path, monkeypatch):
    """Let recordings of directories like '1' be made where nobody keeps anything."""
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def context() -> Iterator[Context]:
    """Lend one context to all that is made here."""
    context = Context(single_thread=True)
    yield context
    context.close()


def test_simulation_takes_or_refuses_anything(context):
    """step(1.5) never returned, pin(1.5, 0) was an IndexError, a masked array a TypeError."""
    assert set(OF_SIMULATION) == methods_of(Simulation)
    with Simulation(Scene(TOUCHING), context=context) as cloth:
        start = cloth.positions(), cloth.velocities()

        def bring_back() -> None:
            cloth.reset()
            cloth.set_state(*start)
            cloth.set_mode('mass_spring')
            cloth.set_wind((0.0, 0.0, 0.0))
            cloth.grasp('hand', start[0][2, 2], radius=0.3)

        count, refused = attack(cloth, OF_SIMULATION, lambda: look_at(cloth), bring_back)
        print(f'{count} calls, {refused} refused')
        # Refused calls have no later effect.
        bring_back()
        cloth.step(20)
        attacked = look_at(cloth)
    with Simulation(Scene(TOUCHING), context=context) as untouched:
        untouched.set_state(*start)
        untouched.grasp('hand', start[0][2, 2], radius=0.3)
        untouched.step(20)
        assert look_at(untouched)[:4] == attacked[:4]


def test_batch_takes_or_refuses_anything(context):
    """step(1.5) made time a float that no later step agreed with."""
    assert set(OF_BATCH) == methods_of(Batch)
    with Batch(Scene(BATCHED), 2, context=context) as batch:
        def look() -> list[Any]:
            return [batch.positions().tobytes(), batch.velocities().tobytes(), batch.steps,
                    batch.lost.tobytes(), batch.pinned_nodes(0).tobytes()]

        start = batch.positions()

        def bring_back() -> None:
            batch.steps = 0
            batch.reset()
            batch.set_state(start, np.zeros_like(start))

        print(attack(batch, OF_BATCH, look, bring_back))
        bring_back()
        batch.step(20)
        attacked = look()
    with Batch(Scene(BATCHED), 2, context=context) as batch:
        batch.step(20)
        assert look() == attacked


def test_scene_takes_or_refuses_anything():
    """A name that is no text was an AttributeError, an unknown one a KeyError."""
    assert set(OF_SCENE) == methods_of(Scene) | {'__getitem__'}
    scene = Scene(TOUCHING)
    print(attack(scene, OF_SCENE, lambda: [dict(scene.values)]))


@pytest.mark.parametrize('name', HOSTILE)
def test_scene_of_anything(name):
    """A parameter of another type was refused with a traceback."""
    for key in Scene(TOUCHING).values:
        try:
            Scene({**TOUCHING, key: hostile(name)})
        except ClothSimError:
            continue
    for values in (hostile(name), {name: 1}):
        try:
            Scene(values)
        except ClothSimError:
            continue


@pytest.mark.parametrize('name', HOSTILE)
def test_anything_in_place_of_a_scene(context, tmp_path, name):
    """Simulation({'rows': 4}) was a KeyError."""
    value = hostile(name)
    makers = {
        'Simulation': lambda: Simulation(value), 'Batch': lambda: Batch(value),
        'Simulation context': lambda: Simulation(Scene(SMALL), context=value),
        'Simulation flag': lambda: Simulation(Scene(SMALL), context=context, tuned=value),
        'Batch context': lambda: Batch(Scene(BATCHED), context=value),
        'Batch count': lambda: Batch(Scene(BATCHED), value, context=context),
        'Batch scenes': lambda: Batch([Scene(BATCHED), value], context=context),
        'Recording': lambda: Recording(value).count('stats'),
        'Recording node': lambda: Recording(BAG, value).count('stats'),
        'load_scene': lambda: load_scene(value),
        'load_scene changes': lambda: load_scene(
            BAG.parents[1] / 'config' / 'drape.yaml', value),
        'resimulate': lambda: resimulate(value),
        'write_mesh': lambda: write_mesh(value, tmp_path / 'any.obj'),
        'write_mesh path': lambda: write_mesh(MESH, value),
        **{f'write_mesh {part}': lambda part=part: write_mesh(
            replace(MESH, **{part: value}), tmp_path / 'any.obj') for part in vars(MESH)},
    }
    for of, make in makers.items():
        try:
            made = make()
        except (ClothSimError, DeviceError) as error:
            assert str(error).strip(), of
            continue
        if hasattr(made, 'close'):
            made.close()


def test_recording_takes_or_refuses_anything():
    """A key that is no text was a TypeError."""
    assert set(OF_RECORDING) <= methods_of(Recording)
    recording = Recording(BAG)
    print(attack(recording, OF_RECORDING, lambda: [recording.count('stats')]))


@pytest.mark.parametrize('name', HOSTILE)
def test_recorder_of_anything(context, tmp_path, name):
    """A recorder of something else than a simulation was an AttributeError."""
    with Simulation(Scene(SMALL), context=context) as cloth:
        before = look_at(cloth)
        value = hostile(name)
        for given in (
                {'simulation': value}, {'directory': value}, {'name': value}, {'node': value},
                {'parameters': value}, {'parameters': {'publish.rate': value}}):
            usual = {'simulation': cloth, 'directory': str(tmp_path), 'name': ''}
            try:
                SimulationRecorder(**{**usual, **given}).close()
            except ClothSimError as error:
                assert str(error).strip()
            assert look_at(cloth) == before


def test_recorder_methods_take_or_refuse_anything(context, tmp_path):
    """A wall time of NaN would be found when the bag is read."""
    assert set(OF_RECORDER) == methods_of(SimulationRecorder)
    with Simulation(Scene(SMALL), context=context) as cloth:
        with SimulationRecorder(cloth, tmp_path, 'bag') as recorder:
            print(attack(
                recorder, OF_RECORDER, lambda: look_at(cloth)))
    assert Recording(tmp_path / 'bag').count('stats') >= 1


def test_environment_takes_or_refuses_anything():
    """An action of text was a TypeError in a training run."""
    assert set(OF_ENVIRONMENT) == methods_of(CarryCloth)
    environment = CarryCloth(TOUCHING)

    def look() -> list[Any]:
        return look_at(environment._cloths.views()[0])

    environment.reset(seed=1)
    print(attack(environment, OF_ENVIRONMENT, look, lambda: environment.reset(seed=1)))
    environment.close()


def test_environments_take_or_refuse_anything():
    """Wrong actions would move some cloths, or a wrong mask reset others."""
    assert set(OF_ENVIRONMENTS) == methods_of(CarryCloths)
    environments = make_vec(2, BATCHED)

    def look() -> list[Any]:
        cloths = environments._cloths
        return [cloths.positions().tobytes(), cloths.velocities().tobytes(),
                cloths.times().tobytes()]

    environments.reset(seed=1)
    print(attack(environments, OF_ENVIRONMENTS, look, lambda: environments.reset(seed=1)))
    environments.close()


@pytest.mark.parametrize('name', HOSTILE)
def test_environment_of_anything(name):
    """A frame of text was a TypeError."""
    for argument in _OF_TASK:
        given = {'scene': SMALL, 'observation': 'depth', argument: hostile(name)}
        try:
            environment = CarryCloth(**given)
        except ClothSimError as error:
            assert str(error).strip()
        else:
            assert math.isfinite(environment._cloths.views()[0].dt)
            environment.close()


@pytest.mark.parametrize('name', HOSTILE)
def test_environments_of_anything(name):
    """A number of cloths beyond memory would end the process."""
    for argument in ('num_envs', 'max_steps', *_OF_TASK):
        given = {'num_envs': 2, 'scene': BATCHED, argument: hostile(name)}
        try:
            environments = make_vec(**given)
        except (ClothSimError, DeviceError) as error:
            assert str(error).strip()
        else:
            assert environments.num_envs >= 1
            environments.close()


def test_camera_takes_or_refuses_anything(context):
    """A look of text was an AttributeError, after the picture had been begun."""
    assert set(OF_CAMERA) == methods_of(Camera)
    assert set(OF_CAMERA_MODEL) == methods_of(CameraModel)
    print(attack(CameraModel.of(**CAMERA), OF_CAMERA_MODEL, lambda: []))
    with Simulation(Scene(TOUCHING), context=context) as cloth, Camera(**CAMERA) as camera:
        table = {'capture': {**OF_CAMERA['capture'], 'cloth': cloth}}
        before = camera.capture(cloth)
        count, refused = attack(camera, table, lambda: look_at(cloth))
        print(f'{count} calls, {refused} refused')
        after = camera.capture(cloth)
        for part in ('color', 'depth', 'labels', 'normals', 'visible'):
            np.testing.assert_array_equal(getattr(before, part), getattr(after, part))


@pytest.mark.parametrize('name', HOSTILE)
def test_camera_of_anything(context, name):
    """A number as the colour of a Look was a TypeError."""
    value = hostile(name)
    watched = {**SMALL, 'cameras.names': ['eye'], **{
        f'cameras.eye.{key}': each for key, each in CAMERA.items()}}
    fields = {
        key.rpartition('.')[2] for key in Scene(watched).values if key.startswith('cameras.eye.')}
    with Simulation(Scene(SMALL), context=context) as cloth:
        model = CameraModel.of(**CAMERA)
        usual = {'camera': model, 'cloth': cloth, 'seed': 1}
        makers = {
            'Camera': lambda: Camera(value), 'Camera name': lambda: Camera(name=value),
            **{f'Camera {key}': lambda key=key: Camera(**{**CAMERA, key: value})
               for key in fields},
            'Scene names': lambda: Scene({**watched, 'cameras.names': value}),
            **{f'Scene {key}': lambda key=key: Scene({**watched, f'cameras.eye.{key}': value})
               for key in fields},
            **{f'Look {key}': lambda key=key: Look(**{key: value}) for key in vars(Look())},
            'Look body': lambda: Look(bodies={'ball': value}),
            **{f'randomise {key}': lambda key=key: randomise(**{**usual, key: value})
               for key in (*usual, 'distance', 'elevation', 'colliders')},
        }
        for of, make in makers.items():
            try:
                make()
            except ClothSimError as error:
                assert str(error).strip() and '\n' not in str(error), of
