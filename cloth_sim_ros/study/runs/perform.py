# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Make one run, in whatever process this is called."""

from importlib import import_module
import os
import time
from typing import Any

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.study.runs.result import describe
from cloth_sim_ros.study.runs.result import DONE
from cloth_sim_ros.study.runs.result import FAILED
from cloth_sim_ros.study.runs.result import REFUSED
from cloth_sim_ros.study.runs.result import Result
from cloth_sim_ros.study.runs.result import STOPPED
from cloth_sim_ros.study.runs.result import unmade
from cloth_sim_ros.study.runs.run import Run
import numpy as np


def perform(run: Run, shares_processor: bool) -> Result:
    """
    Make ``run``; what goes wrong is in the result.

    :param shares_processor: other runs are made at the same time: a software device gets no
        worker threads, as each process has a processor of its own to fill
    """
    if shares_processor:
        # Read when the first context of this process is made.
        os.environ.setdefault('LP_NUM_THREADS', '0')
    begin = time.perf_counter()
    try:
        module, _, name = run.function.partition(':')
        returned = getattr(import_module(module), name)(dict(run.scene), **run.settings)
        values, arrays = _sorted(returned)
        result = Result(
            **describe(run), outcome=DONE, reason='', values=values,
            device=values.pop('device'), wall_seconds=time.perf_counter() - begin, arrays=arrays)
        result.line()
    except ClothSimError as error:
        outcome = STOPPED if isinstance(error, NonFiniteStateError) else REFUSED
        return unmade(run, outcome, str(error), wall_seconds=time.perf_counter() - begin)
    # One run of many: whatever is wrong with it, the others are made.
    except Exception as error:
        return unmade(
            run, FAILED, f'{type(error).__name__}: {error}',
            wall_seconds=time.perf_counter() - begin)
    return result


def _sorted(returned: dict[str, Any]) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    arrays = {name: value for name, value in returned.items() if isinstance(value, np.ndarray)}
    return {name: value for name, value in returned.items() if name not in arrays}, arrays
