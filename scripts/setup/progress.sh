# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

# Say what is being done, show how far a long step is, and end it with the set-up.

step=''
reporter=''
held=''  # the signal that came as a step began
step_root=''  # how to signal a step that runs as root

say() {
  printf '%s\n' "$*"
}

stop() {
  printf 'setup: %s\n' "$*" >&2
  exit 1
}

report_while_running() {
  local text=$1 words=$2 log=$3 started=$SECONDS seconds now parent nothing
  # Waiting for what never comes needs no process, as sleep does, which would be left behind.
  exec {nothing}<> <(:)
  until read -r -t 5 -u "$nothing"; do
    # Without the set-up, there is nothing to report on.
    read -r _ _ _ parent _ < "/proc/$BASHPID/stat"
    [ "$parent" = "$$" ] || return 0
    seconds=$((SECONDS - started))
    now=$("$words" "$log")
    printf '  %s: %d s%s\n' "$text" "$seconds" "${now:+, $now}"
  done
}

# For a step that has nothing to count.
no_words() {
  :
}

# long_step TEXT WORDS COMMAND...: run the command, and stop when it fails. WORDS is a function that
# prints from the log of the command how far it is.
long_step() {
  local text=$1 log
  log=$(mktemp "${TMPDIR:-/tmp}/cloth_sim_setup.XXXXXX")
  run_step "$log" "$@" || {
    tail -n 30 "$log" >&2
    stop "$text failed; all of its output is in $log"
  }
  rm -f "$log"
}

# run_step LOG TEXT WORDS COMMAND...: in a process group of its own, so that whatever ends the
# set-up ends all that the command has started.
run_step() {
  local log=$1 text=$2 words=$3 status=0 started=$SECONDS
  shift 3
  say "$text ..."
  # What a signal has to end is known once it has a name.
  on_signals hold
  set -m
  { "$@" || exit "$?"; } > "$log" 2>&1 < /dev/null 8<&- &
  step=$!
  set +m
  report_while_running "$text" "$words" "$log" 8<&- 9<&- &
  reporter=$!
  on_signals stopped_by
  [ -z "$held" ] || stopped_by "$held"
  wait "$step" || status=$?
  step=''
  end_reporter
  [ "$status" -ne 0 ] || say "$text: done in $((SECONDS - started)) s."
  return "$status"
}

end_reporter() {
  [ -n "$reporter" ] || return 0
  kill "$reporter" 2> /dev/null || true
  wait "$reporter" 2> /dev/null || true
  reporter=''
}

# End the step under way, and all that it has started.
end_step() {
  local name
  [ -n "$step" ] || return 0
  for name in TERM KILL; do
    $step_root kill "-$name" -- "-$step" 2> /dev/null || break
    for _ in {1..50}; do
      $step_root kill -0 -- "-$step" 2> /dev/null || break 2
      sleep 0.1
    done
  done
}

# A set-up that is terminated ends its step as well; completed steps stay.
stopped_by() {
  trap '' INT TERM HUP
  printf 'setup: stopped by SIG%s: run it again to go on\n' "$1" >&2
  end_reporter
  end_step
  exit $((128 + $(kill -l "$1")))
}

hold() {
  held=$1
}

# on_signals COMMAND: call it with the name of a signal that would end the set-up.
on_signals() {
  local name
  for name in INT TERM HUP; do
    # shellcheck disable=SC2064
    trap "$1 $name" "$name"
  done
}

on_signals stopped_by
