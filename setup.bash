# Ready a shell, bash or zsh, for the hexapod graph: `source setup.bash` after `make setup`.
# Virtual environment, workspace, and node discovery kept on this machine unless told otherwise.

if [ -z "${BASH_VERSION:-}${ZSH_VERSION:-}" ]; then  # dash reads line by line, and no further
  echo "setup.bash: this shell is neither bash nor zsh, expected one of them: bash -c 'source setup.bash && ...'" >&2
  return 1 2>/dev/null || exit 1
fi
if [ "${BASH_SOURCE[0]:-}" = "$0" ] || [ "${ZSH_EVAL_CONTEXT:-file}" = toplevel ]; then
  echo "setup.bash: run as a program it changes nothing, expected 'source setup.bash'" >&2
  exit 1
fi

# Args: this file, and the shell, after which the workspace names its files.
_hexapod_enter() {
  local root venv workspace
  root="$(dirname -- "$(readlink -f -- "$1")")"
  venv="${HEXAPOD_VENV:-$root/.venv}"
  workspace="$root/ros_ws/install/setup.$2"
  if [ ! -f "$workspace" ]; then
    echo "setup.bash: the workspace is not built yet; run 'make setup' in $root first" >&2
    return 1
  fi
  "$root/.ci/other_ros" || return 1
  # A real ROS 2 install that is already sourced stays in front; the wheels fill in where there is none.
  if [ -d "$venv" ]; then
    source "$venv/bin/activate"
    if [ -d "$venv/share/ament_index" ]; then
      unset _ROS_WHEELS_BOOTSTRAP_COMPLETE  # another environment's libraries are not ours
      case ":${AMENT_PREFIX_PATH:-}:" in
        *":$venv:"*) ;;
        *) export AMENT_PREFIX_PATH="$venv${AMENT_PREFIX_PATH:+:$AMENT_PREFIX_PATH}" ;;
      esac
    fi
  fi
  source "$workspace"
  export ROS_AUTOMATIC_DISCOVERY_RANGE="${ROS_AUTOMATIC_DISCOVERY_RANGE:-LOCALHOST}"
  command -v ros2 >/dev/null 2>&1 || export PATH="$PATH:$root/ros_ws/src/ros2_mini/bin"
}

# Enter without `set -e` and `set -u`, which colcon's and venv's files do not stand.
_hexapod_setup() {
  local strict='' result
  case $- in *e*) strict=e ;; esac
  case $- in *u*) strict="${strict}u" ;; esac
  set +eu
  _hexapod_enter "$@"
  result=$?
  unset -f _hexapod_enter _hexapod_setup
  [ -z "$strict" ] || set "-$strict"
  return "$result"
}

if [ -n "${ZSH_VERSION:-}" ]; then
  eval '_hexapod_setup "${(%):-%x}" zsh'  # words of zsh alone, which bash could not read
else
  _hexapod_setup "${BASH_SOURCE[0]}" bash
fi
