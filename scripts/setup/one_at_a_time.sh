# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

# Two set-ups of one checkout at a time would mix their files: the second one waits. The lock is on
# the folder, open as file 9, and belongs to the set-up and to all that it has started. The set-up
# alone is a bash that has the folder open as file 8, too.

# Print the processes that have the lock, newest last: start [clock ticks], group, id, and whether
# it is the set-up or what that has started.
lock_holders() {
  local info pid start group part
  for info in /proc/[0-9]*/fdinfo/9; do
    pid=${info#/proc/} pid=${pid%%/*}
    [ "/proc/$pid/fd/9" -ef "$root" ] && grep -q FLOCK "$info" 2> /dev/null || continue
    part=started
    if [ "/proc/$pid/fd/8" -ef "$root" ] && [ "/proc/$pid/exe" -ef "/proc/$$/exe" ]; then
      part=setup
    fi
    read -r group start < <(sed 's/.*) //' "/proc/$pid/stat" 2> /dev/null | cut -d ' ' -f 3,20) &&
      printf '%s %s %s %s\n' "$start" "$group" "$pid" "$part"
  done | sort -n -k 1,1 -k 3,3
}

# Print the time of day at which a process was started, from its start [clock ticks].
time_of_start() {
  date -d "@$(($(sed -n 's/^btime //p' /proc/stat) + $1 / $(getconf CLK_TCK)))" +%T
}

# Say whom this set-up waits for, and since when that one runs.
say_holder() {
  local start group pid command target
  if read -r start group pid _ < <(grep ' setup$' <<< "$1"); then
    say 'Waiting for another set-up of this checkout to end:' \
      "process $pid, started at $(time_of_start "$start")."
  elif [ -n "$1" ]; then
    read -r start group pid _ < <(tail -n 1 <<< "$1")
    command=$(tr '\0' ' ' 2> /dev/null < "/proc/$pid/cmdline" | cut -c 1-100) || return 0
    # A long step has a group of its own; anything else is in the group of who called the set-up.
    target=$pid
    ! grep -q " $group $group " <<< "$1" || target="-- -$group"
    say 'Waiting for what a set-up of this checkout left behind when it was killed:' \
      "process $pid (${command% }), started at $(time_of_start "$start")." \
      "To end it: kill $target"
  else
    say 'Waiting for another set-up of this checkout to end; this user may not see which.'
  fi
}

one_at_a_time() {
  local holders said=none
  exec 8< "$root" 9< "$root"
  flock --nonblock 9 && return
  while :; do
    holders=$(lock_holders)
    # Only the set-up, or the first one left behind, is worth a new line.
    if [ "$(whom "$holders")" != "$said" ]; then
      say_holder "$holders"
      said=$(whom "$holders")
    fi
    ! flock --timeout 5 9 || return 0
  done
}

whom() {
  { grep ' setup$' <<< "$1" || head -n 1 <<< "$1"; } | cut -d ' ' -f 3
}
