# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

# The system packages: found by what they bring, installed by apt only where something is missing.

has_library() {
  [[ $known_libraries == *"$1 "* ]]
}

has_file() {
  compgen -G "$1" > /dev/null
}

# The names that test/support/browser.py looks for.
has_browser() {
  command -v chromium || command -v chromium-browser || command -v google-chrome
} > /dev/null

# Print the packages whose content is not here, one a line.
missing_packages() {
  local known_libraries
  known_libraries=$(PATH=$PATH:/usr/sbin:/sbin ldconfig -p)
  has_library libEGL.so.1 || echo libegl1
  has_library libOpenGL.so.0 || has_library libGL.so.1 || echo libopengl0
  if ! has_library libEGL_nvidia.so.0; then
    has_library libEGL_mesa.so.0 || echo libegl-mesa0
    has_file '/usr/lib*/*/dri/swrast_dri.so' || has_file '/usr/lib*/dri/swrast_dri.so' ||
      echo libgl1-mesa-dri
  fi
  command -v cmake > /dev/null || echo cmake
  command -v make > /dev/null || echo make
  command -v c++ > /dev/null || echo g++
  if [ "$with_tests" = yes ]; then
    command -v glslangValidator > /dev/null || echo glslang-tools
  fi
  if [ "$with_browser" = yes ]; then
    has_browser || echo chromium
  fi
}

# Print how to become root: nothing, "sudo", or fail.
root_command() {
  if [ "$(id -u)" -eq 0 ]; then
    return 0
  fi
  command -v sudo > /dev/null || return 1
  # With a terminal, sudo may ask for the password.
  sudo -n true 2> /dev/null || { [ -t 0 ] && sudo -v; } || return 1
  echo sudo
}

apt_install() {
  local as_root=$1
  shift
  $as_root dpkg --configure -a
  $as_root apt-get update
  $as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install --yes --no-install-recommends "$@"
}

# Install what is missing, or say exactly what to install and stop.
install_system_packages() {
  local packages as_root
  mapfile -t packages < <(missing_packages)
  if ! venv_runs; then
    find_python
    packages+=("${python_packages[@]}")
  fi
  [ "${#packages[@]}" -gt 0 ] || return 0
  if ! command -v apt-get > /dev/null; then
    stop "missing here, by their Debian names: ${packages[*]}: install them and run this again"
  fi
  as_root=$(root_command) ||
    stop "system packages are missing and this user may not install them: ask for
  apt-get install ${packages[*]}
and run this again"
  say "Missing system packages: ${packages[*]}"
  step_root=$as_root
  long_step 'Installing system packages' apt_words apt_install "$as_root" "${packages[@]}"
  step_root=''
  mapfile -t packages < <(missing_packages)
  [ "${#packages[@]}" -eq 0 ] || stop "apt-get brought no usable ${packages[*]}"
}
