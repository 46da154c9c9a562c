# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

# This package itself: editable, so that the commands always run the code of this checkout.

# An editable install brings no data files. Each file is linked, because `ros2 launch` does not look
# into linked folders; so the venv is the ROS prefix of this package as well.
link_shared_files() {
  local share=$venv/share/cloth_sim_ros libexec=$venv/lib/cloth_sim_ros name
  rm -rf "$share" "$libexec"
  mkdir -p "$share" "$libexec" "$venv/share/ament_index/resource_index/packages"
  for name in config launch shaders; do
    cp --recursive --symbolic-link "$root/$name" "$share/$name"
  done
  ln -s "$root/package.xml" "$share/package.xml"
  for name in cloth_sim cloth_sim_node; do
    ln -s "$venv/bin/$name" "$libexec/$name"
  done
  cp resource/cloth_sim_ros "$venv/share/ament_index/resource_index/packages/cloth_sim_ros"
}

# Programs that are started without scripts/env.sh find the ROS files of the venv by this.
name_the_prefix() {
  local site
  site=$("$venv/bin/python" -c 'import sysconfig; print(sysconfig.get_paths()["purelib"])')
  printf '%s\n' "import os, sys; os.environ.setdefault('AMENT_PREFIX_PATH', sys.prefix)" \
    > "$site/cloth_sim_ros_prefix.pth"
}

install_project() {
  local current
  current=$(digest setup.py setup.cfg package.xml scripts/setup/project.sh < "$stamps/packages")
  if ! is_current project "$current"; then
    clear_stamp project
    long_step 'Installing cloth_sim_ros' no_words pip_install --no-index --no-deps \
      --no-build-isolation --use-pep517 --editable "$root"
    [ "$ros_source" = jazzy ] || name_the_prefix
    set_stamp project "$current"
  fi
  current=$(digest config launch shaders <<< "$current")
  if ! is_current shared_files "$current"; then
    clear_stamp shared_files
    link_shared_files
    set_stamp shared_files "$current"
  fi
}
