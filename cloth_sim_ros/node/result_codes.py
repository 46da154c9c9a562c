# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Why a request was refused or has ended, as a number for programs."""

from cloth_sim_interfaces.msg import ResultCode
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.recording.recording_faults import RecordingError
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NameTakenError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.errors import NotFoundError
from cloth_sim_ros.sim.errors import WrongStateError


class UnknownFrameError(ClothSimError):
    """A frame of tf is not known, or not at the stamp."""


class InterruptedRequestError(ClothSimError):
    """A pause, a reset or another request came before this one was carried out."""


class RunFailedError(ClothSimError):
    """The run could not go on, for another reason than a state that is not finite."""


class CanceledError(ClothSimError):
    """A request has ended as it was asked to."""


class StalledError(ClothSimError):
    """A move has ended before its end point, as the cloth pulls too hard."""


_CODES: tuple[tuple[type[Exception], int], ...] = (
    (UnknownFrameError, ResultCode.UNKNOWN_FRAME),
    (NotFoundError, ResultCode.NOT_FOUND),
    (NameTakenError, ResultCode.NAME_TAKEN),
    (WrongStateError, ResultCode.WRONG_STATE),
    (InterruptedRequestError, ResultCode.INTERRUPTED),
    (CanceledError, ResultCode.CANCELED),
    (StalledError, ResultCode.STALLED),
    (NonFiniteStateError, ResultCode.RUN_STOPPED),
    (RunFailedError, ResultCode.RUN_STOPPED),
    (DeviceError, ResultCode.RUN_STOPPED),
    (RecordingError, ResultCode.NOT_WRITTEN),
    (ClothSimError, ResultCode.INVALID_VALUE))


def code_of(error: Exception) -> int:
    """Return the constant of ResultCode that ``error`` stands for."""
    return next(
        (code for kind, code in _CODES if isinstance(error, kind)), ResultCode.UNEXPECTED)
