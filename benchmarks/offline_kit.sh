#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

# Gather what gpu_suite.py needs on a machine without a network: this commit, wheels, and the
# loaders of EGL and OpenGL. The folder has a script that runs the suite.
#
#   benchmarks/offline_kit.sh FOLDER            for this machine's version of Python
#   benchmarks/offline_kit.sh FOLDER 3.12       for another one
#
# On the other machine:  FOLDER/run.sh [arguments of gpu_suite.py]

set -euo pipefail

[ $# -ge 1 ] && [ $# -le 2 ] || {
  echo 'offline_kit.sh: give the folder to make, and perhaps a version of Python' >&2
  exit 2
}
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
kit=$(realpath -m "$1")
python=${PYTHON:-python3}
version=${2:-$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')}
[ ! -e "$kit" ] || {
  echo "offline_kit.sh: $kit is there already: give another folder, or remove it" >&2
  exit 2
}
mkdir -p "$kit/wheels" "$kit/loaders"

git -C "$root" archive HEAD benchmarks cloth_sim_ros shaders config | tar -x -C "$kit"
git -C "$root" rev-parse --short HEAD > "$kit/commit"

# pip matches the numbers of manylinux exactly.
platforms=()
for number in 2_28 2_27 2_17 2014 1; do
  case $number in
    2_*) platforms+=(--platform "manylinux_${number}_x86_64") ;;
    *) platforms+=(--platform "manylinux${number}_x86_64") ;;
  esac
done
wanted=$(grep -E '^(numpy|PyOpenGL|PyYAML)==' "$root/requirements/runtime.in" | while read -r line; do
  case $line in
    *'python_version < "3.11"'*) [ "${version#3.}" -lt 11 ] || continue ;;
    *'python_version >= "3.11"'*) [ "${version#3.}" -ge 11 ] || continue ;;
  esac
  printf '%s\n' "${line%%[ ;]*}"
done)
# shellcheck disable=SC2086
"$python" -m pip download --quiet --no-deps --only-binary=:all: --python-version "$version" \
  --implementation cp "${platforms[@]}" --dest "$kit/wheels" $wanted

# Where the driver brings no loaders of its own. They are only used if the machine has none.
if command -v apt-get > /dev/null; then
  (cd "$kit/loaders" && apt-get download -qq libegl1 libglvnd0 libopengl0 2> /dev/null) || true
fi
[ -n "$(ls "$kit/loaders")" ] || echo 'offline_kit.sh: no loaders of EGL: apt has none here' >&2

cat > "$kit/run.sh" << 'RUN'
#!/usr/bin/env bash
# Run gpu_suite.py from this folder, without a network and without installing anything.
set -euo pipefail
kit=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
python=${PYTHON:-python3}
if [ ! -d "$kit/site" ]; then
  for wheel in "$kit"/wheels/*.whl; do
    "$python" -m zipfile -e "$wheel" "$kit/site"
  done
fi
if ! "$python" -c 'import ctypes; ctypes.CDLL("libEGL.so.1"); ctypes.CDLL("libOpenGL.so.0")' \
    2> /dev/null; then
  for package in "$kit"/loaders/*.deb; do
    [ ! -e "$package" ] || dpkg -x "$package" "$kit/lib"
  done
  folder=$kit/lib/usr/lib/$(uname -m)-linux-gnu
  export LD_LIBRARY_PATH=$folder${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
fi
export PYTHONPATH=$kit:$kit/site${PYTHONPATH:+:$PYTHONPATH}
exec "$python" "$kit/benchmarks/gpu_suite.py" "$@"
RUN
chmod +x "$kit/run.sh"
du -sh "$kit"
