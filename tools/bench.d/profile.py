#!/usr/bin/env python3
"""Reads `perf script -F ip,sym,symoff,dso` on standard input: shares of the samples by function, by source file (of the innermost inlined code), by
station of src/, and of exact arithmetic (src/number and the libraries under it).
usage: profile.py PROGRAM"""
import collections
import os
import re
import subprocess
import sys


def symbols(program):
    """Name -> address; a name that stands more than once is of no use."""
    out = subprocess.run(['nm', program], stdout=subprocess.PIPE, text=True, check=True).stdout
    at = collections.defaultdict(list)
    for line in out.splitlines():
        words = line.split()
        if len(words) == 3 and words[1] in 'tTwW':
            at[words[2]].append(int(words[0], 16))
    return {name: places[0] for name, places in at.items() if len(places) == 1}


def source_files(program, addresses):
    """Address -> the project's file of the innermost inlined function that is the project's."""
    if not addresses:
        return {}
    text = '\n'.join('%#x' % a for a in addresses)
    out = subprocess.run(['addr2line', '-a', '-i', '-e', program], input=text, stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines()
    files, address = {}, None
    for line in out:
        if re.fullmatch(r'0x[0-9a-f]+', line):
            address = int(line, 16)
            files[address] = '(system headers)'
            continue
        m = re.search(r'(?:^|/)((?:src|views|tests)/.*)$', os.path.normpath(line.rsplit(':', 1)[0]))
        if m and files[address] == '(system headers)':
            files[address] = re.sub(r'^views/[a-z]+/', 'src/', m.group(1))
    return files


def show(title, counter, total, most):
    print('\n' + title)
    for name, n in counter.most_common(most):
        if n / total >= 0.003:
            print('  %5.1f %%  %s' % (100 * n / total, name))


def main():
    program = os.path.realpath(sys.argv[1])
    at = symbols(program)
    functions, places, files = collections.Counter(), collections.Counter(), collections.Counter()
    total = exact = 0
    base = None
    for line in sys.stdin:
        m = re.match(r'\s*([0-9a-f]+) (.*) \((.*)\)$', line.rstrip())
        if not m:
            continue
        total += 1
        name, _, offset = m.group(2).rpartition('+')
        name = name or m.group(2)
        library = os.path.basename(m.group(3))
        inside = os.path.realpath(m.group(3)) == program
        functions[name if inside else '%s (%s)' % (name, library)] += 1
        if not inside:
            files[library] += 1
            exact += bool(re.match(r'lib(gmp|mpfr)', library))
            continue
        ip = int(m.group(1), 16)
        places[ip] += 1
        if base is None and name in at and offset: # where the program was loaded
            base = ip - at[name] - int(offset, 16)
    if not total:
        raise SystemExit('no samples')
    base = base or 0
    by_address = source_files(program, [ip - base for ip in places])
    for ip, n in places.items():
        files[by_address[ip - base]] += n
    stations = collections.Counter()
    for name, n in files.items():
        m = re.match(r'src/([a-z]+)/', name)
        stations[m.group(1) if m else 'tests/bench' if name.startswith('tests/bench') else name] += n
        # dd.h is arithmetic in doubles, of the fast tiers
        exact += n if name.startswith('src/number/') and not name.endswith('/dd.h') else 0
    print('%d samples' % total)
    show('by function', functions, total, 30)
    show('by file', files, total, 20)
    show('by station', stations, total, 20)
    print('\nexact arithmetic (src/number without dd.h, GMP, MPFR): %.2f %%' % (100 * exact / total))


if __name__ == '__main__':
    main()
