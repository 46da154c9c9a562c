# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Annotations say what the labels say, in the format of COCO."""

from cloth_sim_ros.camera.picture import CameraPicture
from cloth_sim_ros.dataset.coco import categories
from cloth_sim_ros.dataset.coco import keypoints
from cloth_sim_ros.dataset.coco import mask_annotations
from cloth_sim_ros.dataset.coco import run_lengths
from cloth_sim_ros.sim.model.cameras import CameraModel
import numpy as np
import pytest

CAMERA = CameraModel.of(
    position=[0.0, 0.0, 1.0], target=[0.0, 0.0, 0.0], width=9, height=7,
    intrinsics=[8.0, 8.0, 4.0, 3.0])
NAMES = ('background', 'cloth', 'ball', 'table')


def mask_of(counts, size):
    """Return the mask of run lengths, as the format defines them."""
    values = np.repeat(np.arange(len(counts)) % 2, counts)
    return values.reshape(size, order='F').astype(bool)


@pytest.mark.parametrize('share', [0.0, 0.1, 0.5, 1.0])
def test_run_lengths_are_those_of_the_mask(share):
    """A reader would train on a mask that is shifted or turned."""
    mask = np.random.default_rng(1).uniform(size=(7, 9)) < share
    counts = run_lengths(mask)
    assert sum(counts) == mask.size
    np.testing.assert_array_equal(mask_of(counts, mask.shape), mask)


def test_annotations_add_up_to_the_labels():
    """Some pixels would be annotated twice, or a body that is not in the picture be there."""
    labels = np.random.default_rng(2).integers(0, 3, (7, 9)).astype(np.uint8)
    picture = CameraPicture(CAMERA, CAMERA.pose, 1.0, None, None, labels, None, None, NAMES)
    found = mask_annotations(picture, [(0.0, 0.0, 0), (1.5, 2.5, 2), (0.0, 0.0, 0), (3.5, 2.5, 1)])
    assert [entry['category_id'] for entry in found] == [1, 2]
    for entry in found:
        mask = mask_of(entry['segmentation']['counts'], entry['segmentation']['size'])
        np.testing.assert_array_equal(mask, labels == entry['category_id'])
        x, y, width, height = entry['bbox']
        assert entry['area'] == mask.sum() == mask[y:y + height, x:x + width].sum()
        assert mask[y].any() and mask[:, x].any()
        assert mask[y + height - 1].any() and mask[:, x + width - 1].any()
    assert found[0]['num_keypoints'] == 2 and len(found[0]['keypoints']) == 12
    assert 'keypoints' not in found[1]
    assert [entry['name'] for entry in categories(NAMES)] == ['cloth', 'ball', 'table']


def test_keypoints_are_the_projected_corners():
    """A detector would learn corners half a pixel off, or hidden ones as seen."""
    nodes = np.array([[(-0.25, 0.25, 0.0), (0.25, 0.25, 0.0)],
                      [(-9.0, -0.25, 0.0), (0.25, -0.25, 0.0)]])
    visible = np.array([[True, False], [True, True]])
    picture = CameraPicture(CAMERA, CAMERA.pose, 1.0, None, None, None, None, visible, NAMES)
    np.testing.assert_allclose(keypoints(picture, nodes), [
        (2.5, 1.5, 2), (6.5, 1.5, 1), (0.0, 0.0, 0), (6.5, 5.5, 2)], atol=1e-9)
