# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a shader takes to compile is found for each one that a mode has."""

from cloth_sim_ros.gl import program
from cloth_sim_ros.gl import quick_calls
from compile_times import compile_times


def test_every_shader_of_a_mode_has_its_times():
    """A shader that takes seconds to compile would be missing, or have another name."""
    before = program._linked, quick_calls.use_program, quick_calls.dispatch
    found, whole = compile_times({'mode': 'constraint', 'rows': 20, 'cols': 20})
    assert before == (program._linked, quick_calls.use_program, quick_calls.dispatch)
    assert {'observe.comp', 'solver/right_side.comp', 'solver/smooth.comp'} <= set(found)
    assert found['observe.comp'].variants == 3, 'for measures, a snapshot, and a closing limit'
    assert found['solver/right_side.comp'].variants == 1, 'for first solves and for further ones'
    seconds = [took.seconds for took in found.values()]
    assert seconds == sorted(seconds, reverse=True)
    assert 0.0 < sum(seconds) < whole
    # All that a step runs is among them, also what the device may have switched off.
    assert all(took.running > 0.0 for name, took in found.items() if 'limit' not in name
               and 'start_between' not in name)
