# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How far a run has come, how far it is to go, and what waits for the end of a step."""

from collections.abc import Callable
from collections.abc import Generator
from collections.abc import Iterable
import math

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim import modes
from cloth_sim_ros.sim.arguments import integer
from cloth_sim_ros.sim.arguments import real_number
from cloth_sim_ros.sim.colliders import Collider
from cloth_sim_ros.sim.engine import Engines
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.loads import Loads

# Makes up to a number of steps, from the step of another number on, in pieces.
MakeSteps = Callable[[int, int], Generator[None, None, None]]


# Seconds are an int32 in a stamp of ROS, and changes are stamped with the end of a step [s].
LATEST = 2**31 - 2
# Of a step: later by this is no later.
_NOTHING = 1e-6


class Stepping:
    """
    Count steps of dt towards an aim, and hold changes back while one is under way.

    :param dt: [s]
    :param steps: made before
    """

    _carried: float

    def __init__(self, dt: float, steps: int = 0) -> None:
        """Aim at the present moment."""
        self._dt = dt
        self.steps = steps
        self.is_mid_step = False
        # Which is not the next one after ``steps``, where several are checked together.
        self.step_under_way = steps
        # Changes to make when the step under way has ended.
        self._edits: list[Callable[[], object]] = []
        # Changes of the scene: the number of steps before each.
        self._timed: list[tuple[int, Callable[[], object]]] = []
        self.drop_aim()

    @property
    def time(self) -> float:
        """Return the simulated time [s]."""
        return self.steps * self._dt

    @property
    def edit_time(self) -> float:
        """Return when changes that are asked for now are made [s]."""
        return self.edit_step * self._dt

    @property
    def edit_step(self) -> int:
        """Return how many steps are made before changes that are asked for now."""
        return self.step_under_way + 1 if self.is_mid_step else self.steps

    @property
    def is_behind(self) -> bool:
        """Tell whether there are steps to make before the aim is reached."""
        return self.steps < self._goal

    @property
    def next_timed_edit(self) -> float:
        """Return how many steps are made before the next timed change; infinite for none."""
        return self._timed[0][0] if self._timed else math.inf

    @property
    def has_edits(self) -> bool:
        """Tell whether changes wait for the end of the step."""
        return bool(self._edits) or any(
            step == self.step_under_way + 1 for step, _ in self._timed)

    def is_last(self, number: int) -> bool:
        """Tell whether the aim is reached with the step of that ``number``."""
        return number + 1 == self._goal

    def aim(self, seconds: float) -> None:
        """Go on for ``seconds`` more; what is no whole dt is carried over."""
        carried = self._carried + self.checked_seconds(seconds)
        # The small share keeps a sum of frame times from falling just short of a step.
        count = math.floor(carried / self._dt + 1e-6)
        self._aim_at(self._goal + count)
        # Only what is left over is summed: a sum of all times would lose its last digits.
        self._carried = carried - count * self._dt

    def checked_seconds(self, seconds: float) -> float:
        """Return ``seconds`` as a float; ClothSimError where a run can't go on for so long."""
        seconds = real_number(seconds, 'the time to advance by', 'give it in seconds')
        if not math.isfinite(seconds) or seconds < 0.0:
            raise ClothSimError(f'cannot advance by {seconds} s: give a time of 0 s or more')
        # Before it is counted in steps, of which there may be more than a float can tell.
        refuse_later_than_latest(self.time + self._carried + seconds)
        return seconds

    def aim_steps(self, count: int) -> None:
        """Make ``count`` steps of dt from now on."""
        self._aim_at(self.steps + checked_steps(count, self.steps, self._dt))
        self._carried = 0.0

    def drop_aim(self) -> None:
        """Let the aim be where the run is."""
        self._goal, self._carried = self.steps, 0.0

    def run(self, make_steps: MakeSteps) -> Generator[None, None, None]:
        """Make steps towards the aim; yield where ``make_steps`` does, within a step."""
        pieces = make_steps(self.steps, self._goal - self.steps)
        try:
            for _ in pieces:
                self.is_mid_step = True
                yield
        except NonFiniteStateError as error:
            self.steps = error.steps
            self.drop_aim()
            self._make_edits()
            raise
        except Exception:
            self.drop_aim()
            raise
        finally:
            pieces.close()
            self.is_mid_step = False
            self._take_edits()

    def settle(self, steps: int) -> None:
        """Have made ``steps``, and make the changes that waited for it."""
        self.steps = steps
        self._make_edits()

    def at_rest(self, edit: Callable[[], object]) -> None:
        """Make a change of the state now, or when the step under way has ended."""
        if self.is_mid_step:
            self._edits.append(edit)
        else:
            edit()

    def at_end_of_step(self, edit: Callable[[], object]) -> None:
        """Make a change of the state when the step that is being made has ended."""
        self._edits.append(edit)

    def at_times(self, edits: Iterable[tuple[float, Callable[[], object]]]) -> None:
        """
        Make changes at their times [s], each at the first end of a step that is not earlier.

        Those of the present moment are made at once at the start of a run; on the way, what is
        no later has been made.
        """
        numbered = [
            (math.ceil(time / self._dt - _NOTHING), edit) for time, edit in edits]
        self._timed = sorted(
            (entry for entry in numbered if entry[0] > self.steps or self.steps == 0),
            key=lambda entry: entry[0])
        self._make_edits()

    def refuse_mid_step(self, name: str) -> None:
        """Raise RuntimeError while a step is under way."""
        if self.is_mid_step:
            raise RuntimeError(
                f'{name} needs the current step to end: continue its work, or close it')

    def _aim_at(self, goal: int) -> None:
        refuse_later_than_latest(goal * self._dt)
        self._goal = goal

    def _make_edits(self) -> None:
        self.is_mid_step = False
        while self._timed and self._timed[0][0] <= self.steps:
            self._timed.pop(0)[1]()
        for edit in self._take_edits():
            edit()

    def _take_edits(self) -> list[Callable[[], object]]:
        edits, self._edits = self._edits, []
        return edits


def checked_steps(count: int, made: int, dt: float) -> int:
    """
    Return ``count`` as an int, or raise ClothSimError when so many steps of dt can't be made.

    :param made: steps before
    :param dt: [s]
    """
    count = integer(count, 'the number of steps', 'give an int, or advance by seconds')
    if count < 0:
        raise ClothSimError(f'cannot make {shown(count)} steps: give 0 or more')
    # An int of any size is compared with a float without overflow.
    refuse_later_than_latest((made + count) * dt if count < LATEST / dt else math.inf)
    return count


def refuse_later_than_latest(time: float) -> None:
    """Raise ClothSimError when a run would go on until ``time`` [s]."""
    if time > LATEST:
        raise ClothSimError(
            f'simulated time ends at {LATEST} s, like ROS time stamps, and the run would '
            f'reach {time:.10g} s: reset it, which restarts at 0')


class RunStatus:
    """The numbers of a Simulation that are known without asking the device."""

    engines: Engines
    loads: Loads
    stepping: Stepping

    @property
    def is_ready(self) -> bool:
        """Tell whether there is a mode to advance with."""
        return self.engines.current is not None

    @property
    def mode(self) -> str:
        """Return the name of the mode that steps now, or will be the first to."""
        return self.engines.mode

    @property
    def available_modes(self) -> tuple[str, ...]:
        """Return the modes ``set_mode`` takes."""
        return tuple(modes.AVAILABLE)

    @property
    def steps(self) -> int:
        """Return the steps of dt made since the start or the last reset."""
        return self.stepping.steps

    @property
    def time(self) -> float:
        """Return the simulated time since the start or the last reset [s]."""
        return self.stepping.time

    @property
    def substeps(self) -> int:
        """Return the substeps in a step of dt; 0 before there is a mode."""
        return self.engines.in_use.mode.substeps if self.is_ready else 0

    @property
    def stability_limit(self) -> float:
        """Return the longest stable substep of the mode [s]; infinite before there is one."""
        return self.engines.in_use.mode.stability_limit if self.is_ready else math.inf

    @property
    def stability_margin(self) -> float:
        """Return the substep over what it should be at most, see Snapshot."""
        return self.engines.in_use.mode.substep_margin if self.is_ready else 0.0

    @property
    def colliders(self) -> tuple[Collider, ...]:
        """Return the colliders of the scene where they are now."""
        contacts = self.loads.contacts
        return () if contacts is None else contacts.present(self.time)
