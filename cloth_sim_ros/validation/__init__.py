# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Scenes with a known outcome: what `cloth_sim validate` measures, and the tests too."""
