# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The linear solver of the implicit modes: (M + J^T diag(a) J) dv = b, without matrices."""
