# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The verb lists each fabric with its numbers and their source."""

from cloth_sim_ros.sim.model.materials import FABRICS
from cloth_sim_ros.verb.main import main


def test_it_lists_all_fabrics(capsys):
    """A user could not tell which fabrics there are, or where their numbers come from."""
    assert main(['materials']) == 0
    header, *lines, source = capsys.readouterr().out.splitlines()
    assert header.split()[:2] == ['name', 'kg/m2']
    assert [line.split()[0] for line in lines] == list(FABRICS)
    denim = next(line for line in lines if line.startswith('denim'))
    assert denim.split()[1:7] == ['0.324', '205', '1014', '13', '64', '97']
    assert '10.1145/2010324.1964966' in source
