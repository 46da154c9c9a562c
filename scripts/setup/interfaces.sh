# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

# The messages, built with cmake into the venv, which is a ROS prefix of its own:
# cloth_sim_interfaces, and what this project needs of tf2_msgs and simulation_interfaces where ROS
# lacks those.

cmake_build() {
  local source=$1 package build
  package=$(basename "$source")
  build=$venv/build/$package
  rm -rf "$build"
  # A message that is gone must not live on in the prefix.
  rm -rf "$venv"/{include,share,lib/python3.*/site-packages}/"$package" "$venv"/lib/lib"$package"__*
  export AMENT_PREFIX_PATH=$venv${AMENT_PREFIX_PATH:+:$AMENT_PREFIX_PATH}
  export CMAKE_PREFIX_PATH=$venv${CMAKE_PREFIX_PATH:+:$CMAKE_PREFIX_PATH}
  export PATH=$venv/bin:$PATH
  cmake -S "$source" -B "$build" -DCMAKE_INSTALL_PREFIX="$venv" \
    -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=OFF -DPython3_EXECUTABLE="$venv/bin/python" &&
    cmake --build "$build" --parallel "$(nproc)" &&
    cmake --install "$build"
}

# Does the ROS in use bring this package? The wheels are in the venv itself.
ros_has() {
  local prefix
  local IFS=:
  for prefix in ${AMENT_PREFIX_PATH:-}; do
    [ "$prefix" = "$venv" ] || [ ! -d "$prefix/share/$1" ] || return 0
  done
  return 1
}

build_package() {
  local source=$1 package current
  package=$(basename "$source")
  current=$(digest "$source" < "$stamps/packages")
  ! is_current "$package" "$current" || return 0
  clear_stamp "$package"
  long_step "Building $package" cmake_words cmake_build "$source"
  set_stamp "$package" "$current"
}

build_interfaces() {
  ros_has tf2_msgs || build_package scripts/setup/tf2_msgs
  ros_has simulation_interfaces || build_package scripts/setup/simulation_interfaces
  build_package cloth_sim_interfaces
}
