// Copyright 2026 the cloth_sim_ros authors
//
// Licensed under the Apache License, Version 2.0 (the "License");
// you may not use this file except in compliance with the License.
// You may obtain a copy of the License at
//
//     http://www.apache.org/licenses/LICENSE-2.0
//
// Unless required by applicable law or agreed to in writing, software
// distributed under the License is distributed on an "AS IS" BASIS,
// WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
// See the License for the specific language governing permissions and
// limitations under the License.

// The two steps of smoothing, as shares of a whole step of block-Jacobi. On the way up they come
// the other way round, which keeps the preconditioner symmetric.

#if MULTIGRID
#define SMOOTHED_INTO SMOOTHED
#else
#define SMOOTHED_INTO PRECONDITIONED
#endif

uniform float first_step;
uniform float second_step;
