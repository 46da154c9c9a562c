# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

# Built messages, kept for other checkouts of this user: one archive for each package and each
# state of its sources. Only for ROS from wheels: the versions there are locked, while a
# sourced ROS can change under the same version.

# Print the folder of the archives; nothing where there is no home.
interface_cache() {
  local base=${XDG_CACHE_HOME:-${HOME:+$HOME/.cache}}
  [ "$ros_source" != wheels ] || [ -z "$base" ] || printf '%s\n' "$base/cloth_sim_ros/interfaces"
}

# Print what decides on the files besides their sources and the locked packages.
build_tools() {
  "$venv/bin/python" -c 'import sys, sysconfig
print(sys.version, sysconfig.get_platform(), sysconfig.get_config_var("SOABI"))'
  echo "C++: $with_cpp"
  c++ --version
  cmake --version
}

# Print the archive for the sources of a package, with C++ or without: yes or no.
interface_archive() {
  local folder key with_cpp=${2:-$with_cpp}
  folder=$(interface_cache)
  [ -n "$folder" ] || return 0
  key=$(build_tools | digest "$1" scripts/setup/interfaces.sh scripts/setup/interface_cache.sh \
    scripts/setup/fix_wheel_paths.py scripts/setup/wheel_generators requirements/run.txt)
  printf '%s/%s-%s.tar.gz\n' "$folder" "$(basename "$1")" "$key"
}

# move_prefix FOLDER FROM TO: the files for cmake and for shells name the venv.
move_prefix() {
  local from
  from=$(sed 's/[][\.*^$|]/\\&/g' <<< "$2")
  { grep -rlIZF -- "$2" "$1" || true; } |
    xargs -0 -r sed -i "s|$from|$(sed 's/[\&|]/\\&/g' <<< "$3")|g"
}

# Keep what was built. It appears under its name when it is complete; that it cannot be written is
# no reason to fail.
keep_interfaces() {
  local package archive scratch
  package=$(basename "$1")
  archive=$(interface_archive "$1")
  [ -n "$archive" ] && mkdir -p "${archive%/*}" 2> /dev/null &&
    scratch=$(mktemp -d "${archive%/*}/.new.XXXXXX" 2> /dev/null) || return 0
  mkdir "$scratch/files"
  { interface_files "$package" | tar -C "$venv" -cf - -T - | tar -C "$scratch/files" -xf - &&
    move_prefix "$scratch/files" "$venv" @prefix@ &&
    tar -C "$scratch/files" -czf "$scratch/archive" . &&
    mv "$scratch/archive" "$archive"; } 2> /dev/null || true
  rm -rf "$scratch"
}

# Put the files of a package that was built before into the venv; fail where there are none, or
# where they are not as they were written.
take_kept_interfaces() {
  local package archive fresh
  package=$(basename "$1")
  archive=$(interface_archive "$1")
  # What was built with C++ has all that Python needs.
  [ -f "$archive" ] || archive=$(interface_archive "$1" yes)
  fresh=$venv/build/$package.kept
  [ -f "$archive" ] || return 1
  rm -rf "$fresh"
  mkdir -p "$fresh"
  if ! tar -C "$fresh" -xzf "$archive" 2> /dev/null; then
    rm -rf "$fresh"
    rm -f "$archive"
    return 1
  fi
  move_prefix "$fresh" @prefix@ "$venv"
  remove_package "$package"
  cp -a "$fresh/." "$venv/"
  rm -rf "$fresh"
}
