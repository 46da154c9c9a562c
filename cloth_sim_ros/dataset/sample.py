# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One sample of a data set: simulated, photographed and written."""

from __future__ import annotations

from collections.abc import Mapping
import json
import os
from pathlib import Path
from typing import Any

from cloth_sim_ros.camera.camera import Camera
from cloth_sim_ros.camera.picture import CameraPicture
from cloth_sim_ros.camera.picture_file import check_pictures
from cloth_sim_ros.camera.randomise import randomise
from cloth_sim_ros.dataset.coco import keypoints
from cloth_sim_ros.dataset.coco import mask_annotations
from cloth_sim_ros.dataset.variation import Bounds
from cloth_sim_ros.dataset.variation import random_fabric
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.gl.errors import ShaderError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.model.cameras import CameraModel
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.workers import process_context
import numpy as np
from PIL import Image

# REP 118: depth of 16 bits is in millimetres, and 0 where there is none.
_MILLIMETRES = 1e3
_DEEPEST = 65535
# Folders of a data set, and the ending of what is in them.
FOLDERS = {
    'images': 'png', 'depth': 'png', 'labels': 'png', 'nodes': 'npz', 'samples': 'json'}
# Speed of the hand that lifts a node [m/s], and how far it goes to the side, over how high [1].
_SPEED = 1.0
_ASIDE = 1.0
_LEAST_LIFT = 0.02  # of the width of the cloth [1]: below, there is no hand


def path_of(folder: Path, kind: str, number: int) -> Path:
    """Return the file of the sample ``number`` in one of FOLDERS."""
    return folder / kind / f'{number:06d}.{FOLDERS[kind]}'


def check_look(scene: Scene) -> None:
    """Raise ClothSimError when a picture that the look of ``scene`` names is not there."""
    check_pictures(scene.look)


def make_sample(
        given: Mapping[str, Any], folder: str, seed: int, number: int, bounds: Bounds, *,
        keeps_fabric: bool) -> str:
    """
    Make the sample ``number`` and write its files, that in samples/ last.

    :param given: values for the scene
    :param keeps_fabric: True for the fabric of the scene in all samples
    :return: why there is none; empty where there is one
    :raises ClothSimError: when a value is wrong
    """
    random = np.random.default_rng((seed, number))
    values = dict(given) if keeps_fabric else random_fabric(random, given)
    values = {**values, 'start.seed': int(random.integers(2**31))}
    scene = Scene(values)
    with Simulation(scene, context=process_context(), records_forces=False) as simulation:
        try:
            _let_fall(random, simulation, bounds)
        except (NonFiniteStateError, DeviceError, ShaderError) as error:
            # A cloth that is lost in one sample is no reason to make no others.
            return str(error)
        nodes = simulation.positions().astype(float)
        camera, look = randomise(
            scene.cameras[0] if scene.cameras else _usual_camera(), simulation, seed=random,
            distance=bounds.distance, elevation=bounds.elevation)
        with Camera(camera) as eye:
            picture = eye.capture(simulation, look=look, normals=False)
        _write(Path(folder), number, picture, nodes, {
            'fabric': values.get('material.preset', ''), 'look': vars(look)})
    return ''


def _usual_camera() -> CameraModel:
    return CameraModel.of('camera', position=[0.0, 0.0, 1.0], target=[0.0, 0.0, 0.0])


def _let_fall(random: np.random.Generator, simulation: Simulation, bounds: Bounds) -> None:
    """
    Turn the cloth, lift one of its nodes, release it and wait.

    One that is pinned only waits.
    """
    scene = simulation.scene
    seconds = random.uniform(*bounds.seconds)
    if not scene.pinned_nodes().any():
        turn = random.uniform(0.0, 2.0 * np.pi)
        start = scene.start_positions()
        middle = start[scene.present_nodes].mean(axis=0)
        matrix = np.array([
            [np.cos(turn), np.sin(turn), 0.0], [-np.sin(turn), np.cos(turn), 0.0],
            [0.0, 0.0, 1.0]])
        turned = (start - middle) @ matrix + middle
        simulation.set_state(turned, np.zeros_like(turned))
        simulation.advance(random.uniform(0.3, 0.6))
        lift = random.uniform(*bounds.lift)
        if lift > _LEAST_LIFT:
            height = lift * scene['width']
            places = np.argwhere(scene.present_nodes)
            row, col = places[random.integers(len(places))].tolist()
            place = simulation.positions()[row, col].astype(float)
            simulation.grasp('hand', place.tolist(), nodes=[(row, col)])
            aside = random.uniform(-_ASIDE, _ASIDE, 2) * height
            path = simulation.move_grasp(
                'hand', [place[0] + aside[0], place[1] + aside[1], place[2] + height],
                speed=_SPEED)
            simulation.advance(path.arrival - simulation.time + simulation.dt)
            simulation.release_grasp('hand')
    simulation.advance(seconds)


def _write(
        folder: Path, number: int, picture: CameraPicture, nodes: np.ndarray,
        chosen: Mapping[str, Any]) -> None:
    camera = picture.camera
    assert picture.color is not None and picture.depth is not None
    assert picture.labels is not None and picture.visible is not None
    depth = np.where(np.isfinite(picture.depth), picture.depth, 0.0) * _MILLIMETRES
    for kind, pixels in (
            ('images', picture.color), ('labels', picture.labels),
            ('depth', np.clip(np.rint(depth), 0, _DEEPEST).astype(np.uint16))):
        Image.fromarray(pixels).save(path_of(folder, kind, number))
    np.savez_compressed(
        path_of(folder, 'nodes', number), positions=nodes.astype(np.float32),
        visible=picture.visible)
    corners = keypoints(picture, nodes)
    content = {
        'width': camera.width, 'height': camera.height, 'k': camera.matrix.ravel().tolist(),
        'camera_position': list(picture.pose.position),
        'camera_orientation': list(picture.pose.orientation), 'depth_unit': 1.0 / _MILLIMETRES,
        'time': picture.time, 'label_names': list(picture.label_names), **chosen,
        'annotations': mask_annotations(picture, corners)}
    target = path_of(folder, 'samples', number)
    # Existing samples are whole: an interrupted run continues after them.
    passing = target.with_suffix('.part')
    passing.write_text(json.dumps(content), encoding='utf-8')
    os.replace(passing, target)
