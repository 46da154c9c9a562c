# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The verdict on a resimulated run."""

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.resimulation.frame_check import Difference
from cloth_sim_ros.resimulation.frame_check import FrameCheck
from cloth_sim_ros.resimulation.rerun import Rerun
from cloth_sim_ros.sim.model.scene_fields import Field

_MOST_REFUSED = 5


class Verdict:
    """
    Sentences about a finished Rerun.

    ``reasons`` says why its bits may be others than the recorded ones; empty when they may not.

    :param rerun: made to its end
    :param device: GL_RENDERER of the recorded run; empty when that is not known
    :param versions: of this project, of the recorded run and of this one; empty when not known
    """

    def __init__(self, rerun: Rerun, device: str, versions: tuple[str, str]) -> None:
        """Collect the reasons."""
        self._rerun = rerun
        self._check: FrameCheck = rerun.check
        self._origin = _origin(device, rerun.simulation.device, versions)
        self.reasons = [*self._origin]
        if rerun.changed:
            self.reasons.append(f'{", ".join(rerun.changed)} set to other values')
        if rerun.left_out_modes:
            self.reasons.append('the mode is not switched')
        self.reasons += [f'the recording does not contain {what}' for what in rerun.unknown]
        if rerun.refused:
            self.reasons.append('some recorded inputs are left out')

    @property
    def frames(self) -> FrameCheck:
        """Get the comparison of the frames."""
        return self._check

    @property
    def is_failure(self) -> bool:
        """Return whether the run should have the same bits and has not, or was not made at all."""
        if self._rerun.problem and not self._rerun.has_recorded_stop:
            return True
        return not self.reasons and self._check.equal < self._check.frames

    def lines(self) -> list[str]:
        """Return what came out, in words."""
        origin = [f'bits may differ: {reason}' for reason in self._origin]
        return [*self._frames(), *origin, *self._end(), *self._left_out()]

    def _frames(self) -> list[str]:
        check = self._check
        if check.other_grids:
            scene = self._rerun.simulation.scene
            return [
                f'{check.other_grids} frames have another grid than the {scene.rows} x '
                f'{scene.cols} of this run: they cannot be compared node by node']
        if not check.frames:
            return ['no frame was recorded, so there is nothing to compare with']
        lines = [f'{check.equal} of {check.frames} frames bitwise identical']
        if check.first is not None and check.largest is not None:
            lines += [
                f'first difference: {_in_words(check.first)}',
                f'largest difference: {_in_words(check.largest)}',
                f'RMS distance of the nodes in the last frame: {check.last_rms:.3g} m']
            lines += [f'bits may differ: {reason}' for reason in self.reasons
                      if reason not in self._origin]
            if not self.reasons:
                lines.append(
                    'this run should be bitwise identical: the recording was changed, or the '
                    'simulator is not deterministic here')
        if check.missing_fields:
            lines.append(f'the recorded points lack {", ".join(check.missing_fields)}')
        return lines

    def _end(self) -> list[str]:
        rerun = self._rerun
        if rerun.problem:
            stopped = 'as the recorded one did' if rerun.has_recorded_stop else (
                'before the recording ends')
            return [f'the run stopped {stopped}: {rerun.problem}']
        if rerun.has_recorded_stop and not rerun.changed:
            return ['the recorded run stopped at its end, this one can continue']
        return []

    def _left_out(self) -> list[str]:
        refused = self._rerun.refused
        lines = [f'left out: {reason}' for reason in refused[:_MOST_REFUSED]]
        if len(refused) > _MOST_REFUSED:
            lines.append(f'left out: {len(refused) - _MOST_REFUSED} more')
        if self._rerun.left_out_modes:
            lines.append(
                f'left out: {self._rerun.left_out_modes} recorded switches of the mode, because '
                '--set mode applies to the whole run')
        return lines


def _origin(recorded_device: str, device: str, versions: tuple[str, str]) -> list[str]:
    recorded, present = versions
    reasons = []
    if recorded_device != device:
        reasons.append(
            f'recorded on {recorded_device or "an unknown device"}, this is {device}: results are '
            'bitwise reproducible only on the same device')
    if recorded != present:
        reasons.append(
            f'recorded by {_named(recorded)} of cloth_sim_ros, this is {_named(present)}')
    return reasons


def _named(version: str) -> str:
    return f'version {version}' if version else 'a version that is not named'


def version_lines(
        missing: tuple[Field, ...], unknown: tuple[str, ...],
        changes: frozenset[str]) -> list[str]:
    """
    Return the lines on parameters that only this version, or only that of the recording, has.

    :param missing: parameters of this version that were not recorded
    :param unknown: names of recorded parameters that this version lacks
    :param changes: names of the parameters that replace recorded ones
    """
    lines = [
        f'not recorded, so the default is used: {field.name} {shown(field.default)}'
        for field in missing if field.name not in changes]
    return lines + [f'recorded, but unknown here and left out: {name}' for name in unknown]


def _in_words(difference: Difference) -> str:
    row, col = difference.node
    apart = f'{difference.distance:.3g} m apart' if difference.distance else (
        'at the same position')
    return (
        f'frame {difference.frame} (t = {difference.time:.6g} s), node ({row}, {col}), {apart}; '
        f'{", ".join(difference.fields)} differ')
