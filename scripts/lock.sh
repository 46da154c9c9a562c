#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


# Write requirements/*.txt, with the hashes of every file, from requirements/*.in. Versions that are
# locked stay, unless a *.in asks for another or an option says so:
#
#   scripts/lock.sh
#   scripts/lock.sh --upgrade-package rosbags
#
# Needs uv (pip install uv) and a network.

set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/../requirements"
command -v uv > /dev/null || {
  echo 'lock.sh: uv is missing: run `pip install uv`' >&2
  exit 1
}
export UV_CUSTOM_COMPILE_COMMAND=scripts/lock.sh

# lock FILE ARGUMENTS...: one file for all Pythons; what Windows alone needs is left out.
lock() {
  local file=$1
  shift
  # Extras stay in the pins: the pip of a new venv takes a pin without them for another package.
  uv pip compile --quiet --universal --python-version 3.10 --generate-hashes --no-annotate \
    --no-strip-extras \
    --no-emit-package colorama --no-emit-package coloredlogs --no-emit-package humanfriendly \
    --no-emit-package pyreadline3 --no-emit-package pywin32 --output-file "$file" "$@"
}

lock run.txt ros.in build.in runtime.in "$@"
# The same versions, and those of the live view and of the tests.
lock view.txt view.in --constraints run.txt "$@"
lock test.txt ros.in build.in runtime.in view.in test.in --constraints run.txt \
  --constraints view.txt "$@"
lock sourced_ros.txt sourced_ros.in --constraints ubuntu-24.04.txt "$@"
