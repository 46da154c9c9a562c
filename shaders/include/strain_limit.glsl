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

// How far structural and shear springs may stretch or shorten.

#define NO_LIMIT 0
#define RIGID_LIMIT 1

uniform float limit;  // largest abs(l / L0 - 1)

bool is_beyond_limit(float now, float rest) { return abs(now - rest) > limit * rest; }

// Length by which a spring is too long (above 0) or too short (below 0) [m]; 0 within the limit.
