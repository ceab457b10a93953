#!/bin/sh
# usage: objects.sh CC FILE: FILE names the objects of the library and of the command, one a line. What their sections and symbols must be:
#  1. Nothing is writable: .data, .bss, common and thread-local storage are empty (tables of pointers are in .data.rel.ro, read-only once loaded).
#     One exception: the key by which a thread gives MPFR's tables back when it ends (number/irrational.c), written once, under pthread_once.
#  2. An object of one instruction set (..._avx2.dir/) lets out names that end in that set's, and nothing else: a function or an inline copy with
#     another name would be one for the linker to choose, and could run where the machine does not have its instructions.
#  3. No instruction of 512 bits picks lanes by an immediate within pairs (vpermilpd, vpermilps): no source asks for one, and gcc 12 takes it where four lanes of
#     eight are collected, {0, 0, 4, 4} say, which it cannot do (126 of the 4096 ways to collect them come out wrong): a function over eight lanes then gives
#     wrong answers on machines with AVX-512 alone. Of gcc's objects only; what else compiles may use it well.
# The rules are first tried on objects that break them.
set -u
cc=$1 list=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

broken() { # broken OBJECT: what is wrong with it
  case $1 in
  */number/irrational.c.o)
    objdump -t "$1" | awk -v object="$1" '
      / O \.(data|bss)/ && $NF !~ /^key(_once|_made)?$/ { print object ": " $NF " is writable" }'
    return ;;
  esac
  objdump -h "$1" | awk -v object="$1" '
    $2 ~ /^\.(data|bss|tdata|tbss)(\.|$)/ && $2 !~ /^\.data\.rel\.ro/ && $3 !~ /^0+$/ { print object ": " $2 " is not empty" }'
  objdump -t "$1" | awk -v object="$1" '$0 ~ /\*COM\*/ { print object ": common symbol " $NF }'
  if objdump -s -j .comment "$1" 2> /dev/null | grep -q 'GCC:'; then
    objdump -d --no-show-raw-insn "$1" | awk -v object="$1" '/vpermilp[sd] .*\$.*%zmm/ { sub(/^[^\t]*\t/, ""); print object ": gcc collects lanes by " $0 }'
  fi
  set=$(echo "$1" | sed -n 's/.*_\(sse2\|avx2\|avx512\|pairs\)\.dir\/.*/\1/p')
  if [ -n "$set" ]; then
    nm --defined-only -g "$1" | awk -v object="$1" -v ending="_$set\$" '$3 !~ ending { print object ": lets out " $3 }'
  fi
}

# --- the rules bite ------------------------------------------------------------------------------------------------------
mkdir "$work/x_avx2.dir"
try() { # try NAME WORDS CODE: an object made of the code is complained of with the words; with no words it is not
  echo "$3" > "$work/$1.c"
  "$cc" -std=c17 -O2 -fPIC -c "$work/$1.c" -o "$work/x_avx2.dir/$1.o" || exit 1
  said=$(broken "$work/x_avx2.dir/$1.o")
  case $said in
  "") [ -z "$2" ] || { echo "objects: $1 was not noticed"; exit 1; } ;;
  *"$2"*) [ -n "$2" ] || { echo "objects: $1 is good, but: $said"; exit 1; } ;;
  *) echo "objects: $1: $said"; exit 1 ;;
  esac
}
try good_avx2 "" 'static const char *const names[] = {"a", "b"}; const char *f_avx2(int i); const char *f_avx2(int i) { return names[i]; }'
try data ".data" 'static int n = 3; int f_avx2(void); int f_avx2(void) { return n++; }'
try bss ".bss" 'int f_avx2(void); int f_avx2(void) { static int n; return n++; }'
try thread ".tbss" 'int f_avx2(void); int f_avx2(void) { static _Thread_local int n; return n++; }'
try pointers ".data.rel" 'static const char *names[] = {"a"}; const char **f_avx2(void); const char **f_avx2(void) { return names; }'
if echo 'int i;' | "$cc" -E -dM -x c - | grep -q '__x86_64__' && ! "$cc" --version | grep -qi clang; then
  try lanes "collects lanes" 'void f_avx2(void); void f_avx2(void) { __asm__ volatile("vpermilpd $184, %%zmm0, %%zmm0" ::: "memory"); }'
fi
try name "lets out helper" 'int helper(int i); int helper(int i) { return i; }'

# --- the objects ---------------------------------------------------------------------------------------------------------
while IFS= read -r object; do
  broken "$object"
done < "$list" > "$work/said"
count=$(wc -l < "$list")
wide=$(grep -c '_\(sse2\|avx2\|avx512\)\.dir/' "$list")
if [ "$count" -lt 50 ] || [ "$wide" -lt 9 ]; then
  echo "objects: $list names $count objects, $wide of them wide: too few to be all"
  exit 1
fi
cat "$work/said"
[ -s "$work/said" ] && exit 1
echo "objects: $count, of which $wide are wide: nothing is writable, no wide name is let out, no lanes are collected wrongly"
