# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

# What was done from which input, so that a second run does only what has changed.

# Digest of the given files and folders, names and contents, and of the text on standard input.
digest() {
  {
    cat
    find "$@" -type f -not -path '*/__pycache__/*' -print0 | LC_ALL=C sort -z |
      xargs -0 sha256sum
  } | sha256sum | cut -d ' ' -f 1
}

is_current() {
  [ "$(cat "$stamps/$1" 2> /dev/null)" = "$2" ]
}

# Written last, in one go: a step that was interrupted has no stamp and is done again.
set_stamp() {
  printf '%s\n' "$2" > "$stamps/$1.new"
  mv "$stamps/$1.new" "$stamps/$1"
}

clear_stamp() {
  rm -f "$stamps/$1"
}
