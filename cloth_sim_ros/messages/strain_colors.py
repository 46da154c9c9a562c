# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Colours for strain, even steps to the eye."""

import numpy as np

FULL_STRAIN = 0.1  # drawn, like all above it, in the last colour

# The viridis map of matplotlib at eleven places, 0 to 1.
_VIRIDIS = (
    '440154', '482475', '414487', '355f8d', '2a788e', '21918c',
    '22a884', '44bf70', '7ad151', 'bddf26', 'fde725')
_STEPS = 256


def _palette() -> np.ndarray:
    anchors = np.array([list(bytes.fromhex(color)) for color in _VIRIDIS]) / 255.0
    places = np.linspace(0.0, 1.0, _STEPS)
    known = np.linspace(0.0, 1.0, len(anchors))
    channels = [np.interp(places, known, anchors[:, channel]) for channel in range(3)]
    return np.stack([*channels, np.ones(_STEPS)], axis=-1).astype('<f4')


_PALETTE = _palette()


def strain_colors(strain: np.ndarray) -> np.ndarray:
    """
    Return the colour of each strain, dark at rest and bright from FULL_STRAIN on.

    :param strain: of any shape, 0 or more; what is not a number takes the last colour
    :return: red, green, blue, alpha from 0 to 1, shape (..., 4) float32
    """
    steps = np.fmin(strain * ((_STEPS - 1) / FULL_STRAIN), _STEPS - 1)
    return _PALETTE[steps.astype(np.intp)]
