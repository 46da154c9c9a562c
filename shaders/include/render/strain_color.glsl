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

// The colour of a strain: PALETTE_SIZE even steps from 0 to full_strain.

layout(binding = 1) uniform samplerBuffer palette;
uniform float full_strain;
uniform vec3 plain_color;  // where the strain is not known, which is said by one below 0

vec3 strain_color(float strain) {
    int place = int(float(PALETTE_SIZE) * strain / full_strain);
    vec3 color = texelFetch(palette, clamp(place, 0, PALETTE_SIZE - 1)).rgb;
    return strain < 0.0 ? plain_color : color;
}
