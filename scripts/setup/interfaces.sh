# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

# cloth_sim_interfaces, built with cmake into the venv, which is a ROS prefix of its own.

cmake_build() {
  local build=$venv/build/cloth_sim_interfaces
  rm -rf "$build"
  # A message that is gone must not live on in the prefix.
  rm -rf "$venv"/{include,share,lib/python3.*/site-packages}/cloth_sim_interfaces \
    "$venv"/lib/libcloth_sim_interfaces__*
  export AMENT_PREFIX_PATH=$venv${AMENT_PREFIX_PATH:+:$AMENT_PREFIX_PATH}
  export CMAKE_PREFIX_PATH=$venv${CMAKE_PREFIX_PATH:+:$CMAKE_PREFIX_PATH}
  export PATH=$venv/bin:$PATH
  cmake -S cloth_sim_interfaces -B "$build" -DCMAKE_INSTALL_PREFIX="$venv" \
    -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=OFF -DPython3_EXECUTABLE="$venv/bin/python" &&
    cmake --build "$build" --parallel "$(nproc)" &&
    cmake --install "$build"
}

build_interfaces() {
  local current
  current=$(digest cloth_sim_interfaces < "$stamps/packages")
  ! is_current interfaces "$current" || return 0
  clear_stamp interfaces
  long_step 'Building cloth_sim_interfaces' cmake_words cmake_build
  set_stamp interfaces "$current"
}
