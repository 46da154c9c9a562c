# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The command `cloth_sim_node`: an interrupt is taken care of from the first moment on."""

from cloth_sim_ros.node.early_stop import leave_when_interrupted


def main() -> int:
    """Start the node and return its exit code; see node/main.py."""
    leave_when_interrupted()
    # What it needs can take a second to import.
    from cloth_sim_ros.node.main import main as start
    return start()
