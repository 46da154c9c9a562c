# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Substeps of springs and of limits by a list, as calls that are made over and over."""

from typing import NamedTuple

from cloth_sim_ros.gl.quick_calls import Call
from cloth_sim_ros.gl.quick_calls import make
from cloth_sim_ros.sim.limits.active_limits import ActiveLimits
from cloth_sim_ros.sim.limits.limit_program import Limits
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.modes.mass_spring import OnePass
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.stop import leave_if
from cloth_sim_ros.sim.stop import Stop


class _Calls(NamedTuple):
    """Those of a substep from one pair of buffers to another."""

    springs: list[Call]
    look: list[Call]
    limits: list[Call]


class ListedSubsteps:
    """
    Substeps that differ in nothing but the buffers they read and write.

    To put a substep together takes Python as long as the device needs for all passes of a small
    cloth. So it is done once for each pair of buffers.
    """

    def __init__(self, springs: OnePass, limits: ActiveLimits) -> None:
        """Remember whose passes they are."""
        self._springs = springs
        self._limits = limits
        self._state: State | None = None
        self._calls: dict[tuple[int, int, bool], _Calls] = {}

    def can_make(self, state: State, forcing: Forcing, limits: Limits) -> bool:
        """Return whether substeps are such, as long as ``forcing`` stays."""
        return not (
            limits.is_rough or self._limits.are_many or state.has_low_parts
            or forcing.has_regions or forcing.touch is not None)

    def make(
            self, state: State, forcing: Forcing, limits: Limits, most: int, stop: Stop) -> int:
        """Step ``state`` on up to ``most`` times under the same ``forcing``; return how often."""
        springs, held = self._springs, self._limits
        if state is not self._state:
            self.forget()
            self._state = state
        entries = state.next_held_entries(most)
        records = entries[0] >= 0
        step = springs.begin(forcing, limits.length, records=records)
        solve = held.begin_alike(limits)
        for entry in entries:
            leave_if(stop)
            key = (*state.pair, records)
            if key not in self._calls:
                self._calls[key] = _Calls(
                    springs.calls(state, step), held.look_calls(state), held.calls(state))
            calls = self._calls[key]
            if records:
                step.set_int_anywhere('held_at', entry)
                solve.set_int_anywhere('held_at', entry)
            make(calls.springs)
            if held.take_look():
                make(calls.look)
            make(calls.limits)
            held.end_first()
            state.swap()
        springs.made(step, len(entries), entries[-1])
        held.made(len(entries))
        return len(entries)

    def forget(self) -> None:
        """Drop the calls: buffers they name may be gone."""
        self._calls.clear()
        self._state = None
