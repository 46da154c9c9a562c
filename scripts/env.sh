# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

# Source this in bash after scripts/setup.sh: the commands and the ROS prefix.

_cloth_sim_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=/dev/null
. "$_cloth_sim_root/scripts/setup/other_ros.sh"
leave_other_ros "$(ros_source)"

VIRTUAL_ENV=$_cloth_sim_root/.venv
PATH=$VIRTUAL_ENV/bin:$PATH
AMENT_PREFIX_PATH=$VIRTUAL_ENV${AMENT_PREFIX_PATH:+:$AMENT_PREFIX_PATH}
CMAKE_PREFIX_PATH=$VIRTUAL_ENV${CMAKE_PREFIX_PATH:+:$CMAKE_PREFIX_PATH}
if [ "$(ros_source)" = jazzy ]; then
  # The wheels find their libraries by themselves, a sourced ROS by this.
  LD_LIBRARY_PATH=$VIRTUAL_ENV/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
  export LD_LIBRARY_PATH
fi
export VIRTUAL_ENV PATH AMENT_PREFIX_PATH CMAKE_PREFIX_PATH
unset _cloth_sim_root
