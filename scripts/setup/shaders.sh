# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

# The driver compiles each shader once and keeps the result in its cache: after this, the first run
# need not wait for that.

# Print the folder that has Mesa's cache; Mesa does not ask HOME.
cache_folder() {
  local home
  home=$(getent passwd "$(id -u)" | cut -d : -f 6)
  printf '%s\n' "${MESA_SHADER_CACHE_DIR:-${XDG_CACHE_HOME:-$home/.cache}}"
}

# Print whether that cache is there; the drivers of GPUs have others.
cache_state() {
  if compgen -G "$(cache_folder)/mesa_shader_cache*" > /dev/null; then
    echo there
  else
    echo none
  fi
}

shader_cache_is_off() {
  case "${MESA_SHADER_CACHE_DISABLE:-${MESA_GLSL_CACHE_DISABLE:-}}" in
    1 | true | yes) return 0 ;;
    *) return 1 ;;
  esac
}

# Print the files of the drivers with their times: another driver compiles anew.
drivers() {
  PATH=$PATH:/usr/sbin:/sbin ldconfig -p |
    sed -nE 's#.*lib(EGL_|gallium|GLX_nvidia|nvidia-glcore|LLVM).* => (.*)#\2#p' | LC_ALL=C sort |
    xargs -r stat --dereference --format '%n %s %Y'
}

# Never a reason for the set-up to fail: without a device, the first run says what is missing.
compile_shaders() {
  local current log
  if shader_cache_is_off; then
    say 'Shaders are compiled in every run, because MESA_SHADER_CACHE_DISABLE switches the cache off.'
    return 0
  fi
  current=$({ drivers; cache_folder; } 2> /dev/null |
    digest shaders config/drape.yaml scripts/setup/compile_shaders.py)
  ! is_current shaders "$current, cache $(cache_state)" || return 0
  clear_stamp shaders
  log=$stamps/shaders.log
  if run_step "$log" 'Compiling the shaders (once per machine)' shader_words \
    "$venv/bin/python" scripts/setup/compile_shaders.py config/drape.yaml; then
    set_stamp shaders "$current, cache $(cache_state)"
  else
    say "Compiling the shaders: not done; the first run does it. $(tail -n 1 "$log")"
  fi
}

shader_words() {
  tail -n 1 "$1"
}
