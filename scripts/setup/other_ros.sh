# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

# Which ROS this checkout uses, and how to keep any other one out.

# Print "jazzy" when a ROS 2 Jazzy is sourced, else "wheels".
ros_source() {
  if [ "${ROS_DISTRO:-}" = jazzy ]; then
    printf 'jazzy\n'
  else
    printf 'wheels\n'
  fi
}

# Is this folder inside a ROS prefix?
in_ros_prefix() {
  local folder=$1
  while [ -n "$folder" ]; do
    [ ! -d "$folder/share/ament_index" ] || return 0
    [[ $folder == */* ]] || return 1
    folder=${folder%/*}
  done
  return 1
}

# Print a list of folders without those that belong to a ROS.
without_ros_prefixes() {
  local entry kept=()
  local IFS=:
  for entry in $1; do
    in_ros_prefix "$entry" || kept+=("$entry")
  done
  printf '%s\n' "${kept[*]-}"
}

# The wheels hand LD_LIBRARY_PATH and a marker to their children; a Python of another prefix that
# inherits them loads the wrong libraries. Entries that are not of a ROS (a GPU driver's) stay.
leave_other_ros() {
  unset _ROS_WHEELS_BOOTSTRAP_COMPLETE
  [ "$1" = wheels ] || return 0
  if [ -n "${LD_LIBRARY_PATH:-}" ]; then
    LD_LIBRARY_PATH=$(without_ros_prefixes "$LD_LIBRARY_PATH")
    export LD_LIBRARY_PATH
  fi
  if [ -n "${PYTHONPATH:-}" ]; then
    PYTHONPATH=$(without_ros_prefixes "$PYTHONPATH")
    export PYTHONPATH
  fi
  unset PYTHONHOME ROS_DISTRO AMENT_PREFIX_PATH CMAKE_PREFIX_PATH COLCON_PREFIX_PATH
}
