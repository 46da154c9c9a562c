// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The two steps of smoothing, as shares of a whole step of block-Jacobi. On the way up they come
// the other way round, which keeps the preconditioner symmetric.

#if MULTIGRID
#define SMOOTHED_INTO SMOOTHED
#else
#define SMOOTHED_INTO PRECONDITIONED
#endif

uniform float first_step;
uniform float second_step;
