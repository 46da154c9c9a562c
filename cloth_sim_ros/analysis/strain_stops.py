# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The colours of strain in pictures, videos and the view."""

import numpy as np

# Red, green and blue from 0 to 255 at even steps from no strain to the end of the scale. Light at
# rest: folds are seen by their shade, which a dark colour would hide.
STRAIN_STOPS = (
    (195, 211, 232), (230, 223, 174), (244, 185, 66), (224, 99, 43), (156, 20, 41))


def strain_rgb(share: np.ndarray) -> np.ndarray:
    """
    Return red, green and blue from 0 to 255 of strains, (..., 3) uint8.

    :param share: of the end of the scale, from 0 to 1; NaN has the last colour
    """
    places = np.linspace(0.0, 1.0, len(STRAIN_STOPS))
    known = np.nan_to_num(np.asarray(share, float), nan=1.0)
    channels = [
        np.interp(known, places, [stop[channel] for stop in STRAIN_STOPS])
        for channel in range(3)]
    return np.stack(channels, axis=-1).round().astype(np.uint8)
