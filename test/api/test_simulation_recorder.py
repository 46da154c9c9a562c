# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Recording a simulation from Python."""

from cloth_sim_ros import Camera
from cloth_sim_ros import ClothSimError
from cloth_sim_ros import Recording
from cloth_sim_ros import RecordingError
from cloth_sim_ros import resimulate
from cloth_sim_ros import Scene
from cloth_sim_ros import Simulation
from cloth_sim_ros import SimulationRecorder
from cloth_sim_ros.sim.errors import NonFiniteStateError
import numpy as np
import pytest
from recorded import Recorded
from springs import SPRINGS

SMALL = {**SPRINGS, 'rows': 5, 'cols': 4, 'start.jitter': 0.01}


@pytest.fixture
def cloth():
    """Return a small cloth on two pins."""
    with Simulation(Scene(SMALL)) as simulation:
        yield simulation


def test_frames_are_what_the_simulation_was(cloth, tmp_path):
    """A recording would show another run than the one that was made."""
    seen = []
    with SimulationRecorder(cloth, tmp_path, 'run') as recorder:
        seen.append((cloth.positions(), cloth.velocities(), cloth.time))
        for _ in range(3):
            cloth.advance(0.05)
            recorder.write()
            seen.append((cloth.positions(), cloth.velocities(), cloth.time))
    assert recorder.path == str(tmp_path / 'run')
    points = Recording(recorder.path).arrays('points')
    positions, velocities, times = map(np.array, zip(*seen))
    np.testing.assert_array_equal(points['positions'], positions)
    np.testing.assert_array_equal(points['velocities'], velocities)
    np.testing.assert_allclose(points['time'], times, atol=1e-9)
    # Independent libraries read it too.
    assert len(Recorded(tmp_path / 'run').messages('stats')) == 4


def test_advance_writes_at_the_rate_and_measures_the_pace(cloth, tmp_path):
    """Frames would be missing, or the table of the run would lack its pace."""
    with SimulationRecorder(cloth, tmp_path, parameters={'publish.rate': 20.0}) as recorder:
        assert recorder.advance(0.22) == 44
    recording = Recording(recorder.path)
    np.testing.assert_allclose(
        recording.arrays('points')['time'], [0.0, 0.05, 0.1, 0.15, 0.2, 0.22], atol=1e-9)
    stats = recording.arrays('stats')
    assert np.all(stats['step_wall_time'][1:] > 0.0)
    np.testing.assert_allclose(
        stats['real_time_factor'][1:] * stats['step_wall_time'][1:], cloth.dt)


BALL = {
    'colliders.names': ['ball'], 'colliders.ball.shape': 'sphere', 'colliders.ball.size': [0.1],
    'colliders.ball.position': [0.0, 0.0, 0.5]}


def test_markers_are_recorded_on_request(tmp_path):
    """A viewer of the recording would show a cloth that bends around nothing."""
    with Simulation(Scene({**SMALL, **BALL})) as simulation:
        with SimulationRecorder(
                simulation, tmp_path, 'run', parameters={'recording.markers': True}) as recorder:
            recorder.advance(0.06)
            simulation.push((0.0, 0.5, 1.0), duration=0.1)
            recorder.advance(0.02)
        with SimulationRecorder(simulation, tmp_path, 'bare') as recorder:
            recorder.advance(0.02)
    recorded = Recorded(tmp_path / 'run')
    arrays = recorded.messages('markers')
    assert len(arrays) == len(recorded.messages('points')) == 5
    names = [{marker.ns for marker in array.markers} for array in arrays]
    assert all({'surface', 'pins', 'collider/ball'} <= each for each in names)
    assert ['pushes' in each for each in names] == 4 * [False] + [True]
    # The cloth of the same moment.
    cloud = Recording(tmp_path / 'run').arrays('points')['positions'][-1]
    surface, = (marker for marker in arrays[-1].markers if marker.ns == 'surface')
    corner = surface.points[0]
    np.testing.assert_array_equal((corner.x, corner.y, corner.z), cloud[0, 0])
    assert not Recorded(tmp_path / 'bare').messages('markers')
    assert resimulate(tmp_path / 'run').frames.equal == 5


def test_recorded_inputs_resimulate_to_the_bit(cloth, tmp_path):
    """The inputs of a program would be missing, and its run could not be repeated."""
    with SimulationRecorder(cloth, tmp_path, 'run') as recorder:
        cloth.push((0.0, 0.5, 1.0), duration=0.1)
        recorder.advance(0.1)
        cloth.pin(4, 0)
        path = cloth.move_pin(4, 0, (-0.5, -0.5, 1.2), speed=2.0)
        recorder.advance(path.arrival - cloth.time)
        cloth.release(0, 0)
        cloth.set_mode('constraint')
        cloth.set_mode('constraint')
        recorder.advance(0.06)
        cloth.push((0.0, 0.0, 1.0), duration=5.0)
        cloth.clear_pushes()
        recorder.advance(0.04)
        cloth.reset()
        recorder.advance(0.04)
    recording = Recording(recorder.path)
    assert recording.count('inputs/push') == 2 and recording.count('inputs/pin') == 2
    assert recording.arrays('inputs/mode')['mode'].tolist() == ['mass_spring', 'constraint']
    assert recording.arrays('inputs/command')['command'].tolist() == ['clear_pushes', 'reset']
    targets = recording.arrays('inputs/pin_target')
    assert [targets[f'target.{axis}'].tolist() for axis in 'xyz'] == [[-0.5], [-0.5], [1.2]]
    verdict = resimulate(recorder.path)
    assert verdict.frames.frames == recording.count('points')
    assert verdict.frames.equal == verdict.frames.frames and not verdict.is_failure


def test_a_run_is_made_again_with_another_scene(cloth, tmp_path):
    """A stiffer cloth under the same push could not be tried from Python."""
    with SimulationRecorder(cloth, tmp_path) as recorder:
        recorder.advance(0.2)
    verdict = resimulate(recorder.path, {'stiffness.structural': 300.0})
    assert verdict.frames.equal == 1 and verdict.frames.largest.distance > 0.0
    assert 'stiffness.structural set to other values' in verdict.reasons
    with pytest.raises(ClothSimError, match='stiffness'):
        resimulate(recorder.path, {'stiffnes': 300.0})


def test_a_new_state_is_refused_while_recording(cloth, tmp_path):
    """The recording would hold a jump that nobody can make again."""
    positions, velocities = cloth.positions(), cloth.velocities()
    with SimulationRecorder(cloth, tmp_path):
        with pytest.raises(ClothSimError, match='close the recorder, set the state'):
            cloth.set_state(positions + 1.0, velocities)
        np.testing.assert_array_equal(cloth.positions(), positions)
    cloth.set_state(positions + 1.0, velocities)
    np.testing.assert_array_equal(cloth.positions(), positions + 1.0)


def test_one_recorder_at_a_time(cloth, tmp_path):
    """The inputs of one would be missing from the other without a word."""
    with SimulationRecorder(cloth, tmp_path, 'first'):
        with pytest.raises(ClothSimError, match='is already being recorded'):
            SimulationRecorder(cloth, tmp_path, 'second')
    assert not (tmp_path / 'second').exists()
    with SimulationRecorder(cloth, tmp_path, 'second') as recorder:
        pass
    recorder.close()
    with pytest.raises(RecordingError, match='is closed'):
        recorder.write()


def test_wrong_arguments_write_nothing(cloth, tmp_path):
    """A mistake would leave an empty recording behind."""
    with pytest.raises(ClothSimError, match='did you mean publish.rate'):
        SimulationRecorder(cloth, tmp_path, parameters={'publish.rates': 1.0})
    with pytest.raises(ClothSimError, match='publish.rate'):
        SimulationRecorder(cloth, tmp_path, parameters={'publish.rate': 0.0})
    with pytest.raises(ClothSimError, match='name'):
        SimulationRecorder(cloth, tmp_path, '../out')
    assert list(tmp_path.iterdir()) == []
    # And the simulation can be recorded.
    with SimulationRecorder(cloth, tmp_path) as recorder:
        with pytest.raises(ClothSimError, match='cannot advance by -1'):
            recorder.advance(-1.0)


def test_a_limit_ends_the_recording_whole(tmp_path):
    """A program would write on into nothing, or a limited recording could not be read."""
    with Simulation(Scene({**SPRINGS, 'rows': 64, 'cols': 64})) as large:
        recorder = SimulationRecorder(
            large, tmp_path, parameters={'recording.max_size': 2**20})
        with pytest.raises(RecordingError, match='recording.max_size'):
            for _ in range(200):
                recorder.advance(0.1)
        recorder.close()
    assert 0 < Recording(recorder.path).count('points') < 100


def test_recording_ends_at_the_last_finite_state(tmp_path):
    """The frames before a blow-up, which show its cause, would be lost."""
    scene = Scene({
        **SPRINGS, **SMALL, 'auto_substeps': False, 'dt': 0.05, 'stiffness.structural': 1e5})
    with Simulation(scene, check_stability=False) as wild:
        with SimulationRecorder(wild, tmp_path) as recorder:
            with pytest.raises(NonFiniteStateError):
                recorder.advance(60.0)
    recording = Recording(recorder.path)
    assert np.isfinite(recording.arrays('points')['positions']).all()
    assert recording.arrays('state')['run_state'].tolist() == ['running', 'stopped']


def test_pictures_of_cameras_are_recorded(tmp_path):
    """A data set of a run would need a node."""
    scene = Scene({
        **SMALL, 'cameras.names': ['eye', 'hand'], 'cameras.eye.position': [1.0, -1.0, 1.5],
        'cameras.eye.target': [0.0, 0.0, 1.0], 'cameras.eye.width': 40, 'cameras.eye.height': 30,
        'cameras.eye.rate': 20.0, 'cameras.hand.frame': 'tool0'})
    asked = {'publish.rate': 20.0, 'recording.cameras': True}
    with Simulation(scene) as simulation:
        with pytest.warns(UserWarning, match="only a node knows its frame 'tool0'") as told:
            with SimulationRecorder(simulation, tmp_path, 'run', parameters=asked) as recorder:
                recorder.advance(0.2)
        with Camera(scene.cameras[0]) as eye:
            picture = eye.capture(simulation)
    assert len(told) == 1
    recorded = Recorded(tmp_path / 'run')
    for part, pixels in (
            ('image', picture.color), ('depth', picture.depth), ('labels', picture.labels)):
        messages = recorded.messages(f'cameras/eye/{part}')
        assert [each.header.stamp.nanosec for each in messages] == [
            50_000_000 * number for number in range(5)]
        np.testing.assert_array_equal(
            np.frombuffer(bytes(messages[-1].data), pixels.dtype).reshape(pixels.shape), pixels)
    assert len(recorded.messages('cameras/eye/camera_info')) == 5
    assert not recorded.messages('cameras/eye/points')
    # The run is made again without its cameras being needed.
    assert not resimulate(tmp_path / 'run').is_failure
