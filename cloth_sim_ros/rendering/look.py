# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The colours and sizes of what is drawn beside the strain."""

BACKGROUND = (1.0, 1.0, 1.0)
GRID_COLOR = (0.80, 0.80, 0.80)
SHADOW_COLOR = (0.91, 0.91, 0.915)
PIN_COLOR = (0.84, 0.10, 0.12)
PUSH_COLOR = (0.08, 0.38, 0.88)
LIMIT_COLOR = (0.16, 0.86, 0.84)    # stands out from strained and from slack cloth
UNKNOWN_COLOR = (0.72, 0.76, 0.82)  # of a cloth whose strain is not known

HEM_SHADE = 0.45      # how much darker the border of a cloth is
HIDDEN = 0.22         # opacity of a pin or an arrow behind the cloth
GRID_LINES = 8        # across the longest side
