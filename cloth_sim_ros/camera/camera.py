# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A camera that takes pictures of a cloth."""

from collections.abc import Sequence
from contextlib import AbstractContextManager
from typing import Any

from cloth_sim_ros.camera.color_drawing import ColorDrawing
from cloth_sim_ros.camera.depth_noise import measured_depth
from cloth_sim_ros.camera.drawn_cloth import DrawnCloth
from cloth_sim_ros.camera.lens import Lens
from cloth_sim_ros.camera.picture import CameraPicture
from cloth_sim_ros.camera.subject import RUNNING
from cloth_sim_ros.camera.subject import Subject
from cloth_sim_ros.camera.value_drawing import ValueDrawing
from cloth_sim_ros.camera.visibility import visible_nodes
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.sim.arguments import flag
from cloth_sim_ros.sim.arguments import instance
from cloth_sim_ros.sim.batch_cloth import ClothOfBatch
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.cameras import CameraModel
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.look import Look
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot

_LABELS = ('background', 'cloth')
WORLD = Pose((0.0, 0.0, 0.0))


class Camera(AbstractContextManager['Camera']):
    """
    Takes pictures. Use it only on the thread of the Simulation that it looks at.

    Nothing is made on the device before the first picture. As a context manager it is closed at
    the end of the block.

    :param model: such as one of ``Scene.cameras``; None for one of ``values``
    :param values: what cameras.NAME.* of a scene have, by name: position, target, width ...
    :raises ClothSimError: for a wrong value
    """

    def __init__(self, model: CameraModel | None = None, **values: Any) -> None:
        """Check the values."""
        if model is not None and values:
            raise ClothSimError(
                f'a camera has a model, got {", ".join(values)} besides: give one of both')
        if model is not None and not isinstance(model, CameraModel):
            raise ClothSimError(
                f'a camera needs a CameraModel, got {shown(model)}: give one of Scene.cameras, or '
                'position=... and target=...')
        self.model = CameraModel.of(**values) if model is None else model
        self._studio: _Studio | None = None

    def __exit__(self, *_: object) -> None:
        """Close, however the block has ended."""
        self.close()

    def capture(
            self, cloth: Simulation | ClothOfBatch | Snapshot, *,
            colliders: Sequence[Collider] | None = None, frame: Pose = WORLD, color: bool = True,
            depth: bool = True, labels: bool = True, normals: bool = True, visible: bool = True,
            look: Look | None = None) -> CameraPicture:
        """
        Return a picture of ``cloth`` as it is now.

        The nodes of a Simulation, and of a cloth of a Batch, are drawn from where it has them on
        the device.

        :param cloth: a Simulation, a Snapshot, or ``Batch.cloth(number)``
        :param colliders: where they are; by default those of the scene, and none beside a
            Snapshot
        :param frame: where the tf frame of the camera is in the world, if it has one
        :param color: False leaves out the colours, which take longest
        :param depth: False leaves out the depth
        :param labels: False leaves out the labels
        :param normals: False leaves out the normals
        :param visible: False leaves out which nodes are seen
        :param look: colours, fabric and sun; by default those of the scene
        :raises ClothSimError: when ``cloth`` is none, or a chain, or for another wrong value
        :raises DeviceError: when there is no GL device for it
        """
        subject = Subject.of(cloth, colliders)
        instance(frame, Pose, 'the frame of a camera', 'give where its tf frame is in the world')
        if look is not None:
            instance(look, Look, 'the look of a picture', 'give a Look, or None for the usual one')
        for part, value in (
                ('color', color), ('depth', depth), ('labels', labels), ('normals', normals),
                ('visible', visible)):
            flag(value, f'{part} of a picture')
        lens = Lens(self.model, self.model.placed(frame))
        return self._studio_for(subject).take(
            subject, lens, (look or subject.look) if color else None, depth=depth, labels=labels,
            normals=normals, visible=visible)

    def close(self) -> None:
        """Release the device; does nothing when called again."""
        studio, self._studio = self._studio, None
        if studio is not None:
            studio.close()

    def _studio_for(self, subject: Subject) -> '_Studio':
        beside = _context_of(subject)
        if self._studio is None or not self._studio.serves(beside):
            self.close()
            self._studio = _Studio(self.model, beside)
        return self._studio


class _Studio:
    """
    The device side of a camera, in its own GL context.

    :param beside: the context whose buffers it draws from; None for one that draws snapshots alone
    """

    def __init__(self, model: CameraModel, beside: Context | None) -> None:
        """Make the context."""
        self._beside = beside
        self._context = Context(beside=beside)
        try:
            if not self._context.max_texture_texels:
                raise DeviceError(
                    f'{self._context.device} lacks texture buffers, which rendering needs: render '
                    'on another device')
            self._cloth = DrawnCloth(self._context.max_texture_texels)
            self._values = ValueDrawing(model.width, model.height)
            self._colors = ColorDrawing(model.width, model.height, model.samples)
        except BaseException:
            self._context.close()
            raise

    def serves(self, beside: Context | None) -> bool:
        """Return whether it has the buffers of the context ``beside``, or needs none."""
        return beside is None or beside is self._beside

    def take(
            self, subject: Subject, lens: Lens, look: Look | None, *, depth: bool, labels: bool,
            normals: bool, visible: bool) -> CameraPicture:
        """
        Return a picture; the arguments are those of ``Camera.capture``.

        :param look: None for a picture without colours
        """
        cloth = subject.cloth
        stored = cloth.stored_positions() if isinstance(cloth, RUNNING) else None
        self._context.make_current()
        self._cloth.load(subject, stored)
        values = None
        if depth or labels or normals or visible:
            values = self._values.draw(
                subject, self._cloth, lens, has_normals=normals or visible)
        seen = image = None
        if visible or look is not None:
            nodes = subject.nodes()
            if values is not None and values.facets is not None and visible:
                seen = visible_nodes(
                    lens.pose.seen_from(nodes), values.depth, values.facets, lens.model)
            if look is not None:
                # Reading nodes from the device has made the context of the cloth current.
                self._context.make_current()
                image = self._colors.draw(subject, self._cloth, lens, look, nodes)
        return CameraPicture(
            lens.model, lens.pose, subject.time, image,
            measured_depth(values.depth, lens.model, subject.time)
            if values is not None and depth else None,
            values.labels if values is not None and labels else None,
            values.normals if values is not None and normals else None, seen,
            (*_LABELS, *(collider.name for collider in subject.colliders)))

    def close(self) -> None:
        """Release the context."""
        self._context.close()


def _context_of(subject: Subject) -> Context | None:
    """Return the context that has the nodes of ``subject``; None for a Snapshot."""
    cloth = subject.cloth
    if isinstance(cloth, Simulation):
        return cloth.engines.context
    return cloth.context if isinstance(cloth, ClothOfBatch) else None
