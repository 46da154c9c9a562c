# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The parameters of the node itself: what is published, recorded and how fast it runs."""

from collections.abc import Mapping
from typing import Any

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.scene_fields import Field

# A wait between frames has to fit the timers of ROS.
SLOWEST = 1e-6

NODE_FIELDS = (
    Field('frame_id', str, 'world', 'frame_id of all messages'),
    Field('real_time_factor', float, 1.0, 'target ratio of simulated time to wall time, at least '
          f'{SLOWEST:g}; 0 to run as fast as possible', low=0.0, high=1e6, live=True),
    Field('start_paused', bool, False, 'start paused; ~/pause resumes, ~/step advances'),
    Field('time.source', str, 'own', 'what sets pace and stamps: own, simulated time at '
          '`real_time_factor`; ros, /clock in lockstep', choices=('own', 'ros')),
    Field('time.epoch', str, 'zero', 'stamp of simulated time 0 with `time.source: own`: zero, or '
          'that of the wall clock', choices=('zero', 'wall')),
    Field('time.jump_back', str, 'reset', 'with `time.source: ros`, what a /clock that goes back '
          'behind the cloth does: reset the cloth, or refuse, which stops the run',
          choices=('reset', 'refuse')),
    Field('publish.rate', float, 50.0, 'frames per second of simulated time', 'Hz',
          low=1e-3, high=1e6),
    Field('publish.points', bool, True, 'publish ~/points', live=True),
    Field('publish.markers', bool, True, 'publish ~/markers', live=True),
    Field('publish.stats', bool, True, 'publish ~/stats', live=True),
    Field('publish.wrenches', bool, True, 'publish ~/pins/wrenches, ~/grasps/wrenches, their '
          'peaks and ~/colliders/wrenches', live=True),
    Field('publish.tf', bool, True, 'publish a transform for each pin, grasp and collider on /tf',
          live=True),
    Field('publish.cameras', bool, True, 'publish the pictures of the cameras of the scene',
          live=True),
    Field('publish.clock', bool, False, 'publish simulated time on /clock, unless another '
          'node does'),
    Field('tf.listen', bool, True, 'take inputs in other frames than `frame_id`, by the '
          'transforms on /tf and /tf_static'),
    Field('tf.follow', str, (), 'grasps and colliders of the scene that are rigidly attached to '
          'frames on /tf as soon as these are known, NAME=FRAME each', is_array=True),
    Field('tf.follow_speed', float, 2.0, 'highest speed at which a body follows its frame, unless '
          'its request sets one', 'm/s', low=1e-6, high=1e3, live=True),
    Field('tf.follow_angular_speed', float, 10.0, 'highest angular speed likewise', 'rad/s',
          low=1e-6, high=1e3, live=True),
    Field('simulation_interfaces', bool, False, 'serve get_entities, set_simulation_state and '
          'others of the package simulation_interfaces, in the namespace of the node'),
    Field('recording.directory', str, 'bags', 'directory in which recordings are created'),
    Field('recording.enabled', bool, False, 'start recording when the node starts'),
    Field('recording.name', str, '', 'name of that recording, with a number appended '
          'where it is taken; empty to generate one'),
    Field('recording.max_bagfile_size', int, 0, 'size at which a recording is split into a '
          'new file, at least 1 MiB; 0 for no limit', 'bytes', low=0, high=10**15),
    Field('recording.max_bagfile_duration', float, 0.0, 'duration after which a recording is '
          'split into a new file, at least 1 s; 0 for no limit', 's', low=0.0, high=1e9),
    Field('recording.max_size', int, 0, 'total size at which a recording is stopped, at least '
          '1 MiB; 0 for no limit', 'bytes', low=0, high=10**15),
    Field('recording.fsync', bool, False, 'sync a recording to disk at every flush, twice a '
          'second, not only at its end'),
    Field('recording.markers', bool, False, 'record ~/markers as well, so that viewers show the '
          'surface and the colliders of a recording'),
    Field('recording.cameras', bool, False, 'record image, depth, camera_info and labels of each '
          'camera of the scene as well'),
    Field('clicked_point.force', float, (0.0, 0.0, 1.0), 'total force of the push triggered by a '
          'message on /clicked_point, x y z', 'N', low=-1e9, high=1e9, is_array=True, live=True),
    Field('clicked_point.radius', float, 0.1, 'radius of that push around the clicked point', 'm',
          low=1e-6, high=1e6, live=True),
    Field('clicked_point.duration', float, 0.1, 'duration of that push', 's', low=1e-6, high=1e6,
          live=True),
)

# Definitions and index alone take up to 100 kB of a file.
_LEAST = {
    'recording.max_bagfile_size': 2**20,
    'recording.max_bagfile_duration': 1.0,
    'recording.max_size': 2**20,
}


def checked_node_values(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values of all fields: those ``given``, checked, and the defaults of the rest."""
    values = {
        field.name: field.check(given.get(field.name, field.default)) for field in NODE_FIELDS}
    check_together(values)
    return values


def check_together(values: Mapping[str, Any]) -> None:
    """Raise ClothSimError for what one field's range cannot say about the node's values."""
    factor = values['real_time_factor']
    if 0.0 < factor < SLOWEST:
        raise ClothSimError(
            f'real_time_factor {factor:g} is slower than {SLOWEST:g}: give 0 to run as fast as '
            'possible, or a larger one; to stand still, pause')
    if values['tf.follow'] and not values['tf.listen']:
        raise ClothSimError(
            'tf.follow needs the frames on /tf and tf.listen is false: leave one of them out')
    if values['time.source'] == 'ros':
        _check_one_source(values)
    count = len(values['clicked_point.force'])
    if count != 3:
        raise ClothSimError(
            f'clicked_point.force needs 3 components, got {count}: write [x, y, z]')
    for name, least in _LEAST.items():
        if 0 < values[name] < least:
            raise ClothSimError(
                f'{name} must be 0 or {least} and more, got {values[name]}: give {least}, or 0 '
                'for no limit')


def _check_one_source(values: Mapping[str, Any]) -> None:
    if values['publish.clock']:
        raise ClothSimError(
            'time.source: ros follows /clock and publish.clock: true publishes it: set '
            'time.source: own or publish.clock: false')
    if values['time.epoch'] != 'zero':
        raise ClothSimError(
            f'time.source: ros takes stamps from /clock and time.epoch: {values["time.epoch"]} '
            'sets them: leave time.epoch out, or set time.source: own')
