# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
The command `cloth_sim VERB`: finds the verb's module and hands over to it.

A verb is a module of this package with `add_arguments(parser)` and `main(args) -> int`, the exit
code; its docstring is its help text. Only the module of the verb asked for is imported.
"""

from argparse import ArgumentParser
from argparse import RawDescriptionHelpFormatter
from collections.abc import Iterator
from collections.abc import Sequence
from contextlib import contextmanager
from importlib import import_module
import sys
from typing import NoReturn
import warnings

from cloth_sim_ros.files.close_name import close_name
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.node.missing_module import way_out
from cloth_sim_ros.node.shared_memory import refuse_ros_without_memory
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.verb.termination import interruptible
from cloth_sim_ros.verb.termination import leave_broken_pipes
from cloth_sim_ros.verb.termination import Terminated

VERBS = {
    'run': 'simulate a scene file, without ROS',
    'materials': 'list the measured fabrics that a scene can name',
    'bench': 'benchmark this device, without ROS',
    'validate': 'measure scenes with a known outcome, without ROS',
    'tune': 'measure what is fastest on this device, for runs to use',
    'mode': 'switch the simulation mode of a running node',
    'push': 'push the cloth of a running node, or cancel all pushes',
    'pin': 'pin, move or release a node of the cloth',
    'grasp': 'grasp nodes of the cloth, move a grasp, or attach it to tf',
    'release': 'release a grasp',
    'collider': 'move a collider of a running node, turn it, or attach it to tf',
    'wind': 'set the steady wind of a running node',
    'pause': 'pause a running node',
    'resume': 'resume a paused node',
    'step': 'advance a paused node by a number of time steps',
    'reset': 'restore the initial state of a running node',
    'record': 'start or stop a recording of a running node',
    'status': 'show the state of a running node',
    'info': 'summarise a recording',
    'recover': 'repair a truncated or damaged recording for other tools',
    'analyze': 'analyse and compare recordings: table, CSV, JSON and plots',
    'render': 'render recordings as a sheet of images or as a video',
    'dataset': 'make a data set of labelled pictures of a scene',
    'export': 'write the cloth of a recording as a mesh: OBJ, PLY, glTF or USD',
    'play': 'replay a recording on its topics',
    'view': 'view a node, a scene or a recording in the browser',
    'resimulate': 'rerun a recorded simulation with the same or other settings',
    'paper': 'reproduce tables and figures of the paper',
    'study': 'measure error, cost and stability of a scene, and choose settings',
}
_MOST_TOLD = 500
_WRONG_USE = 2
# 128 and the number of the signal, as shells have it.
INTERRUPTED = 130
TERMINATED = 143
NOBODY_READS = 141
_MOST_CHARACTERS = 2000


class _Parser(ArgumentParser):
    """Repeats no more of a command line than is needed to find the mistake."""

    def error(self, message: str) -> NoReturn:
        """Print usage and ``message``, cut, and exit with code 2."""
        super().error(cut(message, _MOST_TOLD))


def main(argv: Sequence[str] | None = None) -> int:
    """Run the verb named by the first argument and return the exit code."""
    try:
        code = _run(list(sys.argv[1:] if argv is None else argv))
        # What is left in the buffer would break at the end of the process, out of reach.
        sys.stdout.flush()
        return code
    except BrokenPipeError:
        if not leave_broken_pipes():
            raise
        return NOBODY_READS


def _run(arguments: list[str]) -> int:
    if not arguments or arguments[0] not in VERBS:
        return _no_verb(arguments)
    name, *rest = arguments
    try:
        # Many verbs use ROS, some of them for messages alone, and load it here or later.
        refuse_ros_without_memory()
        verb = import_module(f'cloth_sim_ros.verb.{name}')
        parser = _Parser(
            prog=f'cloth_sim {name}', description=verb.__doc__,
            formatter_class=RawDescriptionHelpFormatter)
        verb.add_arguments(parser)
        with interruptible(), _warnings_in_a_line(name):
            return verb.main(parser.parse_args(rest))
    except ClothSimError as error:
        # It may repeat what a file holds: no line breaks, and nothing that a terminal acts upon.
        problem = cut(error, _MOST_CHARACTERS)
    except DeviceError as error:
        problem = str(error)
    except ImportError as error:
        problem = way_out(error)
    except Terminated:
        return TERMINATED
    except KeyboardInterrupt:
        return INTERRUPTED
    print(f'cloth_sim {name}: {problem}', file=sys.stderr)
    return 1


@contextmanager
def _warnings_in_a_line(name: str) -> Iterator[None]:
    """Print warnings as errors are, without the place in the source."""
    before = warnings.formatwarning
    warnings.formatwarning = lambda message, *_, **__: (
        f'cloth_sim {name}: {cut(message, _MOST_CHARACTERS)}\n')
    try:
        yield
    finally:
        warnings.formatwarning = before


def _no_verb(arguments: list[str]) -> int:
    if arguments and not arguments[0].startswith('-'):
        print(f'cloth_sim: {_unknown_verb(arguments[0])}', file=sys.stderr)
        return _WRONG_USE
    verbs = '\n'.join(f'  {name:10} {text}' for name, text in VERBS.items())
    parser = _Parser(
        prog='cloth_sim', usage='cloth_sim VERB ...', formatter_class=RawDescriptionHelpFormatter,
        description=f'Simulate cloth, and control a running cloth_sim_node.\n\nverbs:\n{verbs}',
        epilog='Run cloth_sim VERB --help for the options of a verb.')
    parser.add_argument('verb', choices=VERBS, metavar='VERB', help='one of the verbs above')
    parser.parse_args(arguments[:1])
    return 0


def _unknown_verb(name: str) -> str:
    close = close_name(name.lower(), VERBS)
    hint = f'did you mean {close}?' if close else 'choose one that cloth_sim --help lists'
    return f'there is no verb {shown(name)}: {hint}'
