# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A cloth of springs without air, for tests of anything else than the default fabric."""

# With the springs that parameters have by default: light and soft, it moves in few substeps.
SPRINGS = {'material.preset': 'none'}
