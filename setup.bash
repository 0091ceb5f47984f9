# Ready a shell for the hexapod graph: `source setup.bash` after `make setup`.
# Virtual environment, workspace, and node discovery kept on this machine unless told otherwise.

_hexapod_root="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
_hexapod_venv="${HEXAPOD_VENV:-$_hexapod_root/.venv}"

if [ ! -f "$_hexapod_root/ros_ws/install/setup.bash" ]; then
  echo "setup.bash: the workspace is not built yet; run 'make setup' in $_hexapod_root first" >&2
  return 1
fi
# A real ROS 2 install that is already sourced stays in front; the wheels fill in where there is none.
if [ -d "$_hexapod_venv" ]; then
  source "$_hexapod_venv/bin/activate"
  if [ -d "$_hexapod_venv/share/ament_index" ]; then
    unset _ROS_WHEELS_BOOTSTRAP_COMPLETE  # another environment's libraries are not ours
    case ":${AMENT_PREFIX_PATH:-}:" in
      *":$_hexapod_venv:"*) ;;
      *) export AMENT_PREFIX_PATH="$_hexapod_venv${AMENT_PREFIX_PATH:+:$AMENT_PREFIX_PATH}" ;;
    esac
  fi
fi
source "$_hexapod_root/ros_ws/install/setup.bash"
export ROS_AUTOMATIC_DISCOVERY_RANGE="${ROS_AUTOMATIC_DISCOVERY_RANGE:-LOCALHOST}"
command -v ros2 >/dev/null 2>&1 || export PATH="$PATH:$_hexapod_root/ros_ws/src/ros2_mini/bin"
unset _hexapod_root _hexapod_venv
