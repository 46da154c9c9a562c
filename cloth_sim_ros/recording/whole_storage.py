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


"""The messages of a bag that rosbags reads: one mcap or sqlite3 file, or a compressed folder."""

from collections.abc import Collection
from collections.abc import Iterator
from pathlib import Path

from cloth_sim_ros.recording.bag_topic import BagTopic
from cloth_sim_ros.recording.bag_topic import RawMessage
from rosbags.interfaces import Connection
from rosbags.rosbag2 import Reader


class WholeStorage:
    """
    Reads a file that was finished.

    ``problem`` says where reading had to end; it is empty while all went well.

    :raises Exception: of many kinds, when rosbags can't read it
    """

    def __init__(self, path: Path) -> None:
        """Read what is in it."""
        self.path = path
        self.problem = ''
        with Reader(path) as reader:
            self.topics = [_topic(connection) for connection in reader.connections]

    def messages(self, names: Collection[str] | None) -> Iterator[RawMessage]:
        """Yield the messages of the topics ``names``, or of all, in the order of their times."""
        try:
            # A reader of its own for each walk: two walks would move one file's place.
            with Reader(self.path) as reader:
                wanted = [
                    connection for connection in reader.connections
                    if names is None or connection.topic in names]
                # No connection at all means every one to rosbags.
                for connection, time, data in reader.messages(wanted) if wanted else ():
                    yield RawMessage(connection.topic, connection.msgtype, time, data)
        except Exception as error:  # what a damaged byte raises can be anything
            self.problem = (
                f'{self.path.name} is damaged: read up to there '
                f'({error or type(error).__name__})')


def _topic(connection: Connection) -> BagTopic:
    return BagTopic(
        connection.topic, connection.msgtype, tuple(connection.ext.offered_qos_profiles),
        connection.msgcount, connection.msgdef)
