# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Play recordings: their messages on their topics again, at the pace they were recorded."""
