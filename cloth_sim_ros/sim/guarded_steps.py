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

"""Make steps, and stop at the last finite state when one leads out of all bounds."""

from typing import NoReturn

from cloth_sim_ros.sim import blow_up
from cloth_sim_ros.sim.bounds_check import BoundsCheck
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.modes.mode import Mode
from cloth_sim_ros.sim.observer import Observer
from cloth_sim_ros.sim.push_field import PushField
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State

# Between two checks: the read-back of a check waits for the device, and what lies between is
# stepped again when one fails (docs/performance.md).
_MOST_SUBSTEPS = 64


class GuardedSteps:
    """
    Check the state at the end of each batch of steps, and now and then within.

    When a check fails, the steps since the last good one are made again, each with a check of
    its own, and the state goes back to the last that passes. What the mode keeps from step to
    step begins anew there.

    :param guarded: False steps on whatever becomes of the state
    """

    def __init__(
            self, scene: Scene, layout: Layout, observer: Observer, guarded: bool = True) -> None:
        """Allocate what the check needs."""
        self._scene = scene
        self._dt: float = scene['dt']
        self._observer = observer
        self._guarded = guarded
        self._check = BoundsCheck(scene, layout)

    def make(
            self, count: int, mode: Mode, state: State, pushes: PushField, first: int) -> None:
        """
        Make ``count`` steps of ``state``, which is finite; ``first`` were made before.

        :raises NonFiniteStateError: after going back to the last finite state
        """
        state.keep()
        kept = pushes.keep()
        since = substeps = 0
        for done in range(1, count + 1):
            mode.step(state, (first + done - 1) * self._dt, pushes)
            substeps += mode.substeps
            if not self._guarded or (done < count and substeps < _MOST_SUBSTEPS):
                continue
            if not self._check.passes(state):
                state.restore()
                pushes.restore(kept)
                mode.forget()
                self._step_to_the_last_finite(mode, state, pushes, first, since, done)
            state.keep()
            kept = pushes.keep()
            since, substeps = done, 0

    def delete(self) -> None:
        """Give everything back."""
        self._check.delete()

    def _step_to_the_last_finite(
            self, mode: Mode, state: State, pushes: PushField, first: int, since: int,
            end: int) -> NoReturn:
        for done in range(since, end):
            state.keep()
            kept = pushes.keep()
            begin = (first + done) * self._dt
            mode.step(state, begin, pushes)
            if self._check.passes(state):
                continue
            substeps, push = mode.substeps, pushes.strongest(begin, begin + self._dt)
            lost = self._observer.record(state, pushes.still)[1]
            state.restore()
            pushes.restore(kept)
            mode.forget()
            measures, records = self._observer.record(state, pushes.still)
            raise blow_up.explain(
                self._scene, lost, records, mode=mode.name, substeps=substeps,
                stability_limit=mode.stability_limit, time=begin, steps=done,
                strain=measures.max_strain, push=push)
        raise NonFiniteStateError(
            f'the state became non-finite before t = {(first + end) * self._dt:.6g} s in mode '
            f'{mode.name}, but not when the steps since {(first + since) * self._dt:.6g} s were '
            'made again without what the mode had kept from earlier ones: go on from there, or '
            'set a smaller dt', time=(first + end) * self._dt, steps=end)
