# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

# Find a Python that really runs: a command on the PATH may be a shim without anything behind it.

python_probe='
import os, sys, sysconfig
if not (3, 10) <= sys.version_info[:2] <= (3, 14):
    sys.exit(1)
if sys.argv[1] == "jazzy":
    import rclpy
lacks = []
try:
    import ensurepip, venv
except ImportError:
    lacks.append("venv")
if not os.path.exists(os.path.join(sysconfig.get_paths()["include"], "Python.h")):
    lacks.append("dev")
print(sys._base_executable, "%d.%d" % sys.version_info[:2], *lacks)
'

python_candidates() {
  local name
  for name in python3 python3.12 python3.11 python3.13 python3.14 python3.10; do
    printf '%s\n' "$name" "/usr/bin/$name"
  done
}

# Set python, and python_packages to the system packages it lacks. A complete Python wins over an
# incomplete one; only the system's own can be completed with packages.
find_python() {
  local candidate answer version lacks
  python='' python_packages=()
  while read -r candidate; do
    answer=$("$candidate" -c "$python_probe" "$ros_source" 2> /dev/null) || continue
    read -r candidate version lacks <<< "$answer"
    [ -n "$candidate" ] || continue
    if [ -z "$lacks" ]; then
      python=$candidate python_packages=()
      return
    fi
    if [ -z "$python" ] && [[ $candidate == /usr/bin/* ]]; then
      python=$candidate
      read -ra python_packages <<< "$lacks"
      python_packages=("${python_packages[@]/#/python$version-}")
    fi
  done < <(python_candidates)
  [ -n "$python" ] || python_packages=(python3 python3-venv python3-dev)
}
