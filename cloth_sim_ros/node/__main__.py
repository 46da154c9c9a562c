# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The node as a module: python3 -m cloth_sim_ros.node --ros-args ..."""

import sys

from cloth_sim_ros.node.command import main

sys.exit(main())
