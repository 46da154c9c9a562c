# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The passes that a scene compiles, how often a step runs each, and the memory they need."""

from collections.abc import Mapping
from contextlib import closing
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.inventory import take_inventory
from cloth_sim_ros.sim.edge_kinds import EACH_EDGE
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation

# Choices that say what is modelled; the others say how the work is laid out.
_MODELLED = (
    'HAS_', 'STRAIN_LIMIT', 'MULTIGRID', 'FORESEES_TURN', 'IS_FURTHER', 'RECORDS_WANTED')


def pass_list(
        values: Mapping[str, Any], *, context: Context | None = None, seconds: float = 0.0,
        looks: bool = True) -> dict[str, Any]:
    """
    Return the passes of the scene of ``values``, its buffers and their bytes, as plain values.

    A pass has its file, the choices it was compiled with and reads, and its runs in each step of
    dt: the mean over ``seconds`` [s] and one step at least. Runs of the solver's iterations count
    as submitted: the device leaves out those it does not need.

    :param looks: take a snapshot at the end, and list its pass; its run is no part of a step
    """
    with take_inventory() as inventory, closing(
            Simulation(Scene(values), context=context)) as run:
        before = inventory.dispatches()
        steps = max(1, round(seconds / run.dt))
        run.step(steps)
        after = inventory.dispatches()
        before += [0] * (len(after) - len(before))
        if looks:
            run.snapshot()
        after += [0] * (len(inventory.programs) - len(after))
        before += [0] * (len(inventory.programs) - len(before))
        passes = [
            {'shader': program.name,
             'defines': {name: str(value) for name, value in program.source.used_defines.items()},
             'runs_per_step': (late - early) / steps}
            for program, early, late in zip(inventory.programs, before, after)]
        return {
            'passes': passes, 'buffers': len(inventory.buffers),
            'buffer_bytes': inventory.buffer_bytes, 'substeps': run.substeps, 'steps': steps,
            'device': run.device}


def modelled(defines: Mapping[str, str]) -> str:
    """Return the choices among ``defines`` that say what is modelled, in words."""
    chosen = {name: value for name, value in defines.items() if name.startswith(_MODELLED)}
    there = [name[len('HAS_'):].lower() for name, value in chosen.items()
             if name.startswith('HAS_') and value == '1']
    edges = defines.get(EACH_EDGE, '')
    there += [family for family in FAMILIES if family not in there and family.upper() in edges]
    others = [f'{name.lower().replace("_", " ")} {value}' for name, value in chosen.items()
              if not name.startswith('HAS_') and value not in ('0', 'NO_LIMIT')]
    return ', '.join(there + others)


def pass_table(listed: Mapping[str, Any]) -> str:
    """Return a pass list as a table in Markdown."""
    lines = ['| shader | compiled with | runs a step of dt |', '|---|---|---|']
    for each in listed['passes']:
        lines.append(
            f'| {each["shader"]} | {modelled(each["defines"])} | {each["runs_per_step"]:.4g} |')
    total = sum(each['runs_per_step'] for each in listed['passes'])
    lines += ['', f'{len(listed["passes"])} passes, {total:.4g} runs in a step of dt of '
              f'{listed["substeps"]} substeps, {listed["buffers"]} buffers of '
              f'{listed["buffer_bytes"]} bytes.']
    return '\n'.join(lines) + '\n'
