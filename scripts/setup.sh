#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

# Make this checkout ready to run: system packages, .venv, cloth_sim_interfaces, the two commands.
# Running it again does only what has changed; without a change it needs no network.
#
#   scripts/setup.sh           what the node, the commands and the demo need
#   scripts/setup.sh --view    what `cloth_sim view` needs as well
#   scripts/setup.sh --cpp     what programs in C++ need of the messages as well, without a sourced ROS
#   scripts/setup.sh --tests   what the tests need as well, the view and C++ too
#   scripts/setup.sh --long    what the long tests need as well: Chromium

set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
venv=$root/.venv
stamps=$venv/.setup
cd "$root"

for part in progress counts one_at_a_time other_ros find_python system_packages stamps \
  python_packages interface_cache interfaces project shaders; do
  # shellcheck source=/dev/null
  . "$root/scripts/setup/$part.sh"
done

with_view=no with_cpp=no with_tests=no with_browser=no
case "$*" in
  '') ;;
  --view) with_view=yes ;;
  --cpp) with_cpp=yes ;;
  --tests) with_cpp=yes with_tests=yes ;;
  --long) with_cpp=yes with_tests=yes with_browser=yes ;;
  *) stop "unknown argument: $*: give --view, --cpp, --tests, --long or nothing" ;;
esac

one_at_a_time
ros_source=$(ros_source)
leave_other_ros "$ros_source"
install_system_packages
make_venv
install_python_packages
install_view_packages
build_interfaces
install_project
compile_shaders
say "cloth_sim_ros is set up in ${SECONDS} s."
