# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The pictures that a look names: the print of a fabric, and what is behind everything."""

from io import BytesIO

from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.regular_file import read_regular
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.look import Look
import numpy as np

# Max. size of a file [bytes], and pixels of a picture [1].
_MOST_BYTES = 2**26
_MOST_PIXELS = 8192**2
# Formats that Pillow reads by itself, without running other programs.
_FORMATS = ('PNG', 'JPEG', 'BMP', 'WEBP')


def load_picture(path: str, parameter: str) -> np.ndarray:
    """
    Return the picture in a file, (height, width, 3) uint8.

    :param parameter: that names the file, for the error
    :raises ClothSimError: when there is none
    """
    # Only a look with pictures needs it.
    from PIL import Image
    way_out = f'give an image of {", ".join(_FORMATS)}, or leave {parameter} out'
    try:
        with Image.open(BytesIO(read_regular(path, _MOST_BYTES)), formats=_FORMATS) as image:
            if image.width * image.height > _MOST_PIXELS:
                raise ClothSimError(
                    f'{parameter} {cut(path)} has {image.width} x {image.height} pixels, more '
                    f'than {_MOST_PIXELS}: {way_out}')
            return np.asarray(image.convert('RGB'))
    except FileNotFoundError as error:
        raise ClothSimError(f'{parameter}: there is no file {cut(path)}: {way_out}') from error
    except ClothSimError:
        raise
    except Exception as error:
        raise ClothSimError(
            f'{parameter} {cut(path)} is no picture ({cut(error)}): {way_out}') from error


def check_pictures(look: Look) -> None:
    """Raise ClothSimError when a picture that ``look`` names is not there."""
    if look.texture:
        load_picture(look.texture, 'look.texture')
    if look.backdrop:
        load_picture(look.backdrop, 'look.backdrop')
