"""The page docs/benchmarks.md and its plots, from the CSV files of run.py."""
import csv
import math
import os
import re
import statistics
import subprocess

COLORS = ['#c0392b', '#e67e22', '#d4ac0d', '#7d6608', '#2471a3', '#1e8449', '#145a32', '#7d3c98', '#34495e', '#17a589']


def read(results, name):
    path = os.path.join(results, name + '.csv')
    if not os.path.exists(path):
        return []
    with open(path, newline='') as f:
        return list(csv.DictReader(f))


def number(text):
    try:
        return float(text)
    except (TypeError, ValueError):
        return math.nan


def short(x, digits=3):
    """Three significant digits, plainly."""
    if x != x:
        return '-'
    if x == 0:
        return '0'
    if abs(x) >= 1e5 or abs(x) < 1e-3:
        return ('%.*g' % (max(1, digits - 1), x)).replace('e+0', 'e').replace('e+', 'e').replace('e-0', 'e-')
    return '%.*f' % (max(0, digits - 1 - math.floor(math.log10(abs(x)))), x)


def table(head, rows):
    out = ['| ' + ' | '.join(head) + ' |', '|' + ' --- |' * len(head)]
    return '\n'.join(out + ['| ' + ' | '.join(map(str, r)) + ' |' for r in rows]) + '\n'


def unique(rows, key):
    return list(dict.fromkeys(r[key] for r in rows))


# --- plots -----------------------------------------------------------------------------------------------------------

def plot(folder, name, title, x, y, series, settings=''):
    """series: (label, [(x, y)], style) with style 'points' or 'linespoints'."""
    series = [(label, [(a, b) for a, b in points if a == a and b == b], style) for label, points, style in series]
    series = [s for s in series if s[1]]
    if not series:
        return None
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, name + '.svg')
    script = ['set terminal svg size 760,480 font "sans-serif,13" background "white"', 'set output "%s"' % path, 'set title "%s"' % title, 'set xlabel "%s"' % x,
              'set ylabel "%s"' % y, 'set grid lc rgb "#dddddd"', 'set key outside right top', 'set border lc rgb "#666666"', settings]
    parts = ['"-" with %s title "%s" lc rgb "%s" pt 7 ps 0.55 lw 1.6' % (style, label, COLORS[i % len(COLORS)])
             for i, (label, _, style) in enumerate(series)]
    script.append('plot ' + ', '.join(parts))
    for _, points, _ in series:
        script += ['%g %g' % p for p in points] + ['e']
    subprocess.run(['gnuplot'], input='\n'.join(script) + '\n', text=True, check=True, stderr=subprocess.DEVNULL)
    with open(path) as f: # fewer bytes: comments and empty lines say nothing
        text = f.read()
    with open(path, 'w') as f:
        f.write('\n'.join(line for line in re.sub(r'<!--.*?-->', '', text, flags=re.S).split('\n') if line.strip()) + '\n')
    return path


def shown(path, page):
    return '![](%s)\n' % os.path.relpath(path, os.path.dirname(page)) if path else ''


# --- parts of the page -----------------------------------------------------------------------------------------------

def solvers(results, plots, page):
    rows = read(results, 'solvers')
    if not rows:
        return ''
    families, ways = unique(rows, 'family'), unique(rows, 'way')
    at = {(r['family'], r['way']): r for r in rows}
    floor = 0.05 # ulps: exact answers have a place on a logarithmic axis
    path = plot(plots, 'solvers', 'One quadric along one line: time against error (a point a family)', 'ns a solve', 'median error, ulps',
                [(w, [(number(at[f, w]['ns']), max(floor, number(at[f, w]['median_ulps']))) for f in families], 'points') for w in ways],
                'set logscale xy\nset format y "10^{%L}"\nset yrange [0.03:*]')

    def cell(r):
        text = short(number(r['median_ulps']))
        wrong, orders = number(r['wrong_counts_per_million']), number(r['wrong_orders_per_million'])
        notes = (['%s counts' % short(wrong)] if wrong > 0 else []) + (['%s orders' % short(orders)] if orders > 0 else [])
        return text + (' (%s)' % ', '.join(notes) if notes else '')

    text = '## Solvers\n\nThe roots of one quadric along one line, scalar code, six kinds of quadrics, %s cases a family. The truth is taken in rationals.\n' % rows[0]['cases']
    text += 'An order is that of the first roots of a solid and of its copy, moved along the line by 2^-20 to 2^-50 of the distance.\n\n'
    text += shown(path, page) + '\nMedian error of a root in ulps, where the count of roots was right (in brackets: wrong counts of roots and wrong orders of two roots, per million).\n\n'
    text += table(['family'] + ways, [[f] + [cell(at[f, w]) for w in ways] for f in families])
    text += '\nLargest error in ulps.\n\n' + table(['family'] + ways, [[f] + [short(number(at[f, w]['largest_ulps'])) for w in ways] for f in families])
    text += '\nNanoseconds a solve (last column: the share of solves that quoin took in exact arithmetic).\n\n'
    ours = 'quoin, rounded'
    text += table(['family'] + ways + ['exact share'], [[f] + [short(number(at[f, w]['ns'])) for w in ways] + [short(number(at[f, ours]['exact_share']))] for f in families])
    text += '\n"quoin, decided" is what decides: counts and orders are exact, t is near. "quoin, rounded" also rounds every root to the nearest double.\n'
    return text


TOO_WRONG = 0.01 # a peer that errs more often than this gets no rate


def rate_cell(r):
    """Of quoin, whose answers must all be right."""
    if r is None:
        return ''
    wrong = number(r['oracle_wrong'] or 0) + number(r['wrong'] or 0)
    rate = number(r['mrays'])
    return short(rate) if rate == rate and not wrong else 'WRONG'


def peer_cell(r):
    if r is None:
        return ''
    rate, judged, wrong = number(r['mrays']), number(r['oracle_judged'] or 0), number(r['oracle_wrong'] or 0)
    if rate != rate:
        return 'no answer in time'
    if not judged:
        return '%s (not judged)' % short(rate)
    share = '%s a million of %d' % (short(1e6 * wrong / judged), judged)
    return 'wrong: ' + share if wrong / judged > TOO_WRONG else '%s (%s)' % (short(rate), share if wrong else '0 of %d' % judged)


def peer_rate(r):
    """The rate that ratios may be taken of."""
    judged = number(r['oracle_judged'] or 0) if r else 0
    return number(r['mrays']) if r and not (judged and number(r['oracle_wrong'] or 0) / judged > TOO_WRONG) else math.nan


def scenes(results, plots, page):
    rows = read(results, 'scenes')
    if not rows:
        return ''
    names = unique(rows, 'scene')
    at = {(r['scene'], r['path']): r for r in rows}
    paths = [p for p in unique(rows, 'path')]
    peers = [p for p in paths if p.startswith('embree') or p == 'povray']
    ours = [p for p in paths if p not in peers and not p.startswith(('checked-', 'unchecked-'))]
    text = '## Scenes\n\nMillion rays (or points) a second on one core, from camera to hit record, median of the rounds; the programs took turns, and within a program the paths, ten each in a round. Every ratio of two of them is the median of the rounds\' ratios. '
    text += 'The paths: `single` one call a ray, `rows` and `tiles` arrays in blocks of 64 x 64 pixels, `grid` the grid call (`grid-t`: with t rounded correctly), '
    text += '`intervals` all stretches of a ray, arrays of tiles (`grid-intervals` by the grid call), `intervals-exact` the same with the filter off, `shadow` from what the camera sees to a light, `random` incoherent rays. '
    text += 'Every path was judged first: against the other paths, byte by byte, and against an oracle that shares no code with the library (640 bits, every leaf). '
    text += 'A path with a wrong answer would show no rate.\n\n'
    text += table(['scene'] + ours, [[n] + [rate_cell(at.get((n, p))) for p in ours] for n in names])
    judged = sum(number(r['judged'] or 0) for r in rows if r['path'] in ours)
    oracle = sum(number(r['oracle_judged'] or 0) for r in rows if r['path'] in ours)
    wrong = sum(number(r['wrong'] or 0) + number(r['oracle_wrong'] or 0) for r in rows if r['path'] in ours)
    text += '\nWrong answers of quoin: %d of %d compared between paths and %d judged by the oracle.\n' % (wrong, judged, oracle)
    if peers:
        text += '\n### Beside other programs\n\nEmbree 3 (single precision, sphere points, packets from the same grid, blocks and order) and POV-Ray 3.7 (its own '
        text += '"Trace Time", one thread, without start, parsing and output; a white picture without shading). In brackets: their wrong first hits, and how many were judged; where more than a hundredth is wrong there is no rate. '
        text += 'A hit counts as wrong when there is none, or the reverse, or when it lies elsewhere by more than a thousandth (of the smallest radius for Embree, of the depth of the scene for POV-Ray). '
        text += 'Ratios are of quoin\'s `grid` and `grid-t`.\n\n'

        def ratio(n, mine, theirs):
            best = max([at[n, p] for p in theirs if peer_rate(at.get((n, p))) > 0], key=peer_rate, default=None)
            return short(times(at.get((n, mine)), best)) if (n, mine) in at else ''

        body = []
        packets = ['embree-packet16', 'embree-packet8']
        for n in names:
            if any((n, p) in at for p in peers):
                body.append([n] + [peer_cell(at.get((n, p))) for p in peers] + [ratio(n, 'grid', packets), ratio(n, 'grid-t', packets), ratio(n, 'grid', ['povray']), ratio(n, 'grid-t', ['povray'])])
        text += table(['scene'] + peers + ['grid / Embree packets', 'grid-t / Embree packets', 'grid / POV-Ray', 'grid-t / POV-Ray'], body)
    text += exactness(results, at, names)
    text += '\n### Counters\n\nA ray (or point): nodes visited, leaves solved, decisions certified by doubles; and a million rays: signs and orders taken exactly, rays handed to the exact path, roundings taken exactly. '
    text += 'A node or leaf that a packet of 64 meets counts once.\n\n'
    million = lambda r, k: short(1e6 * number(r[k]))
    body = [[n, p, short(number(r['nodes'])), short(number(r['leaves'])), short(number(r['sure'])), million(r, 'exact_signs'), million(r, 'exact_orders'),
             million(r, 'exact_rays'), million(r, 'exact_roundings')]
            for n in names for p in ('grid', 'grid-t', 'intervals', 'grid-intervals', 'shadow', 'random', 'points') for r in [at.get((n, p))] if r and r['nodes']]
    text += table(['scene', 'path', 'nodes', 'leaves', 'sure', 'signs', 'orders', 'exact rays', 'roundings'], body)
    return text


def exactness(results, at, names):
    """What certainty costs, and the exact tier's share of the time."""
    text = ''
    paths = [p[len('unchecked-'):] for p in unique([dict(p=k[1]) for k in at], 'p') if p.startswith('unchecked-')]
    if paths:
        text += '\n### What certainty costs\n\nTimes the time of the same path built without error bounds (`bench_unchecked`, whose answers may be wrong): in packets, and one by one.\n\n'
        text += table(['scene'] + paths, [[n] + [short(certainty(at, n, p)) for p in paths] for n in names])
    rows = read(results, 'exact')
    if rows:
        by = {(r['scene'], r['path']): r for r in rows}
        paths = unique(rows, 'path')
        percent = lambda r, k: short(100 * number(r[k]), 2) if r else ''
        text += '\n### The exact tier\n\nPercent of the time in exact arithmetic (integers: exact forms, quadratics, roots, cells). In brackets, where there are any: percent of the time in rays and points '
        text += 'that doubles in packets did not decide and that were answered one by one, that arithmetic included. A program with a clock at every way into these measured it (`bench_exact`), after what is made '
        text += 'but once for each surface had been made.\n\n'
        cell = lambda r: percent(r, 'exact_share') + (' (%s)' % percent(r, 'woven_share') if r and number(r['woven_share']) > 0 else '')
        text += table(['scene'] + paths, [[n] + [cell(by.get((n, p))) for p in paths] for n in unique(rows, 'scene')])
    return text


def times(mine, theirs):
    """How many times as fast: the median of the rounds' ratios, in each of which both ran; nan where there is no rate."""
    if not peer_rate(mine) > 0 or not peer_rate(theirs) > 0:
        return math.nan
    a, b = ([number(x) for x in (r.get('turns') or r['mrays']).split()] for r in (mine, theirs))
    return statistics.median(x / y for x, y in zip(a, b)) if len(a) == len(b) else number(mine['mrays']) / number(theirs['mrays'])


def certainty(at, scene, path):
    """How many times the unchecked path's time the path takes."""
    return times(at.get((scene, 'unchecked-' + path)), at.get((scene, 'checked-' + path)) or at.get((scene, path)))


def pictures(results, plots, page):
    rows = read(results, 'pictures')
    commands = read(results, 'commands')
    text = ''
    if rows:
        text += '## Pictures\n\nTime (one thread, without reading and writing) against the error of the picture: the root of the mean square difference of sRGB values (0 to 1) to a reference '
        text += 'with 32 x 32 samples in every pixel (16 x 16 in a quick run). Both programs draw the same white solid, sun and shadows: without antialiasing their pictures have the same error.\n\n'
        for n in unique(rows, 'scene'):
            mine = [r for r in rows if r['scene'] == n]
            point = lambda r: (number(r['seconds']), number(r['rms']))
            series = [('quoin', [point(r) for r in mine if r['program'] == 'quoin'], 'linespoints')]
            series += [('POV-Ray, fixed', [point(r) for r in mine if r['program'] == 'POV-Ray' and 'recursive' not in r['setting']], 'linespoints')]
            series += [('POV-Ray, recursive', [point(r) for r in mine if r['program'] == 'POV-Ray' and 'recursive' in r['setting']], 'linespoints')]
            text += shown(plot(plots, 'pictures-' + n, n + ': time against error of the picture', 'seconds', 'rms error', series, 'set logscale xy'), page) + '\n'
            text += table(['scene', 'program', 'setting', 'seconds', 'rms error'],
                          [[n, r['program'], r['setting'].replace('_', ' '), short(number(r['seconds'])), short(number(r['rms']))] for r in mine]) + '\n'
    if commands:
        text += 'Whole commands, from start to written PNG: `part50` at 800 x 600 with shadows and antialiasing (16 samples where neighbours differ), all cores.\n\n'
        text += table(['program', 'threads', 'seconds'], [[r['program'], r['threads'], short(number(r['seconds']))] for r in commands])
    lines = read(results, 'text')
    if lines:
        text += '\nQuestions as text (decimals with six places), a file read and the answers written to a file; start and compilation taken off.\n\n'
        text += table(['command', 'scene', 'threads', 'lines', 'million lines a second'], [[r['command'], r['scene'], r['threads'], r['lines'], short(number(r['mlines']))] for r in lines])
    return text


def family(name):
    return name.split('-')[0]


def drawn(name):
    """Leaves that the model of a growing family has; not those that the compiled scene keeps."""
    return 1 + 3 * (8**int(name.split('-')[1]) - 1) // 7 if name.startswith('menger') else int(name.split('-')[1])


def over_logarithm(rows, answers=lambda r: 1):
    """How many times more the cost of a ray, or of one of its answers, grows than the logarithm of the leaves: from the smallest size to where that is most."""
    points = sorted((drawn(r['scene']), 1 / number(r['mrays']) / answers(r)) for r in rows)
    n0, cost0 = points[0]
    return max(((cost / cost0) / (math.log(n) / math.log(n0)) for n, cost in points[1:]), default=math.nan)


def adversary(results):
    rows = read(results, 'adversary')
    if not rows:
        return ''
    text = '## Trees made to hurt\n\nNanoseconds of processor time a ray on one thread, beside solving just the leaves that it meets; in turn, medians. `bench_adversary --help` and the head of its source name the families. '
    text += 'Of the rays judged, none was answered wrongly where the last column says 0.\n\n'
    return text + table(['family', 'leaves', 'bytes a leaf', 'leaves met', 'solving them, ns', 'first hit, ns', 'times', 'all intervals, ns', 'times', 'wrong'],
                        [[r['family'], r['leaves'], r['bytes_a_leaf'], short(number(r['met'])), short(number(r['solve_ns'])), short(number(r['first_ns'])), short(number(r['first_times'])),
                          short(number(r['all_ns'])), short(number(r['all_times'])), '%s of %s' % (r['wrong'], r['judged'])] for r in rows])


def growth(results, plots, page):
    rows, build, threads = read(results, 'growth'), read(results, 'build'), read(results, 'threads')
    text = ''
    if rows:
        families = list(dict.fromkeys(family(r['scene']) for r in rows))
        rate = lambda r: 1e3 / number(r['mrays'])
        text += '## Growth\n\nThe cost of a ray against the number of leaves: a union of spheres that fill a small part of space (`spheres`: a ray passes ever more of them before it hits one) or most of it (`dense`: it hits the second or third), '
        text += 'a plate minus holes, a balanced random tree, a Menger sponge; 512 x 512 rays over the whole scene, so that leaves become smaller than a pixel, '
        text += 'and from so near that leaves keep their size in pixels (`-near`).\n\n'
        for p, title in (('grid', 'camera rays in packets'), ('grid-near', 'camera rays in packets, leaves of one size in pixels'), ('single', 'camera rays one by one'), ('random', 'incoherent rays')):
            series = [(f, [(drawn(r['scene']), rate(r)) for r in rows if family(r['scene']) == f and r['path'] == p], 'linespoints') for f in families]
            text += shown(plot(plots, 'growth-' + p, 'Growth: ' + title, 'leaves', 'ns a ray', series, 'set logscale x\nset yrange [0:*]'), page)
        paths = unique(rows, 'path')
        text += '\nNanoseconds a ray (or point).\n\n'
        by = {(r['scene'], r['path']): r for r in rows}
        text += table(['scene', 'leaves kept', 'leaves met'] + paths, [[n, by[n, paths[0]]['leaves_kept'], short(number(by[n, paths[0]].get('met')))] +
                                                                      [short(rate(by[n, p])) if (n, p) in by else '' for p in paths] for n in unique(rows, 'scene')])
        text += '\n*Leaves met*: how many leaves one of these camera rays runs through, from its beginning to its end. A first hit need not look at all of them, all intervals must.\n'
        if build:
            series = [('%s, %s thread%s' % (f, t, '' if t == '1' else 's'), [(drawn(r['scene']), number(r['compile_s'])) for r in build if family(r['scene']) == f and r['build_threads'] == t], 'linespoints')
                      for f in families for t in unique(build, 'build_threads')]
            text += '\n' + shown(plot(plots, 'build', 'Building a scene', 'leaves', 'seconds', series, 'set logscale xy'), page)
            text += '\nBuilding: seconds to read the text and to compile it, and the bytes the scene takes.\n\n'
            text += table(['scene', 'threads', 'leaves kept', 'read, s', 'compile, s', 'bytes a leaf'],
                          [[r['scene'], r['build_threads'], r['leaves'], short(number(r['read_s'])), short(number(r['compile_s'])), short(number(r['bytes']) / max(1, number(r['leaves'])))] for r in build])
    if threads:
        names, paths = unique(threads, 'scene'), unique(threads, 'path')
        by = {(r['scene'], r['path'], int(r['threads'])): number(r['mrays']) for r in threads}
        counts = sorted({int(r['threads']) for r in threads})
        series = [('%s, %s' % (n, p), [(t, by.get((n, p, t), math.nan) / by.get((n, p, 1), math.nan)) for t in counts], 'linespoints') for n in names for p in paths]
        text += '\n## Threads\n\n' + shown(plot(plots, 'threads', 'Speed-up by threads', 'threads', 'times one thread', series, 'set xtics 1\nset yrange [0:*]'), page)
        text += '\nMillion rays a second.\n\n' + table(['scene', 'path'] + ['%d' % t for t in counts], [[n, p] + [short(by.get((n, p, t), math.nan)) for t in counts] for n in names for p in paths])
    return text


FLUSH = ('coplanar', 'menger4', 'part50flush') # full of coincident faces


def goals(results):
    """The goals that these measurements can judge."""
    at = {(r['scene'], r['path']): r for r in read(results, 'scenes')}
    get = lambda n, p: peer_rate(at.get((n, p)))
    ratio = lambda n, p, q: times(at.get((n, p)), at.get((n, q)))
    embree = lambda n: max(('embree-packet16', 'embree-packet8'), key=lambda p: get(n, p) if get(n, p) > 0 else 0)
    rows = []

    def goal(what, reached, wanted):
        if reached == reached:
            rows.append([what, short(reached), short(wanted), 'yes' if reached >= wanted else 'no'])

    def most(what, reached, wanted):
        if reached == reached:
            rows.append([what, short(reached), 'at most ' + short(wanted), 'yes' if reached <= wanted else 'no'])

    for n, wanted in (('sphere1', 10), ('spheres10k', 6), ('spheres1M', 4)):
        goal('%s: `grid`, times Embree\'s packets' % n, ratio(n, 'grid', embree(n)), wanted)
        goal('%s: `grid-t`, every t correctly rounded, times Embree\'s packets' % n, ratio(n, 'grid-t', embree(n)), wanted)
    for n, wanted in (('sphere1', 40), ('spheres10k', 40), ('tree1024', 1000)):
        goal('%s: `grid`, times POV-Ray' % n, ratio(n, 'grid', 'povray'), wanted)
        goal('%s: `grid-t`, every t correctly rounded, times POV-Ray' % n, ratio(n, 'grid-t', 'povray'), wanted)
    for n in unique(read(results, 'scenes'), 'scene'):
        goal('%s: all intervals (`grid-intervals`), share of the first-hit rate (`grid-t`)' % n, ratio(n, 'grid-intervals', 'grid-t'), 0.5)
        goal('%s: the same as arrays (`intervals`)' % n, ratio(n, 'intervals', 'grid-t'), 0.5)
        goal('%s: shadow rays (`blocked`), share of camera rays' % n, ratio(n, 'blocked', 'grid'), 0.25)
        goal('%s: shadow rays as first hits, share of camera rays' % n, ratio(n, 'shadow', 'grid'), 0.25)
        goal('%s: incoherent rays as arrays, times the single path' % n, ratio(n, 'random', 'random-single'), 1)
        goal('%s: the same as spots' % n, ratio(n, 'random-spots', 'random-spots-single'), 1)
    goal('menger4: all intervals (`grid-intervals`), million a second', get('menger4', 'grid-intervals'), 10)
    goal('spheres10k: points, million a second', get('spheres10k', 'points'), 20)
    for r in read(results, 'growth'):
        if r['scene'] == 'plate-10000' and r['path'] == 'points':
            goal('plate-10000: points, million a second', peer_rate(r), 20)
    for n in unique(read(results, 'scenes'), 'scene'):
        most('%s: `grid`, times the same without error bounds' % n, certainty(at, n, 'grid'), 1.3)
        most('%s: `single`, times the same without error bounds' % n, certainty(at, n, 'single'), 1.3)
    exact = read(results, 'exact')
    for n in unique(exact, 'scene'):
        worst = max((r for r in exact if r['scene'] == n), key=lambda r: number(r['exact_share']))
        if number(worst['exact_share']) > 0:
            most('%s: percent of the time in exact arithmetic, most (`%s`)' % (n, worst['path']), 100 * number(worst['exact_share']), 5 if n in FLUSH else 1)
        else:
            most('%s: percent of the time in exact arithmetic, on every path' % n, 0, 5 if n in FLUSH else 1)
    for r in read(results, 'adversary'):
        if r['wrong'] == '0':
            most('%s: first hit, times solving the leaves that the ray meets' % r['family'], number(r['first_times']), 4)
            most('%s: all intervals, times solving the leaves that the ray meets' % r['family'], number(r['all_times']), 4)
    grown = read(results, 'growth')
    for f in list(dict.fromkeys(family(r['scene']) for r in grown)):
        for p in unique(grown, 'path'):
            sizes = [r for r in grown if family(r['scene']) == f and r['path'] == p]
            if len(sizes) > 1:
                least, largest = min(drawn(r['scene']) for r in sizes), max(drawn(r['scene']) for r in sizes)
                if p == 'grid-intervals': # its answer grows: so for each stretch, the ray itself counted as one
                    most('%s, `%s`: growth of the cost of a stretch from %d to %d leaves, times the logarithm\'s' % (f, p, least, largest),
                         over_logarithm(sizes, lambda r: 1 + number(r['met'])), 1)
                    continue
                most('%s, `%s`: growth of the cost from %d to %d leaves, times the logarithm\'s' % (f, p, least, largest), over_logarithm(sizes), 1)
    build = [r for r in read(results, 'build') if r['scene'] == 'spheres-1000000' and r['build_threads'] != '1']
    if build:
        goal('1,000,000 spheres: compiled, times a second', 1 / number(build[0]['compile_s']), 1)
    whole = {r['program']: number(r['seconds']) for r in read(results, 'commands')}
    if 'quoin render' in whole:
        goal('part50 as a whole command: times 40 ms', 0.04 / whole['quoin render'], 1)
        goal('part50 as a whole command: times faster than POV-Ray', whole.get('povray', math.nan) / whole['quoin render'], 10)
    best = {}
    for r in read(results, 'text'):
        if r['threads'] != '1':
            continue
        best[r['command']] = max(best.get(r['command'], 0), number(r['mlines']))
    for command, wanted in (('quoin query', 2), ('quoin ray', 1)):
        goal('`%s` from text, one thread, million lines a second' % command, best.get(command, math.nan), wanted)
    return '## Goals\n\n' + table(['what', 'reached', 'goal', 'met'], rows) if rows else ''


def machine():
    name = 'unknown'
    try:
        with open('/proc/cpuinfo') as f:
            text = f.read()
        name = re.search(r'model name\s*:\s*(.*)', text).group(1)
        flags = re.search(r'flags\s*:\s*(.*)', text).group(1).split()
        name += ', ' + ('AVX-512' if 'avx512f' in flags else 'AVX2' if 'avx2' in flags else 'SSE2')
    except (OSError, AttributeError):
        pass
    return '%s, %d cores' % (name, os.cpu_count() or 1)


def write(results, page, command):
    plots = os.path.join(os.path.dirname(page), 'benchmarks')
    text = '# Benchmarks\n\nWritten by `%s`; do not edit. Machine: %s. What carries from one machine to another are the ratios of one run.\n\n' % (command, machine())
    parts = [goals(results), scenes(results, plots, page), solvers(results, plots, page), pictures(results, plots, page), growth(results, plots, page), adversary(results)]
    text += '\n'.join(p for p in parts if p)
    os.makedirs(os.path.dirname(page), exist_ok=True)
    with open(page, 'w') as f:
        f.write(text)
