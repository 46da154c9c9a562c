# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One contender on one grid: stepped in turn with others, timed, and recorded once."""

import time

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.modes.contenders import Contender
from cloth_sim_ros.study.modes.run_record import RunRecord

FRAME = 0.02
_NOTHING = 1e-6


class TimedRun:
    """
    Simulates the same seconds in each round, a frame of 20 ms at a time.

    Set-up and what the driver compiles are not timed, nor are snapshots. Steps of dt are timed one
    by one: there are snapshots between those of the first round, and all rounds are to be alike.

    :param context: GL context, which all contenders have in common
    :raises ClothSimError: when the scene can't be run, or a frame is no whole number of dt
    """

    def __init__(self, contender: Contender, grid: int, context: Context) -> None:
        """Compile everything."""
        self.contender = contender
        self.grid = grid
        scene = contender.scene(grid)
        self._steps = round(FRAME / scene['dt'])
        if self._steps < 1 or abs(self._steps * scene['dt'] - FRAME) > _NOTHING * FRAME:
            raise ClothSimError(
                f'a frame of {FRAME:g} s is no whole number of steps of dt, and dt of '
                f'{contender.name} is {scene["dt"]:g} s: give a dt that divides it')
        self._run = Simulation(scene, context=context)
        self._run.engines.compile_all()
        self.wall_seconds: list[float] = []
        self.processor_seconds: list[float] = []
        self._record: RunRecord | None = None
        self.failure: str | None = None

    @property
    def record(self) -> RunRecord:
        """Return what the first round has shown."""
        assert self._record is not None  # begin_round comes first
        return self._record

    @property
    def is_first_round(self) -> bool:
        """Return whether this is the round that is recorded."""
        return len(self.wall_seconds) == 1

    def begin_round(self) -> None:
        """Go back to the start."""
        self._run.reset()
        self.wall_seconds.append(0.0)
        self.processor_seconds.append(0.0)
        if self.is_first_round:
            self._record = RunRecord(self._run.scene, self._run.snapshot())

    def make_frame(self) -> None:
        """Simulate a frame; nothing once the state was lost, which ``failure`` explains."""
        if self.failure is not None:
            return
        try:
            for _ in range(self._steps):
                self._time_step()
                if self.is_first_round:
                    snapshot = self._run.snapshot()
                    self.record.add_step(snapshot)
            if self.is_first_round:
                self.record.add_frame(snapshot)
        except NonFiniteStateError as error:
            self.failure = str(error)

    def close(self) -> None:
        """Give everything on the device back."""
        self._run.close()

    def _time_step(self) -> None:
        self._run.finish()
        wall, processor = time.perf_counter(), time.process_time()
        self._run.step()
        self._run.finish()
        self.wall_seconds[-1] += time.perf_counter() - wall
        self.processor_seconds[-1] += time.process_time() - processor
