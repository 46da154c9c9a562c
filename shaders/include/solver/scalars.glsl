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

// What conjugate gradients carry from one iteration to the next.

layout(std430, binding = SOLVER_SCALARS) SCALARS_ACCESS buffer Scalars {
    float step_length;  // along the direction; 0 when there is nothing to add
    float keep;         // of the last direction in the next
    float measure;      // residual times preconditioned residual
    float measure_start;
    float measure_after;  // expected after the last iteration
    float iterations;   // made so far
    float scale;        // square of the change of velocity that the residual is small beside
};
