#!/bin/sh
# usage: layers.sh SOURCE CC CXX LIBRARY: the rules of the house.
#  1. A file includes "station/file.h" of its own station and of those src/LAYERS lets it see, and public headers; no "../",
#     no bare "file.h". The command line sees public headers only.
#  2. libquoin.so exports quoin_ names only. (LIBRARY "--" leaves this out: sanitizers add names of their own.)
#  3. Every public header compiles alone as C99 and as C++.
#  4. No internal header and no internal name is in a public header.
#  5. Every bound of src/base/bounds.h is derived, by its name, in docs/bounds.md.
#  6. No source has more than 600 lines.
#  7. Git keeps nothing at the top but what the README names: no log, no output.
set -u
source=$1 cc=$2 cxx=$3 library=$4
failures=$(mktemp)
trap 'rm -f "$failures"' EXIT
complain() { echo "layers: $*" | tee -a "$failures"; }

# --- 1. includes -----------------------------------------------------------------------------------------------------
awk '
  FILENAME == layers {
    if ($0 ~ /^[a-z]+:/) {
      station = $1; sub(/:$/, "", station); stations[station] = 1; allowed[station, station] = 1
      for (i = 2; i <= NF; i++) allowed[station, $i] = 1
    }
    next
  }
  FNR == 1 { n = split(FILENAME, path, "/"); station = path[n - 1]; files++
             if (!(station in stations)) print FILENAME ": its folder is not in src/LAYERS" }
  /^[ \t]*#[ \t]*include/ {
    place = FILENAME ":" FNR ": "
    name = $0; sub(/^[ \t]*#[ \t]*include[ \t]*/, "", name)
    quoted = substr(name, 1, 1) == "\""
    sub(/^["<]/, "", name); sub(/[">].*$/, "", name)
    if (name ~ /(^|\/)\.\.?\//) { print place "a relative include: " name; next }
    n = split(name, part, "/")
    if (part[1] == "quoin") next
    if (!quoted) { if (part[1] in stations) print place "write \"" name "\", not <" name ">"; next }
    if (n != 2) { print place "write \"station/file.h\": " name; next }
    if (!(part[1] in stations)) print place "no such station: " name
    else if (!((station, part[1]) in allowed)) print place station " may not include " name " (src/LAYERS)"
  }
  END { if (files < 2) print "no sources found" }
' layers="$source/src/LAYERS" "$source/src/LAYERS" "$source"/src/*/*.[ch] > "$failures.awk"
while IFS= read -r line; do complain "$line"; done < "$failures.awk"
rm -f "$failures.awk"

# --- 2. what the library lets out ------------------------------------------------------------------------------------
if [ "$library" != -- ]; then
  names=$(nm -D --defined-only "$library") || complain "cannot read $library"
  echo "$names" | awk '$2 ~ /[A-Za-z]/ && $3 !~ /^quoin_/ { print $3 }' | while IFS= read -r name; do complain "libquoin.so exports $name"; done
  echo "$names" | grep -q ' T quoin_version$' || complain "libquoin.so does not export quoin_version"
fi

# --- 3 and 4. public headers -----------------------------------------------------------------------------------------
for header in "$source"/include/quoin/*.h; do
  name=quoin/$(basename "$header")
  unit="#include <$name>
#include <$name>
typedef int not_empty;"
  for std in c99 c17; do
    echo "$unit" | "$cc" -std=$std -Wall -Wextra -Wpedantic -Wstrict-prototypes -Wundef -Werror -fsyntax-only -I"$source/include" -x c - ||
      complain "$name does not compile as $std"
  done
  for std in c++11 c++17; do
    [ -z "$cxx" ] || echo "$unit" | "$cxx" -std=$std -Wall -Wextra -Wpedantic -Wundef -Werror -fsyntax-only -I"$source/include" -x c++ - ||
      complain "$name does not compile as $std"
  done
  grep -nE '#[ \t]*include[ \t]*["<]' "$header" | grep -vE '["<](quoin/[a-z]+\.h|stddef\.h|stdint\.h)[">]' | while IFS= read -r line; do
    complain "$name: public headers include only each other, stddef.h and stdint.h: $line"
  done
  grep -nE '(^|[^a-z])(qn_|mpz_|mpq_|mpfr_|__m[0-9])' "$header" | while IFS= read -r line; do complain "$name: an internal name: $line"; done
done
[ -n "$cxx" ] || echo "layers: no C++ compiler: headers were not tried as C++"

# --- 5. bounds -------------------------------------------------------------------------------------------------------
bounds=$(sed -n 's/^#define \(QN_[A-Z0-9_]*\).*/\1/p' "$source/src/base/bounds.h" | grep -v '_H$')
[ -n "$bounds" ] || complain "no bounds found"
for name in $bounds; do
  grep -qw "$name" "$source/docs/bounds.md" || complain "docs/bounds.md does not derive $name"
done

# --- 6. length -------------------------------------------------------------------------------------------------------
for file in "$source"/src/*/*.[ch] "$source"/include/quoin/*.h; do
  lines=$(wc -l < "$file")
  [ "$lines" -le 600 ] || complain "$file has $lines lines"
done

# --- 7. the top level ------------------------------------------------------------------------------------------------
if kept=$(git -C "$source" ls-files 2> /dev/null); then
  echo "$kept" | sed 's|/.*||' | sort -u | grep -vxE 'CMakeLists\.txt|README\.md|src|include|models|tests|docs|tools|\..*' | while IFS= read -r name; do
    complain "$name does not belong at the top"
  done
fi

if [ -s "$failures" ]; then
  exit 1
fi
echo "layers: all rules hold"
