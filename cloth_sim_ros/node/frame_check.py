# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Which frames a message may be given in."""

from cloth_sim_ros.files.echo import shown
from cloth_sim_ros.sim.errors import ClothSimError


def check_frame(given: str, own: str) -> None:
    """Raise ClothSimError unless the frame ``given`` is the cloth's ``own``, or empty."""
    if given not in ('', own):
        raise ClothSimError(
            f'its frame is {shown(given)} but the frame of the cloth is {shown(own)}: transform '
            'it to the latter, or choose that as the fixed frame')
