# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""
Summarise a recording: cloth, inputs, strain, energies and real-time factor.

Needs no node.

For example:
  cloth_sim info bags/cloth_2026_01_31-12_00_00
"""

from argparse import ArgumentParser
from argparse import Namespace

from cloth_sim_ros.analysis.summary import summarise
from cloth_sim_ros.analysis.summary import summary_lines
from cloth_sim_ros.analysis.summary import text_table
from cloth_sim_ros.verb.recording_arguments import add_recording_arguments
from cloth_sim_ros.verb.recording_arguments import open_recording


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    add_recording_arguments(parser)


def main(args: Namespace) -> int:
    """Print the summary."""
    print(text_table(summary_lines(summarise(open_recording(args)))))
    return 0
