# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Scenes at the end of what can be asked for, and how their runs are judged."""
