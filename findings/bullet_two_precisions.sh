#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
#
# Bullet 3.24 of Debian 12: its libraries of floats and of doubles, in one process.
#
# One would expect either two sets of symbols, because btScalar is another type, or an error of the linker. But names of C++
# functions hold the names of classes, not their sizes, and Debian gives the symbols no versions. So a plugin that is compiled
# and linked for doubles, as libBulletCollision-float64 asks, silently calls the functions of the float library if the program
# that loads it uses that one. A box of 2 m x 4 m x 6 m then has sides that are noise. No step warns: not the compiler, the
# linker, the loader with RTLD_NOW, or Bullet. RTLD_DEEPBIND separates the two.
#
# Seen: 871 of 986 functions of the double library have the name of one of the float library. The plugin prints half sides of
# 1, 2, 3 alone and with RTLD_DEEPBIND, and about 4.67e-310, 0, 4.67e-310 in a program that links libBulletCollision.
#
# Needs g++, nm and apt (for the two packages, which are unpacked into a temporary folder). Exit status 0: as described.
set -euo pipefail
version=3.24+dfsg-2
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"
apt-get -qq -o APT::Sandbox::User=root download "libbullet-dev=$version" "libbullet3.24=$version"
for package in *.deb; do dpkg-deb -x "$package" root; done
lib=$(dirname "$(find "$place/root" -name libBulletCollision.so.3.24)")

symbols() { nm -D --defined-only "$lib/$1" | awk '$2 == "T" { print $3 }' | sort -u; }
of_floats=$(symbols libBulletCollision.so.3.24)
of_doubles=$(symbols libBulletCollision-float64.so.3.24)
common=$(comm -12 <(printf '%s\n' "$of_floats") <(printf '%s\n' "$of_doubles") | wc -l)
all=$(printf '%s\n' "$of_doubles" | wc -l)
echo "functions of the double library: $all; the float library defines functions of the same names: $common"

cat > plugin.cpp <<'EOF'
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <cstdio>
extern "C" void measure(const char* name) {
  static_assert(sizeof(btScalar) == 8, "compiled for doubles");
  const btBoxShape box(btVector3(1, 2, 3));
  const btVector3 half = box.getHalfExtentsWithMargin();
  std::printf("%s: half sides %.3g %.3g %.3g\n", name, half.x(), half.y(), half.z());
}
EOF
cat > program.cpp <<'EOF'
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <dlfcn.h>
#include <cstdio>
#include <cstdlib>
int main(int, char** arguments) {
  static_assert(sizeof(btScalar) == 4, "compiled for floats");
#ifdef USES_BULLET
  const btSphereShape ball(1.0f);
  if (!(ball.getRadius() == 1.0f)) return 1;
#endif
  void* plugin = dlopen(arguments[1], RTLD_NOW | std::atoi(arguments[2]));
  if (plugin == nullptr) return std::puts(dlerror()), 1;
  reinterpret_cast<void (*)(const char*)>(dlsym(plugin, "measure"))(arguments[3]);
}
EOF
headers=(-isystem root/usr/include/bullet)
# Debian's names of the libraries are those that pkg-config prints for bullet and bullet-float64.
g++ -O1 -w -fPIC -shared -DBT_USE_DOUBLE_PRECISION "${headers[@]}" plugin.cpp -o plugin.so -L"$lib" \
  -lBulletCollision-float64 -lLinearMath-float64 -Wl,-rpath,"$lib"
g++ -O1 -w "${headers[@]}" program.cpp -o without -ldl
g++ -O1 -w -DUSES_BULLET "${headers[@]}" program.cpp -o with -L"$lib" -Wl,--no-as-needed -lBulletCollision -lLinearMath \
  -Wl,-rpath,"$lib" -ldl
deepbind=8  # RTLD_DEEPBIND
{
  LD_LIBRARY_PATH=$lib ./without ./plugin.so 0 "alone"
  LD_LIBRARY_PATH=$lib ./with ./plugin.so 0 "beside floats"
  LD_LIBRARY_PATH=$lib ./with ./plugin.so "$deepbind" "beside floats, RTLD_DEEPBIND"
} | tee seen
right="half sides 1 2 3"
grep -q "^alone: $right$" seen
grep -q "^beside floats, RTLD_DEEPBIND: $right$" seen
if grep -q "^beside floats: $right$" seen || ((common * 10 < all * 8)); then
  echo "this has changed: the two libraries no longer disturb each other"
  exit 1
fi
echo "as described"
