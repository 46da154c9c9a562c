# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The trade of speed for accuracy: settings, references, errors, costs and the choice."""
