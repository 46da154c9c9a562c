# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

# The messages, built with cmake into the venv, which is a ROS prefix of its own:
# cloth_sim_interfaces, and what this project needs of tf2_msgs and simulation_interfaces where ROS
# lacks those. None of them needs another one: all are built at once.

# Print the files and folders of a built package, relative to the venv.
interface_files() {
  (cd "$venv" && compgen -G "include/$1"
    compgen -G "share/$1"
    compgen -G "share/ament_index/resource_index/*/$1"
    compgen -G "lib/lib${1}__*"
    compgen -G "lib/python3.*/site-packages/$1"
    compgen -G "lib/python3.*/site-packages/$1-*.egg-info") || true
}

# A message that is gone must not live on in the prefix.
remove_package() {
  interface_files "$1" | (cd "$venv" && xargs -r -d '\n' rm -rf --)
}

# For ROS from wheels, what is asked for, and quickly; a sourced ROS has programs in C++ that take
# messages, too.
cmake_options() {
  printf '%s\n' "-DCMAKE_INSTALL_PREFIX=$venv" -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=OFF \
    "-DPython3_EXECUTABLE=$venv/bin/python"
  [ "$ros_source" != wheels ] || printf '%s\n' \
    "-Drosidl_default_generators_DIR=$root/scripts/setup/wheel_generators" \
    "-DWITH_CPP=$with_cpp" \
    '-DCMAKE_C_FLAGS_RELEASE=-O1 -DNDEBUG' '-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG'
}

cmake_build() {
  local source=$1 package build options
  package=$(basename "$source")
  build=$venv/build/$package
  rm -rf "$build"
  remove_package "$package"
  mapfile -t options < <(cmake_options)
  export AMENT_PREFIX_PATH=$venv${AMENT_PREFIX_PATH:+:$AMENT_PREFIX_PATH}
  export CMAKE_PREFIX_PATH=$venv${CMAKE_PREFIX_PATH:+:$CMAKE_PREFIX_PATH}
  export PATH=$venv/bin:$PATH
  cmake -S "$source" -B "$build" "${options[@]}" &&
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

interfaces_digest() {
  { cat "$stamps/packages"; echo "C++: $with_cpp"; } |
    digest "$1" scripts/setup/interfaces.sh scripts/setup/wheel_generators
}

# Build one package, with a log of its own, and keep it.
build_package() {
  local package
  package=$(basename "$1")
  cmake_build "$1" > "$venv/build/$package.log" 2>&1 || return 1
  set_stamp "$package" "$(interfaces_digest "$1")"
  keep_interfaces "$1"
}

# Build all packages at once; what is printed at the end is why one failed.
build_packages() {
  local source jobs=() number status=0
  for source in "$@"; do
    build_package "$source" &
    jobs+=("$!")
  done
  for number in "${!jobs[@]}"; do
    wait "${jobs[number]}" || {
      source=${*:number + 1:1}
      cat "$venv/build/$(basename "$source").log"
      status=1
    }
  done
  return "$status"
}

# Take what an earlier set-up has kept, and build the rest.
install_interfaces() {
  local source package current missing=() logs=()
  mkdir -p "$venv/build"
  for source in "$@"; do
    package=$(basename "$source")
    current=$(interfaces_digest "$source")
    ! is_current "$package" "$current" || continue
    clear_stamp "$package"
    if take_kept_interfaces "$source"; then
      set_stamp "$package" "$current"
      say "$package: built before, taken from $(interface_cache)."
    else
      missing+=("$source")
      logs+=("$venv/build/$package.log")
    fi
  done
  [ "${#missing[@]}" -gt 0 ] || return 0
  rm -f "${logs[@]}"
  long_step "Building ${missing[*]##*/}" build_words build_packages "${missing[@]}"
}

# How far the packages are, of which each has a log.
build_words() {
  cmake_words "$venv"/build/*.log
}

build_interfaces() {
  local sources=()
  # What programs in C++ need stays, once it is there.
  [ ! -e "$stamps/cpp" ] || with_cpp=yes
  ros_has tf2_msgs || sources+=(scripts/setup/tf2_msgs)
  ros_has simulation_interfaces || sources+=(scripts/setup/simulation_interfaces)
  install_interfaces "${sources[@]}" cloth_sim_interfaces
  [ "$with_cpp" = no ] || [ -e "$stamps/cpp" ] || set_stamp cpp yes
}
