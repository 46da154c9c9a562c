# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Encode video with PyAV."""

from fractions import Fraction
from pathlib import Path

import av
from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np

# The best first; each with the options for good quality.
_CODECS = {
    'libx264': {'crf': '18', 'preset': 'medium'},
    'libopenh264': {'rc_mode': 'quality'},
    'mpeg4': {'qscale': '2'},
}
_BITS = 0.25          # a pixel of an image, where the encoder has no measure of quality
_FINEST = 1001        # 30000/1001 images a second is usual


class AvVideo:
    """
    A video file.

    :param size: width and height [pixel], both even
    :raises OSError: when the file can't be written
    """

    def __init__(self, path: str | Path, size: tuple[int, int], fps: float) -> None:
        """Open the file."""
        codec = next((name for name in _CODECS if _is_known(name)), None)
        if codec is None:
            raise ClothSimError(
                'this PyAV can encode none of ' + ', '.join(_CODECS) + ': run `pip install av`')
        try:
            self._container = av.open(str(path), 'w')
        except ValueError as error:
            raise ClothSimError(
                f'{path} has no file extension of a video: name it *.mp4') from error
        rate = Fraction(fps).limit_denominator(_FINEST)
        try:
            stream = self._container.add_stream(codec, rate=rate, options=_CODECS[codec])
        except ValueError as error:
            self._container.close()
            raise ClothSimError(f'{path} takes no {codec} video: name it *.mp4') from error
        assert isinstance(stream, av.VideoStream)  # as all of _CODECS are
        stream.width, stream.height = size
        stream.pix_fmt = 'yuv420p'
        if codec != 'libx264':
            stream.bit_rate = round(_BITS * size[0] * size[1] * fps)
        self._stream = stream
        # Fails now if the file can't be written, not after the first images.
        self._container.start_encoding()

    def write(self, image: np.ndarray) -> None:
        """Append ``image``, (height, width, 3) uint8."""
        frame = av.VideoFrame.from_ndarray(image, format='rgb24')
        self._container.mux(self._stream.encode(frame))

    def close(self) -> None:
        """Finish the file."""
        try:
            self._container.mux(self._stream.encode(None))
        finally:
            self._container.close()


def _is_known(name: str) -> bool:
    try:
        av.codec.Codec(name, 'w')
    except av.codec.codec.UnknownCodecError:
        return False
    return True
