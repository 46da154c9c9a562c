# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Annotations in the format of COCO, as pycocotools reads them.

Masks are run lengths of columns, uncompressed (https://cocodataset.org/#format-data).
"""

from collections.abc import Sequence
from typing import Any

from cloth_sim_ros.camera.picture import CameraPicture
import numpy as np

CORNERS = ('top_left', 'top_right', 'bottom_left', 'bottom_right')
_CLOTH = 1
# Visibility of a keypoint: not in the picture, hidden, seen.
_ABSENT, _HIDDEN, _SEEN = 0, 1, 2


def run_lengths(mask: np.ndarray) -> list[int]:
    """Return how many pixels are out of ``mask``, in it, out of it ... column by column."""
    flat = mask.ravel(order='F')
    ends = np.flatnonzero(flat[1:] != flat[:-1]) + 1
    lengths = np.diff(np.concatenate([[0], ends, [flat.size]])).tolist()
    return [0, *lengths] if flat[0] else lengths


def categories(names: Sequence[str]) -> list[dict[str, Any]]:
    """Return the categories of the labels ``names``, without the background."""
    return [
        {'id': number, 'name': name,
         **({'keypoints': list(CORNERS), 'skeleton': [[1, 2], [2, 4], [4, 3], [3, 1]]}
            if number == _CLOTH else {})}
        for number, name in enumerate(names) if number]


def mask_annotations(
        picture: CameraPicture, corners: Sequence[Sequence[float]]) -> list[dict[str, Any]]:
    """
    Return the annotations of a picture with labels, without ids.

    :param corners: as ``keypoints`` returns them
    """
    assert picture.labels is not None
    found = []
    for number in range(1, len(picture.label_names)):
        mask = picture.labels == number
        if not mask.any():
            continue
        rows, cols = (np.flatnonzero(mask.any(axis=axis)) for axis in (1, 0))
        entry: dict[str, Any] = {
            'category_id': number, 'iscrowd': 0, 'area': int(mask.sum()),
            'bbox': [int(cols[0]), int(rows[0]), int(np.ptp(cols)) + 1, int(np.ptp(rows)) + 1],
            'segmentation': {'size': list(mask.shape), 'counts': run_lengths(mask)}}
        if number == _CLOTH:
            entry['keypoints'] = [part for corner in corners for part in corner]
            entry['num_keypoints'] = sum(corner[2] > 0 for corner in corners)
        found.append(entry)
    return found


def keypoints(picture: CameraPicture, nodes: np.ndarray) -> list[tuple[float, float, int]]:
    """
    Return where the corners of the cloth are [pixel], and whether they are seen.

    :param nodes: (rows, cols, 3) [m]; NaN where there is none
    """
    assert picture.visible is not None
    camera = picture.camera
    found = []
    for row, col in ((0, 0), (0, -1), (-1, 0), (-1, -1)):
        seen = picture.pose.seen_from(nodes[row, col][None])[0]
        u, v = camera.project(seen)
        if not (seen[2] > 0.0 and -0.5 <= u < camera.width - 0.5
                and -0.5 <= v < camera.height - 0.5):
            found.append((0.0, 0.0, _ABSENT))
            continue
        # COCO counts from the corner of a pixel.
        found.append((
            float(u) + 0.5, float(v) + 0.5, _SEEN if picture.visible[row, col] else _HIDDEN))
    return found
