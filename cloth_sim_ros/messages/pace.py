# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A run that is slower than it should be, in words."""


def slow_pace(achieved: float, wanted: float, *, substeps: int, automatic: bool) -> str:
    """
    Return that a run is too slow, and what makes it faster.

    :param achieved: simulated time per wall time
    :param wanted: the same as asked for
    :param substeps: in each dt
    :param automatic: True where they follow from what is stable: a longer dt has more of them
    """
    faster = 'softer springs' if automatic and substeps > 1 else 'a longer dt'
    return (
        f'{achieved:.3g} x real time, below the target {wanted:.3g}: use fewer nodes, {faster}, '
        'another mode or a lower real_time_factor')
