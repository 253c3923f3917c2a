#!/usr/bin/env bash
# Builds the Debian packages from what is committed: packaging/build_debian.sh FOLDER [debuild or dpkg-buildpackage options]
#
# FOLDER receives the source package (.dsc, .orig.tar.gz, .debian.tar.xz) and the packages. Needs devscripts and debhelper;
# without devscripts dpkg-buildpackage does, and lintian is not run. Options replace -us -uc (-b: packages alone).
set -euo pipefail

root=$(cd -- "$(dirname -- "$0")/.." && pwd)
folder=$(mkdir -p -- "${1:?names no folder}" && cd -- "$1" && pwd)
shift
version=$(sed -n 's/^project(plumb VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
source=$folder/plumb-$version
rm -rf -- "$source"
git -C "$root" archive --prefix="plumb-$version/" HEAD | tar -x -C "$folder"
# The sources without the packaging, with the commit's time: the same bits each time.
git -C "$root" archive --prefix="plumb-$version/" HEAD | gzip -n >"$folder/plumb_$version.orig.tar.gz"
cp -r -- "$source/packaging/debian" "$source/debian"
cd -- "$source"
if command -v debuild >/dev/null; then
  debuild --preserve-envvar=CCACHE_DIR --preserve-envvar=PLUMB_CMAKE_FLAGS -us -uc "$@"
else
  dpkg-buildpackage -us -uc "$@"
fi
cd .. && rm -rf -- "$source"
ls -1 -- "$folder"
