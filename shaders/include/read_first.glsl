// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The value of a uniform, read where this stands. In a branch or a loop llvmpipe reads a uniform
// lane by lane, even at a constant index: ahead of them a read is five times as fast. Globals are
// initialised ahead of main(). Mesa replaces a mere copy by the uniform, but not this, and not a
// copy of an element of an array.
#define READ_FIRST(UNIFORM) max(UNIFORM, UNIFORM)
