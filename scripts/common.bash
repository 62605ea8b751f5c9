# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
# shellcheck shell=bash
#
# Functions that several scripts in this folder use. They install packages, build, start a separate ROS master, and
# clean up when the script ends.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
export PATH="/usr/bin:/usr/sbin:$PATH"  # ROS needs the python3 of the system; another python3 may come first in PATH

build_packages=(
  catkin cmake g++ make ros-core-dev
  libconsole-bridge-dev libdiagnostic-updater-dev libdynamic-reconfigure-config-init-mutex-dev libeigen3-dev
  libnodelet-dev libnodeletlib-dev libtf2-msgs-dev libtinyxml2-dev liburdfdom-dev liburdfdom-headers-dev
  libyaml-cpp-dev pluginlib-dev python3-setuptools rosbash
)
demo_packages=(
  python3-diagnostic-msgs python3-geometry-msgs python3-numpy python3-roslaunch python3-rospy python3-rosservice python3-rostopic
  python3-sensor-msgs python3-shape-msgs python3-std-srvs python3-tf2-msgs python3-visualization-msgs
  ros-robot-state-publisher
)
# shellcheck disable=SC2034  # read by scripts/test
test_packages=(
  "${demo_packages[@]}" catkin-lint libfaketime libfcl-dev libgtest-dev libnodeletlib-tools liboctomap-dev libtf2-dev
  locales
  python3-dynamic-reconfigure python3-rosbag python3-rosnode python3-rosparam python3-rostest ros-trajectory-msgs
  rospack-tools
)
# shellcheck disable=SC2034  # read by scripts/docs and scripts/test
docs_packages=(doxygen)
# shellcheck disable=SC2034
long_test_packages=(clang g++-aarch64-linux-gnu googletest libclang-rt-dev qemu-user)

# When the script ends for any reason, end() stops all background processes and removes the scratch folder.
started=()
scratch=$(mktemp -d -t hgrid_proximity.XXXXXX)
trap end EXIT
trap 'exit 129' HUP
trap 'exit 130' INT
trap 'exit 143' TERM

# With ccache, if it is installed, a new clone of files that were built before is built in a fraction of the time.
if command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1
  export CCACHE_SLOPPINESS=pch_defines,time_macros  # ccache asks for this to keep files that use precompiled headers
fi

say() { printf -- '-- %s\n' "$*"; }

fail() {
  printf -- '-- %s\n' "$*" >&2
  exit 1
}

# Starts a command in the background. Its process id is then in $!.
start() {
  set -m  # a process group of its own: end() stops it, Ctrl-C does not reach it, and it does not ignore SIGINT
  "$@" </dev/null &
  set +m
  started+=($!)
}

# Runs a command. Shows its output only if it fails.
quietly() {
  local status=0
  start "$@" >"$scratch/step.log" 2>&1
  wait $! || status=$?
  unset 'started[-1]'
  ((status == 0)) || tail -n 60 "$scratch/step.log" >&2
  return "$status"
}

# As quietly, for a build. Every half minute, says how far it has come.
building() {
  local status=0 seconds=0 percent
  start "$@" >"$scratch/step.log" 2>&1
  while kill -0 "${started[-1]}" 2>/dev/null; do
    sleep 1
    ((++seconds % 30 == 0)) || continue
    percent=$(grep -o '^\[ *[0-9]*%' "$scratch/step.log" | tail -n 1 | tr -d '[ ') || true
    [[ ! $percent ]] || say "  $percent after $((seconds / 60)) min $((seconds % 60)) s"
  done
  wait "${started[-1]}" || status=$?
  unset 'started[-1]'
  ((status == 0)) || tail -n 60 "$scratch/step.log" >&2
  return "$status"
}

as_root() {
  if ((EUID == 0)); then "$@"; else sudo "$@"; fi
}

install_debian() {
  local -A present=()
  local -a missing=()
  local package
  command -v apt-get >/dev/null || fail "no apt-get; this script needs Debian 12, or a sourced ROS Noetic"
  while read -r package; do present[$package]=1; done < <(
    dpkg-query -W -f '${Package} ${db:Status-Status}\n' "$@" 2>/dev/null | sed -n 's/ installed$//p'
  )
  for package; do [[ -n ${present[$package]:-} ]] || missing+=("$package"); done
  ((${#missing[@]})) || return 0
  say "installing ${#missing[@]} packages: ${missing[*]}"
  ((EUID == 0)) || sudo true || fail "installing needs root or sudo"
  quietly as_root apt-get -o DPkg::Lock::Timeout=600 update || fail "apt-get update failed"
  quietly as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get -o DPkg::Lock::Timeout=600 install -y --no-install-recommends "${missing[@]}" || fail "apt-get install failed"
}

# Installs the packages that the build needs, and the Debian packages given as arguments. With ROS Noetic, installs the
# dependencies that package.xml names instead.
install_missing() {
  if [[ ${ROS_DISTRO:-} != noetic ]]; then
    install_debian "${build_packages[@]}" "$@"
  elif ! quietly rosdep check --from-paths "$root" --ignore-src; then
    say "installing the dependencies that package.xml names, with rosdep"
    rosdep install --from-paths "$root" --ignore-src -y ||
      fail "rosdep install failed; if rosdep is not initialized, run 'sudo rosdep init' and 'rosdep update'"
  fi
}

# shellcheck disable=SC2120  # the arguments are optional
# Builds the package in Release mode into build/release and devel. Passes its arguments to cmake.
build() {
  local out=$root/build/release
  local -a options=(
    -DCMAKE_BUILD_TYPE=Release "-DCATKIN_DEVEL_PREFIX=$root/devel"
    -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3 "$@"
  )
  if [[ ! -f $out/Makefile || $(cat "$out/.options" 2>/dev/null) != "${options[*]}" ]]; then
    say "configuring"
    # The project uses its messages only in C++ and Python.
    quietly env ROS_LANG_DISABLE=geneus:genlisp:gennodejs cmake -S "$root" -B "$out" "${options[@]}" ||
      fail "cmake failed"
    printf '%s\n' "${options[*]}" >"$out/.options"
  fi
  say "building in Release mode (5 to 10 minutes the first time, seconds later)"
  building cmake --build "$out" -j"$(nproc)" || fail "the build failed"
}

# Adds the build to ROS_PACKAGE_PATH and PATH. Then ROS finds it.
enter_build() {
  set +u  # the generated file reads variables that may not be set
  # shellcheck disable=SC1091
  source "$root/devel/setup.bash"
  set -u
  [[ :$ROS_PACKAGE_PATH: == *:$root:* ]] || export ROS_PACKAGE_PATH=$root:$ROS_PACKAGE_PATH
  export PATH="/usr/bin:$PATH"
}

# From now on, ROS uses a free port for its master, and the scratch folder for its files, until the script ends.
begin_session() {
  local port
  port=$("$root/scripts/free_port")
  unset ROS_HOSTNAME ROS_NAMESPACE
  export ROS_MASTER_URI=http://127.0.0.1:$port ROS_IP=127.0.0.1 ROS_HOME=$scratch/home ROS_LOG_DIR=$scratch/log
  mkdir -p "$ROS_HOME" "$ROS_LOG_DIR"
}

# Starts the ROS master, the demo cell and the node. Passes its arguments to the launch file.
start_cell() {
  start roslaunch -p "${ROS_MASTER_URI##*:}" hgrid_proximity demo.launch "$@" >"$scratch/launch.log" 2>&1
}

# Prints the end of the log of the demo cell and the node, up to the first "Initiating shutdown".
show_logs() { sed '/Initiating shutdown/q' "$scratch/launch.log" | tail -n 30 >&2; }

# Prints the ids of processes that still run. These are the process groups that start() created, and processes of this
# ROS session that lost their parent. A process belongs to the session if its environment has the ROS log folder of the
# session.
still_running() {
  local pid
  for pid in "${started[@]}"; do
    ! kill -0 -- "-$pid" 2>/dev/null || printf '%s\n' "$pid"
  done
  if [[ ${ROS_LOG_DIR:-} == "$scratch"/* ]]; then
    env -u ROS_LOG_DIR grep -lsxzF "ROS_LOG_DIR=$ROS_LOG_DIR" /proc/[0-9]*/environ | cut -d/ -f3 || true
  fi
}

# gone_within SECONDS: waits until still_running() prints nothing. Fails if a process still runs after that time.
gone_within() {
  local tenths
  for ((tenths = $1 * 10; tenths > 0; --tenths)); do
    [[ -n $(still_running) ]] || return 0
    sleep 0.1
  done
  return 1
}

# Stops all processes that still_running() prints (SIGINT, then SIGTERM, then SIGKILL) and removes the scratch folder.
end() {
  local pid signal
  trap '' HUP INT TERM
  for pid in "${started[@]}"; do kill -INT -- "-$pid" 2>/dev/null || true; done
  for signal in TERM KILL; do
    if gone_within 8; then break; fi
    for pid in $(still_running); do
      kill -"$signal" -- "-$pid" 2>/dev/null || kill -"$signal" "$pid" 2>/dev/null || true
    done
  done
  wait 2>/dev/null || true
  rm -rf -- "$scratch"
}
