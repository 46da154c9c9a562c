# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Programs, buffers and dispatches that a piece of work has used."""

from collections.abc import Iterator
from contextlib import contextmanager
import threading
from typing import Protocol

from cloth_sim_ros.gl.shader_source import ShaderSource


class Compiled(Protocol):
    """
    The attributes of a program that an inventory reports.

    ``name`` is that of its shader, ``dispatches`` counts its runs.
    """

    name: str
    source: ShaderSource
    dispatches: int


class Allocated(Protocol):
    """The attribute of a buffer that an inventory reports."""

    bytes: int  # noqa: A003


class Inventory:
    """
    The programs compiled, and the buffers allocated and not freed, while it was taken.

    It takes note of the thread it was taken on.
    """

    def __init__(self) -> None:
        """Begin with nothing."""
        self.programs: list[Compiled] = []
        self.buffers: list[Allocated] = []

    @property
    def buffer_bytes(self) -> int:
        """Return how much memory the buffers have."""
        return sum(buffer.bytes for buffer in self.buffers)

    def dispatches(self) -> list[int]:
        """Return how often each program has been run, or submitted to a device that decides."""
        return [program.dispatches for program in self.programs]


class _Taken(threading.local):
    """The inventories being taken on each thread."""

    def __init__(self) -> None:
        self.inventories: list[Inventory] = []


_taken = _Taken()


@contextmanager
def take_inventory() -> Iterator[Inventory]:
    """Lend an inventory of all that is compiled and allocated until the end of the block."""
    inventory = Inventory()
    _taken.inventories.append(inventory)
    try:
        yield inventory
    finally:
        _taken.inventories.remove(inventory)


def note_program(program: Compiled) -> None:
    """Put a program that was compiled into the inventories being taken."""
    for inventory in _taken.inventories:
        inventory.programs.append(program)


def note_buffer(buffer: Allocated) -> None:
    """Put a buffer that was allocated into the inventories being taken."""
    for inventory in _taken.inventories:
        inventory.buffers.append(buffer)


def drop_buffer(buffer: Allocated) -> None:
    """Take a buffer that was given back out of them."""
    for inventory in _taken.inventories:
        if buffer in inventory.buffers:
            inventory.buffers.remove(buffer)
