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

// Symplectic Euler (paper, Eq. 3 and 4): v+ = v + h (a + F / m), x+ = x + h v+. A pinned node keeps
// its velocity, which is that of the pin.

uniform float substep;       // [s]
uniform float inverse_mass;  // [1/kg]

vec3 next_velocity(vec4 velocity, vec3 force, vec3 applied) {
    return velocity.xyz + velocity.w * substep * (applied + inverse_mass * force);
}

vec3 next_position(vec3 position, vec3 velocity) {
    return position + substep * velocity;
}
