# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""cloth_sim mode."""


def test_switches(verb):
    """A mode could not be chosen from the command line."""
    result = verb('mode', 'mass_spring')
    assert (result.returncode, result.stdout) == (0, 'mode mass_spring, was mass_spring\n')


def test_tells_why_not(verb):
    """A script would continue with another mode than it asked for."""
    result = verb('mode', 'fluid')
    assert (result.returncode, result.stdout) == (1, '')
    assert 'must be one of' in result.stderr
