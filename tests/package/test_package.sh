#!/bin/sh
# usage: test_package.sh BUILD CMAKE CC: installs BUILD to a fresh folder, moves it, and builds side.c against it.
set -eu
build=$1 cmake=$2 cc=$3
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset CMAKE_PREFIX_PATH PKG_CONFIG_PATH LD_LIBRARY_PATH DESTDIR || true

"$cmake" --install "$build" --prefix "$work/first" > "$work/install.log"
mv "$work/first" "$work/prefix"                  # the tree may be moved
cp -r "$here" "$work/outside"                    # and the program does not lie in ours
version=$("$work/prefix/bin/quoin" --version | sed 's/^quoin //')

run() { # run LABEL PROGRAM: it must answer right
  got=$("$2") || { echo "package: $1: exit code $?: $got"; exit 1; }
  [ "$got" = "$version boundary" ] || { echo "package: $1: expected '$version boundary', got '$got'"; exit 1; }
  echo "package: $1: $got"
}
uses_shared() { # does a program load libquoin.so?
  ldd "$1" 2>/dev/null | grep -q 'libquoin\.so'
}

for shared in ON OFF; do
  "$cmake" -S "$work/outside/consumer" -B "$work/cmake-$shared" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_C_COMPILER="$cc" \
    -DBUILD_SHARED_LIBS=$shared > "$work/cmake.log" 2>&1 || { cat "$work/cmake.log"; exit 1; }
  "$cmake" --build "$work/cmake-$shared" > "$work/cmake.log" 2>&1 || { cat "$work/cmake.log"; exit 1; }
  run "find_package, BUILD_SHARED_LIBS=$shared" "$work/cmake-$shared/side"
done
uses_shared "$work/cmake-ON/side" || { echo "package: quoin::quoin is not the shared library"; exit 1; }
! uses_shared "$work/cmake-OFF/side" || { echo "package: quoin::quoin is not the static library"; exit 1; }

PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name quoin.pc)")
export PKG_CONFIG_PATH
[ "$(pkg-config --modversion quoin)" = "$version" ] || { echo "package: pkg-config and the program disagree about the version"; exit 1; }
libdir=$(pkg-config --variable=libdir quoin)
# shellcheck disable=SC2046 # the flags are meant to be split
"$cc" -std=c99 -o "$work/side-shared" "$work/outside/side.c" $(pkg-config --cflags --libs quoin) "-Wl,-rpath,$libdir"
uses_shared "$work/side-shared" || { echo "package: pkg-config did not give the shared library"; exit 1; }
run "pkg-config, shared" "$work/side-shared"
# A folder without the shared library, so that -lquoin is the static one; the rest as --static says.
mkdir "$work/static" && cp "$libdir/libquoin.a" "$work/static"
# shellcheck disable=SC2046
"$cc" -std=c99 -o "$work/side-static" "$work/outside/side.c" "-L$work/static" $(pkg-config --static --cflags --libs quoin | sed "s|-L$libdir||")
! uses_shared "$work/side-static" || { echo "package: pkg-config --static gave the shared library"; exit 1; }
run "pkg-config, static" "$work/side-static"

# The program of docs/api.md does what the page says.
awk '/^```c$/ { on = 1; next } /^```$/ { on = 0 } on' "$here/../../docs/api.md" > "$work/api.c"
awk '/^```text$/ { on = 1; next } /^```$/ { on = 0 } on' "$here/../../docs/api.md" > "$work/api.want"
# shellcheck disable=SC2046
"$cc" -std=c99 -Wall -Wextra -Werror -o "$work/api" "$work/api.c" $(pkg-config --cflags --libs quoin) "-Wl,-rpath,$libdir"
"$work/api" > "$work/api.got" || { echo "package: the program of docs/api.md: exit code $?"; exit 1; }
diff "$work/api.want" "$work/api.got" || { echo "package: the program of docs/api.md prints something else"; exit 1; }
echo "package: the program of docs/api.md is right"
