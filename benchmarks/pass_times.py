# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Measure the time of each pass on a towel that lies folded in half on a floor.

Each dispatch is timed by itself: llvmpipe returns when it has finished. For example:
  LP_NUM_THREADS=0 python benchmarks/pass_times.py --nodes 64
"""

from argparse import ArgumentParser
from collections import Counter
from collections.abc import Callable
import re
from time import process_time

from cloth_sim_ros.gl import quick_calls

# Defines in which the forms of a pass differ.
_FORM = re.compile(r'^#define (OF_EDGES|IS_SUM|IS_LAST|LOOKS) ([1-9]\d*)$', re.MULTILINE)


class Timer:
    """Processor time of the dispatches of each program, by its number in GL."""

    def __init__(self) -> None:
        """Time all dispatches from now on; before any other module takes the calls."""
        self.program = 0
        self.times: Counter[int] = Counter()
        self.runs: Counter[int] = Counter()
        quick_calls.dispatch = self._timed(quick_calls.dispatch)
        quick_calls.dispatch_indirect = self._timed(quick_calls.dispatch_indirect)
        self._use_program = quick_calls.use_program
        quick_calls.use_program = self._use

    def clear(self) -> None:
        """Forget what was measured."""
        self.times.clear()
        self.runs.clear()

    def _use(self, program: int) -> None:
        self.program = program
        self._use_program(program)

    def _timed(self, call: Callable[..., None]) -> Callable[..., None]:
        def dispatch(*numbers: int) -> None:
            begin = process_time()
            call(*numbers)
            self.times[self.program] += process_time() - begin
            self.runs[self.program] += 1
        return dispatch


def main() -> None:
    """Print the table of docs/notes/performance.md."""
    parser = ArgumentParser(description=__doc__.strip().splitlines()[0])
    parser.add_argument('--nodes', type=int, default=64, help='along each side (%(default)s)')
    parser.add_argument('--settle', type=float, default=0.3,
                        help='simulated time before the measurement [s] (%(default)s)')
    parser.add_argument('--seconds', type=float, default=0.03,
                        help='simulated time of the measurement [s] (%(default)s)')
    given = parser.parse_args()
    timer = Timer()
    # These take the calls as they are now.
    from cloth_sim_ros.gl.inventory import take_inventory
    from cloth_sim_ros.sim.simulation import Simulation
    from cloth_sim_ros.study.self_contact_speed import folded
    from cloth_sim_ros.study.self_contact_speed import towel
    with (take_inventory() as inventory,
          Simulation(towel('mass_spring', given.nodes, is_enabled=True)) as simulation):
        positions = folded(given.nodes)
        simulation.set_state(positions, 0.0 * positions)
        simulation.advance(given.settle)
        simulation.finish()
        timer.clear()
        begin = process_time()
        simulation.advance(given.seconds)
        simulation.finish()
        total = process_time() - begin
        times, runs = timer.times.copy(), timer.runs.copy()
        names = {}
        for program in inventory.programs:
            program.use()
            names[timer.program] = ', '.join([program.source.name, *(
                f'{name} {value}' for name, value in _FORM.findall(program.source.text))])
        substeps = max(
            count for number, count in runs.items()
            if names[number].startswith('mass_spring_step'))
        contacts = simulation.snapshot().self_contacts
    print(f'{substeps} substeps, {contacts} contacts: {1e3 * total / substeps:.2f} ms a substep\n')
    print('| pass | runs a substep | ms each | ms a substep |\n|---|---|---|---|')
    for number, time in times.most_common():
        print(f'| `{names[number]}` | {runs[number] / substeps:.2f} | '
              f'{1e3 * time / runs[number]:.3f} | {1e3 * time / substeps:.3f} |')
    print(f'| host | | | {1e3 * (total - sum(times.values())) / substeps:.3f} |')


if __name__ == '__main__':
    main()
