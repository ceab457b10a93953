#!/usr/bin/env python3
"""Runs the benchmarks that tools/bench built, in turn, and writes CSV files; report.py makes a page of them. See tools/bench for the options."""
import argparse
import csv
import os
import shutil
import statistics
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import povray # noqa: E402

SCENES = ['sphere1', 'plate1000', 'spheres10k', 'spheres1M', 'tree1024', 'tree1024fat', 'menger4', 'parts2000', 'plate100k', 'tree65k', 'coplanar']
QUICK_SCENES = ['sphere1', 'plate1000', 'spheres10k', 'tree1024', 'menger4']
SPHERES = ['sphere1', 'spheres10k', 'spheres1M']
NO_POVRAY = ['spheres1M', 'parts2000', 'plate100k', 'tree65k'] # too large for it
SCENE_FIELDS = ('scene,path,threads,isa,rays,seconds,mrays,judged,wrong,oracle_judged,oracle_wrong,nodes,leaves,sure,exact_signs,exact_orders,exact_rays,'
                'exact_roundings,read_s,compile_s,leaves_kept,bytes').split(',')


class Bench:
    def __init__(self, args):
        self.args = args
        self.build = os.path.abspath(args.build)
        self.scenes = os.path.join(self.build, 'scenes')
        self.results = os.path.join(self.build, 'results')
        self.begin = time.monotonic()
        os.makedirs(self.scenes, exist_ok=True)
        os.makedirs(self.results, exist_ok=True)

    def program(self, name):
        for folder in ('tests/bench', ''):
            path = os.path.join(self.build, folder, name)
            if os.path.exists(path):
                return path
        return None

    def scene(self, name):
        """The scene's files without their ending, made when they are missing or older than their maker."""
        base = os.path.join(self.scenes, name)
        maker = os.path.join(HERE, 'scenes.py')
        if not os.path.exists(base + '.flat') or os.path.getmtime(base + '.flat') < os.path.getmtime(maker):
            subprocess.run([sys.executable, maker, self.scenes, name], check=True)
        return base

    def say(self, text):
        print('[%4.0f s] %s' % (time.monotonic() - self.begin, text), flush=True)

    def run(self, command, **more):
        return subprocess.run(list(map(str, command)), **more)

    def write(self, name, fields, rows):
        with open(os.path.join(self.results, name + '.csv'), 'w', newline='') as f:
            out = csv.DictWriter(f, fields, restval='', extrasaction='ignore')
            out.writeheader()
            out.writerows(rows)

    def rows(self, path, fields):
        if not os.path.exists(path):
            return []
        with open(path, newline='') as f:
            return list(csv.DictReader(f, fields))

    def scene_rows(self, command):
        """Runs a program with --csv and returns its rows."""
        path = os.path.join(self.results, 'now.csv')
        if os.path.exists(path):
            os.remove(path)
        done = self.run(command + ['--csv', path])
        if done.returncode not in (0, 1):
            self.say('%s: exit code %d' % (os.path.basename(command[0]), done.returncode))
        rows = self.rows(path, SCENE_FIELDS)
        if os.path.exists(path):
            os.remove(path)
        return rows


def number(text):
    try:
        return float(text)
    except (TypeError, ValueError):
        return float('nan')


def merge(rounds):
    """The rounds' rows of one scene: for each path the median rate, and every wrong answer that any round found."""
    by_path = {}
    for rows in rounds:
        for r in rows:
            by_path.setdefault((r['path'], r['threads']), []).append(r)
    out = []
    for rows in by_path.values():
        r = dict(rows[0])
        for field in ('wrong', 'oracle_wrong', 'judged', 'oracle_judged'):
            r[field] = max(int(number(x[field]) if x[field] else 0) for x in rows)
        rates = [number(x['mrays']) for x in rows]
        r['mrays'] = '%.5g' % (statistics.median(rates) if all(x == x for x in rates) else float('nan'))
        for field in ('compile_s', 'read_s'):
            r[field] = min((x[field] for x in rows if x[field]), key=number, default='')
        out.append(r)
    return out


def scenes_part(b):
    a = b.args
    names = a.scene or (QUICK_SCENES if a.quick else SCENES)
    rounds = a.rounds or (1 if a.quick else 3)
    seconds = 0.12 if a.quick else 0.3
    size = a.size or (512 if a.quick else 1024)
    everything = []
    have_povray = not a.no_peers and shutil.which('povray') is not None
    embree = None if a.no_peers else b.program('bench_embree')
    for name in names:
        base = b.scene(name)
        b.say('scene ' + name)
        turns = []
        for r in range(rounds):
            rows = []
            command = [b.program('bench_scenes'), base + '.csg', base + '.camera', '--name', name, '--rounds', 1, '--seconds', seconds, '--size', size,
                       '--oracle', (40 if a.quick else 200) if r == 0 else 0, '--build-threads', 0]
            if a.path:
                command += ['--paths', ','.join(a.path)]
            rows += b.scene_rows(command)
            if embree and name in SPHERES:
                rows += b.scene_rows([embree, base + '.flat', base + '.camera', '--name', name, '--rounds', 1, '--seconds', seconds, '--size', size,
                                      '--oracle', (40 if a.quick else 200) if r == 0 else 0])
            if have_povray and name not in NO_POVRAY:
                rows += povray_rows(b, base, name, r == 0)
            turns.append(rows)
        merged = merge(turns)
        everything += merged
        print_ratios(name, merged)
    b.write('scenes', SCENE_FIELDS, everything)


def povray_rows(b, base, name, judging):
    """One row: its rate and, in the first round, how many of its first hits are wrong."""
    quick = b.args.quick
    slow = base + '.povray-is-slow'
    found = povray.rays_a_second(base, 0.2 if quick else 0.5, 10 if quick else 60)
    row = dict.fromkeys(SCENE_FIELDS, '')
    row.update(scene=name, path='povray', threads='1', isa='', wrong='0', judged='0', oracle_wrong='0', oracle_judged='0')
    if found is None:
        open(slow, 'w').close()
        row['mrays'] = 'nan'
        print('povray             gave up')
        return [row]
    rate, rays = found
    row.update(mrays='%.5g' % (rate / 1e6), rays=str(rays), seconds='%.4g' % (rays / rate))
    size = 128
    if judging and size * size / rate < (5 if quick else 60):
        depths = os.path.join(b.results, 'depths')
        b.run([b.program('bench_scenes'), base + '.csg', base + '.camera', '--size', size, '--depths', depths, '--paths', 'none', '--oracle', 0],
              stdout=subprocess.DEVNULL)
        import array
        with open(depths, 'rb') as f:
            values = array.array('d', f.read())
        os.remove(depths)
        verdict = povray.judge(base, size, values)
        if verdict:
            row['oracle_wrong'], row['oracle_judged'] = map(str, verdict)
    print('povray            %9.4f  %s/%s' % (rate / 1e6, row['oracle_wrong'], row['oracle_judged']))
    return [row]


def print_ratios(name, rows):
    rate = {r['path']: number(r['mrays']) for r in rows}
    for peer in ('embree-packet16', 'embree-packet8', 'embree-single', 'povray'):
        if rate.get(peer, 0) > 0:
            print('  %s: %s' % (peer, ', '.join('%s %.2f times' % (p, rate[p] / rate[peer]) for p in ('grid', 'grid-t', 'tiles', 'single') if rate.get(p, 0) > 0)))


def main():
    p = argparse.ArgumentParser(prog='tools/bench', add_help=False)
    names = lambda text: [x for x in text.split(',') if x]
    p.add_argument('--build', default='build-bench')
    p.add_argument('--quick', action='store_true')
    p.add_argument('--only', type=names, default=['solvers', 'scenes', 'pictures', 'growth'])
    p.add_argument('--scene', type=names)
    p.add_argument('--path', type=names)
    p.add_argument('--size', type=int)
    p.add_argument('--rounds', type=int)
    p.add_argument('--no-peers', action='store_true')
    p.add_argument('--page', action='store_true')
    b = Bench(p.parse_args())
    parts = {'scenes': scenes_part}
    for name in b.args.only:
        if name not in parts:
            p.error('no part is called ' + name)
        b.say(name)
        parts[name](b)


if __name__ == '__main__':
    main()
