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
import report # noqa: E402
import scenes # noqa: E402

SCENES = ['sphere1', 'plate1000', 'spheres10k', 'spheres1M', 'tree1024', 'tree1024fat', 'menger4', 'parts2000', 'plate100k', 'tree65k', 'coplanar', 'part50', 'part50flush']
QUICK_PATHS = ['single', 'tiles', 'grid-t', 'grid', 'intervals', 'grid-intervals', 'intervals-exact', 'shadow', 'random-single', 'random', 'points']
QUICK_SCENES = ['sphere1', 'plate1000', 'spheres10k', 'tree1024', 'menger4']
SPHERES = ['sphere1', 'spheres10k', 'spheres1M']
NO_POVRAY = ['spheres1M', 'parts2000', 'plate100k', 'tree65k'] # too large for it
EXACT_PATHS = ['single', 'grid-t', 'grid', 'intervals', 'shadow', 'random', 'points'] # whose share of exact arithmetic is measured
UNCHECKED_PATHS = ['grid', 'single'] # in packets, and one by one
SCENE_FIELDS = ('scene,path,threads,isa,rays,seconds,mrays,judged,wrong,oracle_judged,oracle_wrong,nodes,leaves,sure,exact_signs,exact_orders,exact_rays,'
                'exact_roundings,read_s,compile_s,leaves_kept,bytes').split(',')
EXACT_FIELDS = SCENE_FIELDS + ['exact_share', 'woven_share', 'met']
ADVERSARY_FIELDS = 'family,leaves,bytes_a_leaf,compile_s,met,solved_first,solved_all,solve_ns,first_ns,first_times,all_ns,all_times,wrong,judged'.split(',')


class Bench:
    def __init__(self, args):
        self.args = args
        self.build = os.path.abspath(args.build)
        self.scenes = os.path.join(self.build, 'scenes')
        self.results = os.path.join(self.build, 'results')
        self.begin = time.monotonic()
        self.povray_size, self.povray_gave_up = {}, set()
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

    def scene_rows(self, command, fields=SCENE_FIELDS):
        """Runs a program with --csv and returns its rows."""
        path = os.path.join(self.results, 'now.csv')
        if os.path.exists(path):
            os.remove(path)
        done = self.run(command + ['--csv', path])
        if done.returncode not in (0, 1):
            self.say('%s: exit code %d' % (os.path.basename(command[0]), done.returncode))
        rows = self.rows(path, fields)
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
        r['turns'] = ' '.join('%.5g' % x for x in rates)
        for field in ('compile_s', 'read_s'):
            r[field] = min((x[field] for x in rows if x[field]), key=number, default='')
        out.append(r)
    return out


def scenes_part(b):
    a = b.args
    names = a.scene or (QUICK_SCENES if a.quick else SCENES)
    rounds = a.rounds or (1 if a.quick else 5)
    seconds = 0.12 if a.quick else 0.2
    size = a.size or (512 if a.quick else 1024)
    everything, exact = [], []
    unchecked = b.program('bench_unchecked')
    have_povray = not a.no_peers and shutil.which('povray') is not None
    embree = None if a.no_peers else b.program('bench_embree')
    for name in names:
        base = b.scene(name)
        b.say('scene ' + name)
        turns = []
        for r in range(rounds):
            rows = []
            command = [b.program('bench_scenes'), base + '.csg', base + '.camera', '--name', name, '--rounds', 1, '--seconds', seconds, '--size', size,
                       '--oracle', 40 if a.quick else 200, '--judge', int(r == 0), '--build-threads', 0]
            if a.path or a.quick:
                command += ['--paths', ','.join(a.path or QUICK_PATHS)]
            rows += b.scene_rows(command)
            if unchecked and not a.path: # its answers are not judged: it only tells what certainty costs, beside the library asked in the same way
                for program, kind in ((b.program('bench_scenes'), 'checked-'), (unchecked, 'unchecked-')):
                    theirs = b.scene_rows([program, base + '.csg', base + '.camera', '--name', name, '--rounds', 1, '--seconds', seconds, '--size', size,
                                           '--oracle', 0, '--judge', 0, '--build-threads', 0, '--paths', ','.join(UNCHECKED_PATHS)])
                    rows += [dict(r, path=kind + r['path']) for r in theirs]
            if embree and name in SPHERES:
                rows += b.scene_rows([embree, base + '.flat', base + '.camera', '--name', name, '--rounds', 1, '--seconds', seconds, '--size', size,
                                      '--oracle', (40 if a.quick else 200) if r == 0 else 0])
            if have_povray and name not in NO_POVRAY:
                rows += povray_rows(b, base, name, r == 0)
            turns.append(rows)
        merged = merge(turns)
        everything += merged
        print_ratios(name, merged)
        b.write('scenes', SCENE_FIELDS + ['turns'], everything)
        if b.program('bench_exact') and not a.path:
            exact += b.scene_rows([b.program('bench_exact'), base + '.csg', base + '.camera', '--name', name, '--rounds', 1, '--seconds', seconds / 2, '--size', size,
                                   '--oracle', 0, '--judge', 0, '--build-threads', 0, '--paths', ','.join(EXACT_PATHS)], EXACT_FIELDS)
            b.write('exact', EXACT_FIELDS, exact)


def povray_rows(b, base, name, judging):
    """One row: its rate and, in the first round, how many of its first hits are wrong."""
    quick = b.args.quick
    if name in b.povray_gave_up:
        return []
    found = povray.rays_a_second(base, 0.2 if quick else 0.5, 10 if quick else 60, size=b.povray_size.get(name, 64))
    row = dict.fromkeys(SCENE_FIELDS, '')
    row.update(scene=name, path='povray', threads='1', isa='', wrong='0', judged='0', oracle_wrong='0', oracle_judged='0')
    if found is None:
        b.povray_gave_up.add(name)
        row['mrays'] = 'nan'
        print('povray             gave up')
        return [row]
    rate, rays = found
    b.povray_size[name] = round(rays**.5)
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


# --- pictures --------------------------------------------------------------------------------------------------------

PICTURE_SCENES = ['part50', 'spheres10k']
LIGHT = [0.5, 0.2, -0.7] # the way it travels
PICTURE_FIELDS = ['scene', 'program', 'setting', 'seconds', 'rms', 'threads', 'rays']
COMMAND_FIELDS = ['scene', 'program', 'threads', 'width', 'height', 'seconds']
TEXT_FIELDS = ['scene', 'command', 'threads', 'lines', 'seconds', 'mlines']
ANTIALIASING = [('none', ['-A'])] + \
    [('%dx%d where over 0.1' % (r, r), ['+A0.1', '+AM1', '+R%d' % r]) for r in (2, 3, 4, 6, 9)] + \
    [('recursive depth %d' % r, ['+A0.05', '+AM2', '+R%d' % r]) for r in (1, 2, 3, 4)]


def picture_model(base):
    """The scene with a light and a plain white material."""
    path = base + '.picture.csg'
    with open(base + '.csg') as f, open(path, 'w') as out:
        out.write('light(direction=%r);\nbackground([0,0,0]);\nmaterial(color=[1,1,1],ambient=0.1,diffuse=0.9,specular=0) {\n' % LIGHT)
        shutil.copyfileobj(f, out)
        out.write('}\n')
    return path


def pictures_part(b):
    quick = b.args.quick
    names = [n for n in PICTURE_SCENES if not b.args.scene or n in b.args.scene]
    peers = not b.args.no_peers and shutil.which('povray') is not None
    path = os.path.join(b.results, 'pictures.csv')
    if os.path.exists(path):
        os.remove(path)
    for name in names[:1] if quick else names:
        base = b.scene(name)
        model = picture_model(base)
        width, height = povray.picture_size(base, 160 if quick else 400)
        others = os.path.join(b.results, 'others.txt')
        with open(others, 'w') as f:
            for k, (label, settings) in enumerate(ANTIALIASING if peers else []):
                if quick and k not in (0, 2, 4, 7):
                    continue
                output = os.path.join(b.results, 'povray-%d.ppm' % k)
                text = povray.picture_text(base, width, height, LIGHT)
                spent = povray.render(base, text, width, height, settings, 1, output, 40)
                if spent is None:
                    break
                f.write('POV-Ray:%s %r %s\n' % (label.replace(' ', '_'), spent[0], output))
        b.run([b.program('bench_pictures'), model, base + '.camera', '--width', width, '--side', 16 if quick else 32, '--name', name, '--csv', path,
               '--seconds', 0.05 if quick else 0.5, '--others', others])
        for k in range(len(ANTIALIASING)):
            output = os.path.join(b.results, 'povray-%d.ppm' % k)
            if os.path.exists(output):
                os.remove(output)
    rows = b.rows(path, PICTURE_FIELDS)
    b.write('pictures', PICTURE_FIELDS, rows)
    commands_part(b, peers)
    text_part(b)


def commands_part(b, peers):
    """Whole commands, from start to written PNG: a part of 50 leaves, 800 x 600, shadows, antialiased."""
    base = b.scene('part50')
    model = picture_model(base)
    o, u, v, d = povray.camera_of(base + '.camera')
    eye = [o[i] + u[i] / 2 + v[i] / 2 for i in range(3)]
    look = [eye[i] + d[i] * povray.dot(v, v)**.5 / 2 for i in range(3)]
    png = os.path.join(b.results, 'part50.png')
    threads = os.cpu_count() or 1
    rows = []
    command = [b.program('quoin'), 'render', model, '-o', png, '--imgsize', '800,600', '--projection', 'ortho', '--fov', 90, '--camera',
               ','.join(repr(x) for x in eye + look), '--quiet']
    ours, theirs = [], []
    for _ in range(2 if b.args.quick else 7): # in turn
        begin = time.monotonic()
        if b.run(command).returncode != 0:
            return
        ours.append(time.monotonic() - begin)
        if peers:
            text = povray.picture_text(base, 800, 600, LIGHT)
            spent = povray.render(base, text, 800, 600, ['+A0.1', '+AM1', '+R4'], threads, png, 300)
            if spent:
                theirs.append(spent[1])
    for program, times in (('quoin render', ours), ('povray', theirs)):
        if times:
            rows.append(dict(scene='part50', program=program, threads=threads, width=800, height=600, seconds='%.4f' % statistics.median(times)))
            print('  %-14s 800x600, shadows, antialiased, %d threads: %.4f s' % (program, threads, statistics.median(times)))
    os.remove(png)
    b.write('commands', COMMAND_FIELDS, rows)


def text_part(b):
    """Points and rays as decimals through the command: lines a second, the time of a run with one line taken off."""
    g = scenes.Random(7)
    rows = []
    for command, name, numbers in (('query', 'spheres10k', 3), ('ray', 'plate1000', 6)):
        lines = (100000 if b.args.quick else 1000000) // (1 if command == 'query' else 2)
        base = b.scene(name)
        o, u, v, d = povray.camera_of(base + '.camera')
        asked, one = os.path.join(b.results, 'asked.txt'), os.path.join(b.results, 'one.txt')
        with open(asked, 'w') as f:
            for _ in range(lines):
                if numbers == 3:
                    f.write('%.6f %.6f %.6f\n' % (g.f(0, 100), g.f(0, 100), g.f(0, 100)))
                else:
                    x, y = g.f(), g.f()
                    f.write('%.6f %.6f %.6f %.6f %.6f %.6f\n' % (*[o[i] + x * u[i] + y * v[i] for i in range(3)], *d))
        with open(asked) as f, open(one, 'w') as out:
            out.write(f.readline())
        answers = []
        for threads in dict.fromkeys([1, os.cpu_count() or 1]):
            times = []
            for file in (asked, one):
                out = os.path.join(b.results, 'answered.txt')
                begin = time.monotonic()
                with open(out, 'w') as f:
                    done = b.run([b.program('quoin'), command, '-i', file, '--threads', threads, '--quiet', base + '.csg'], stdout=f)
                times.append(time.monotonic() - begin)
                if file == asked:
                    with open(out) as f:
                        answers.append(f.read())
                os.remove(out)
            right = done.returncode == 0 and answers[-1] == answers[0] and answers[0].count('\n') == lines
            seconds = times[0] - times[1] if right else float('nan')
            rows.append(dict(scene=name, command='quoin ' + command, threads=threads, lines=lines, seconds='%.4g' % seconds, mlines='%.4g' % (lines / seconds / 1e6)))
            print('  quoin %-6s %s, %d threads: %.3f million lines a second' % (command, name, threads, lines / seconds / 1e6))
        os.remove(asked)
        os.remove(one)
    b.write('text', TEXT_FIELDS, rows)


# --- growth and threads ----------------------------------------------------------------------------------------------

GROWTH = {
    'spheres': [10, 100, 1000, 10000, 100000, 1000000],
    'dense': [10, 100, 1000, 10000, 100000, 1000000],
    'plate': [10, 100, 1000, 10000, 100000],
    'tree': [10, 100, 1000, 10000, 100000, 1000000],
    'menger': [1, 2, 3, 4, 5],
}
GROWTH_QUICK = {'spheres': [10, 1000, 10000], 'dense': [10, 1000], 'plate': [10, 1000, 10000], 'tree': [10, 1000, 10000], 'menger': [1, 3, 4]}
GROWTH_PATHS = ['single', 'grid', 'grid-intervals', 'random', 'points']
GROWTH_NEAR = ['single', 'grid'] # by the near camera
THREAD_SCENES = ['plate1000', 'spheres10k', 'tree1024']


def growth_part(b):
    quick = b.args.quick
    rows, build = [], []
    for family, sizes in (GROWTH_QUICK if quick else GROWTH).items():
        for n in sizes:
            name = '%s-%d' % (family, n)
            if b.args.scene and name not in b.args.scene and family not in b.args.scene:
                continue
            base = b.scene(name)
            b.say('growth ' + name)
            for threads in [1] if quick else [1, 0]: # of the compilation
                measured = lambda camera, paths: b.scene_rows([b.program('bench_scenes'), base + '.csg', base + camera, '--name', name, '--rounds', 1 if quick else 3,
                                                               '--seconds', 0.05 if quick else 0.2, '--size', 512, '--oracle', 20, '--judge', int(threads == 1),
                                                               '--build-threads', threads, '--paths', ','.join(paths)])
                found = measured('.camera', GROWTH_PATHS if threads else ['grid'])
                if threads:
                    found += [dict(r, path=r['path'] + '-near') for r in measured('.near', GROWTH_NEAR)]
                met = b.scene_rows([b.program('bench_exact'), base + '.csg', base + '.camera', '--name', name, '--rounds', 1, '--seconds', 0.001, '--oracle', 0, '--judge', 0,
                                    '--build-threads', 0, '--paths', 'grid'], EXACT_FIELDS) if threads and b.program('bench_exact') else []
                for r in found if threads else []:
                    rows.append(dict(r, met=met[0]['met'] if met else ''))
                for r in found[:1]:
                    build.append(dict(scene=name, build_threads=threads or os.cpu_count(), leaves=r['leaves_kept'], read_s=r['read_s'],
                                      compile_s=r['compile_s'], bytes=r['bytes']))
        b.write('growth', SCENE_FIELDS + ['met'], rows)
        b.write('build', ['scene', 'build_threads', 'leaves', 'read_s', 'compile_s', 'bytes'], build)
    rows = []
    for name in THREAD_SCENES if not quick else THREAD_SCENES[:1]:
        if b.args.scene and name not in b.args.scene:
            continue
        base = b.scene(name)
        for threads in range(1, (os.cpu_count() or 1) + 1):
            rows += b.scene_rows([b.program('bench_scenes'), base + '.csg', base + '.camera', '--name', name, '--rounds', 1 if quick else 3, '--seconds',
                                  0.1 if quick else 0.4, '--judge', 0, '--threads', threads, '--paths', 'grid,single,intervals'])
    b.write('threads', SCENE_FIELDS, rows)


# --- trees made to hurt ------------------------------------------------------------------------------------------------

def adversary_part(b):
    path = os.path.join(b.results, 'adversary.csv')
    if os.path.exists(path):
        os.remove(path)
    b.run([b.program('bench_adversary'), '--csv', path] + (['--rays', 60, '--judge', 10, '--seconds', 0.1] if b.args.quick else ['--seconds', 1]))
    b.write('adversary', ADVERSARY_FIELDS, b.rows(path, ADVERSARY_FIELDS))


# --- solvers ---------------------------------------------------------------------------------------------------------

def solvers_part(b):
    b.run([b.program('bench_solvers'), '--csv', os.path.join(b.results, 'solvers.csv')] +
          (['--cases', 300, '--seconds', 0.01] if b.args.quick else ['--cases', 3000, '--seconds', 0.1]))


def main():
    p = argparse.ArgumentParser(prog='tools/bench', add_help=False)
    names = lambda text: [x for x in text.split(',') if x]
    p.add_argument('--build', default='build-bench')
    p.add_argument('--quick', action='store_true')
    p.add_argument('--only', type=names, default=['solvers', 'scenes', 'pictures', 'growth', 'adversary'])
    p.add_argument('--scene', type=names)
    p.add_argument('--path', type=names)
    p.add_argument('--size', type=int)
    p.add_argument('--rounds', type=int)
    p.add_argument('--no-peers', action='store_true')
    p.add_argument('--page', action='store_true')
    b = Bench(p.parse_args())
    parts = {'solvers': solvers_part, 'scenes': scenes_part, 'pictures': pictures_part, 'growth': growth_part, 'adversary': adversary_part}
    for name in b.args.only:
        if name not in parts:
            p.error('no part is called ' + name)
    for name in b.args.only:
        b.say(name)
        parts[name](b)
    partial = b.args.quick or b.args.scene or b.args.path or b.args.no_peers or len(b.args.only) < len(parts)
    page = os.path.join(HERE, '..', '..', 'docs', 'benchmarks.md') if not partial or b.args.page else os.path.join(b.results, 'benchmarks.md')
    page = os.path.normpath(page)
    report.write(b.results, page, ' '.join(['tools/bench'] + [a for a in sys.argv[1:] if a not in ('--build', b.args.build)]))
    b.say('wrote ' + os.path.relpath(page))


if __name__ == '__main__':
    main()
