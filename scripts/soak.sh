#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

# Run a node for hours, with recordings, mode switches, pushes and pins, and watch what it holds.
#
#   scripts/soak.sh --hours 1 [--seed N] [--out FILE.csv]

set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
"$root/scripts/setup.sh" --tests
. "$root/scripts/env.sh"
ROS_DOMAIN_ID=$(python "$root/scripts/free_ros_domain.py")
export ROS_DOMAIN_ID ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST
export PYTHONPATH=$root/test/support${PYTHONPATH:+:$PYTHONPATH}
exec python "$root/scripts/soak.py" "$@"
