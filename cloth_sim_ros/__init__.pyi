# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

from cloth_sim_ros.analysis.entry import Entry as Entry
from cloth_sim_ros.analysis.recording import Recording as Recording
from cloth_sim_ros.api.resimulate import resimulate as resimulate
from cloth_sim_ros.api.scene_file import load_scene as load_scene
from cloth_sim_ros.api.simulation_recorder import SimulationRecorder as SimulationRecorder
from cloth_sim_ros.gl.errors import DeviceError as DeviceError
from cloth_sim_ros.recording.recording_faults import RecordingError as RecordingError
from cloth_sim_ros.resimulation.frame_check import Difference as Difference
from cloth_sim_ros.resimulation.frame_check import FrameCheck as FrameCheck
from cloth_sim_ros.resimulation.verdict import Verdict as Verdict
from cloth_sim_ros.sim.errors import ClothSimError as ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError as NonFiniteStateError
from cloth_sim_ros.sim.near_node import NearNode as NearNode
from cloth_sim_ros.sim.pin_forces import PinForces as PinForces
from cloth_sim_ros.sim.pin_path import PinMove as PinMove
from cloth_sim_ros.sim.pin_path import PinPath as PinPath
from cloth_sim_ros.sim.push import Push as Push
from cloth_sim_ros.sim.push_field import AppliedPush as AppliedPush
from cloth_sim_ros.sim.scene import Scene as Scene
from cloth_sim_ros.sim.simulation import Simulation as Simulation
from cloth_sim_ros.sim.snapshot import Measures as Measures
from cloth_sim_ros.sim.snapshot import Snapshot as Snapshot
