# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Simulate a cloth on GLSL compute shaders and show it in ROS 2.

The names in ``__all__`` are the Python API, which docs/how_to/python_api.md shows in use. Each is
imported when it is first used: without ROS, all but SimulationRecorder work.
"""

from importlib import import_module

# The types of these names are in __init__.pyi.
_MODULES = {
    'AppliedPush': 'sim.loads.push_field',
    'Batch': 'sim.batch',
    'Camera': 'camera.camera',
    'CameraModel': 'sim.model.cameras',
    'CameraPicture': 'camera.picture',
    'ClothSimError': 'sim.errors',
    'Collider': 'sim.model.colliders',
    'ContactForce': 'sim.contact.contacts',
    'DeviceError': 'gl.errors',
    'Difference': 'resimulation.frame_check',
    'Entry': 'analysis.recording',
    'FrameCheck': 'resimulation.frame_check',
    'FrameMove': 'sim.model.frame_paths',
    'FramePath': 'sim.model.frame_paths',
    'Grasp': 'sim.held.grasps',
    'GraspForce': 'sim.held.grasps',
    'Look': 'sim.model.look',
    'Measures': 'sim.snapshot',
    'Mesh': 'sim.mesh',
    'NearNode': 'sim.model.grid',
    'NonFiniteStateError': 'sim.errors',
    'PinForces': 'sim.held.pin_forces',
    'PinMove': 'sim.model.pins',
    'PinPath': 'sim.model.pins',
    'Pose': 'sim.model.pose',
    'Push': 'sim.model.push',
    'Recording': 'analysis.recording',
    'RecordingError': 'recording.recording_faults',
    'Scene': 'sim.scene',
    'Simulation': 'sim.simulation',
    'SimulationRecorder': 'api.simulation_recorder',
    'Snapshot': 'sim.snapshot',
    'Verdict': 'resimulation.verdict',
    'load_scene': 'api.scene_file',
    'randomise': 'camera.randomise',
    'resimulate': 'api.resimulate',
    'write_mesh': 'analysis.mesh_files',
}

__all__ = tuple(_MODULES)


def __getattr__(name: str) -> object:
    """Import a name of the API when it is first used (PEP 562)."""
    if name not in _MODULES:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    try:
        value = getattr(import_module(f'{__name__}.{_MODULES[name]}'), name)
    except ImportError as error:
        from cloth_sim_ros.node.missing_module import way_out
        raise ImportError(f'{name} cannot be used: {way_out(error)}', name=error.name) from error
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the names of the API with those that are here already."""
    return sorted({*globals(), *__all__})
