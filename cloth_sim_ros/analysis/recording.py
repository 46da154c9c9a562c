# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.


"""A recording to read: messages of one node, from first to last, one in memory at a time."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cloth_sim_ros.analysis.steady_time import SteadyTime
from cloth_sim_ros.sim.errors import ClothSimError
from mcap.exceptions import EndOfFile
from mcap.exceptions import InvalidMagic
from mcap.reader import NonSeekingReader
from mcap_ros2.decoder import DecoderFactory


@dataclass(frozen=True)
class Entry:
    """
    One message of a recording.

    :param key: the topic behind the name of the node, such as points or inputs/push
    :param time: [s] simulated, going on where a reset put the clock back
    :param message: decoded
    """

    key: str
    time: float
    message: Any


class Recording:
    """
    The mcap files of one recording folder, or one mcap file.

    A recording that was cut off is read up to its last whole record.

    :param node: name of the node, with its namespace
    :raises ClothSimError: when there is nothing that can be read
    """

    def __init__(self, path: str | Path, node: str = 'cloth_sim') -> None:
        """Find the files."""
        self.path = Path(path)
        self.node = f'/{node.strip("/")}'
        self._files = _find_files(self.path)

    def entries(self, *keys: str) -> Iterator[Entry]:
        """
        Yield the messages of the topics ``keys`` as they were recorded.

        :raises ClothSimError: when a file is no recording
        """
        names = {f'{self.node}/{key}': key for key in keys}
        time = SteadyTime()
        for file in self._files:
            for name, message in _decoded(file, list(names)):
                header = getattr(message, 'header', None)
                if header is not None:
                    time.read(header.stamp)
                yield Entry(names[name], time.now, message)

    def no_frame(self) -> ClothSimError:
        """Return the error of those who find no frame of the cloth."""
        return ClothSimError(
            f'{self.path} holds no frame of the node {self.node}: name the recorded node with '
            '--node, or record with publish.points: true')


def _decoded(file: Path, topics: list[str]) -> Iterator[tuple[str, Any]]:
    with open(file, 'rb') as stream:
        reader = NonSeekingReader(stream, decoder_factories=[DecoderFactory()])
        try:
            for _, channel, _, message in reader.iter_decoded_messages(
                    topics, log_time_order=False):
                yield channel.topic, message
        except InvalidMagic as error:
            raise ClothSimError(
                f'{file} is no mcap file: give the folder of a recording') from error
        except EndOfFile:
            # A killed run ends in half a record; all before it counts.
            return


def _find_files(path: Path) -> list[Path]:
    if path.is_file():
        return [path]
    if not path.is_dir():
        raise ClothSimError(f'there is no recording {path}: give its folder or its mcap file')
    # rosbag2 numbers the files of a split recording without leading zeros.
    files = sorted(path.glob('*.mcap'), key=lambda file: (len(file.name), file.name))
    if not files:
        raise ClothSimError(f'{path} holds no mcap file: give the folder of a recording')
    return files
