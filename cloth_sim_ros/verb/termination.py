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

"""SIGTERM as a wish to stop: what a verb does at Ctrl-C, it does at SIGTERM."""

from collections.abc import Iterator
from contextlib import contextmanager
import signal
from types import FrameType
from typing import NoReturn


class Terminated(KeyboardInterrupt):
    """SIGTERM came: whoever cleans up after Ctrl-C cleans up after this as well."""


@contextmanager
def raise_on_sigterm() -> Iterator[None]:
    """Raise Terminated in the main thread when SIGTERM comes; further ones change nothing."""
    before = signal.getsignal(signal.SIGTERM)
    signal.signal(signal.SIGTERM, _raise)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _raise(_number: int, _frame: FrameType | None) -> NoReturn:
    # What is cleaned up must not be broken off.
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    raise Terminated
