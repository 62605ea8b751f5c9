# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
# shellcheck shell=bash
#
# Functions that make, enter and remove a bare Debian in a folder. They need root. Source scripts/common.bash first.

# The Debian mirror that this machine uses.
debian_mirror() {
  local mirror
  mirror=$(sed -n 's/^URIs: *//p' /etc/apt/sources.list.d/debian.sources 2>/dev/null | head -n 1)
  [[ -n $mirror ]] || mirror=$(awk '$1 == "deb" && $2 ~ /debian\/?$/ { print $2; exit }' /etc/apt/sources.list 2>/dev/null)
  printf '%s\n' "${mirror:-http://deb.debian.org/debian}"
}

# twice COMMAND...: runs a command, and once more if it fails, because a download can fail by chance.
twice() { "$@" || "$@"; }

# has_suite SUITE: succeeds unless the mirror says that it does not hold this suite (any longer).
has_suite() {
  local status=0
  install_debian wget
  wget -q --spider "$(debian_mirror)/dists/$1/InRelease" || status=$?
  ((status != 8))  # wget's status for an answer such as "404 Not Found"
}

# make_bare SUITE FOLDER: makes a minimal Debian (bullseye, bookworm, trixie) in FOLDER, as a fresh machine has it: only
# ca-certificates, git and sudo beside the essential packages.
make_bare() {
  install_debian debootstrap
  twice unpack_bare "$@" || return
  cp -L /etc/resolv.conf "$2/etc/resolv.conf"
  # debootstrap of Debian 11 and 12 writes no such file; the installer of Debian does, and ROS looks up localhost.
  [[ -e $2/etc/hosts ]] || printf '127.0.0.1 localhost\n' >"$2/etc/hosts"
  # The system is removed after the test, so dpkg need not wait for the disk after each file.
  printf 'force-unsafe-io\n' >"$2/etc/dpkg/dpkg.cfg.d/no_waiting"
  cp -L /etc/ssl/certs/ca-certificates.crt "$2/etc/ssl/certs/"  # this machine may trust an authority of its own
}

unpack_bare() {
  remove_bare "$2"
  quietly debootstrap --variant=minbase --include=ca-certificates,git,sudo "$1" "$2" "$(debian_mirror)"
}

# in_bare FOLDER COMMAND...: runs a command in the Debian in FOLDER, as root, with an empty environment. The network is
# that of this machine. All processes that the command leaves behind are killed when it ends, and nothing stays mounted.
in_bare() {
  # The shell stays as the first process of the new process namespace. It waits for orphaned processes.
  # shellcheck disable=SC2016  # the inner shell expands these
  env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 unshare --mount --pid --fork --kill-child bash -c '
    mount -t proc proc "$0/proc" && mount --rbind /sys "$0/sys" && mount --rbind /dev "$0/dev" || exit
    chroot "$0" "$@"
    exit' "$@"
}

# remove_bare FOLDER: removes a Debian that make_bare made.
remove_bare() { rm -rf --one-file-system -- "$1"; }
