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

"""The frames nearest to given times, out of a stream."""

from collections.abc import Iterable
from collections.abc import Iterator

from cloth_sim_ros.analysis.frame import Frame


def nearest_frames(frames: Iterable[Frame], times: Iterable[float]) -> Iterator[Frame]:
    """
    Yield the frame nearest to each of ``times`` [s]; two are in memory at a time.

    :param frames: at least one, in the order of time
    :param times: which grow
    """
    stream = iter(frames)
    before = after = next(stream)
    for time in times:
        while after is not None and after.time < time:
            before, after = after, next(stream, None)
        is_before_nearer = after is None or time - before.time < after.time - time
        yield before if is_before_nearer else after
