# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cloth that environments of gymnasium are tested with."""

SMALL = {
    'rows': 6, 'cols': 5, 'width': 0.4, 'height': 0.5, 'start.pose': 'hanging', 'dt': 0.005}
