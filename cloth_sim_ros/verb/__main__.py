# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The command `cloth_sim` as a module: python3 -m cloth_sim_ros.verb VERB."""

import sys

from cloth_sim_ros.verb.main import main

sys.exit(main())
