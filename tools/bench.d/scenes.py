#!/usr/bin/env python3
"""Writes the scenes of the benchmarks.
usage: scenes.py --list | scenes.py DIR NAME...

Each scene becomes these files in DIR:
  NAME.csg      the model in quoin's language
  NAME.camera   one line: ortho o(3) u(3) v(3) d(3) W H; ray (i, j) of a W x H grid starts at o + (i+.5)/W u + (j+.5)/H v
  NAME.near     of a growth family: the same from so near that leaves keep their size in the picture
  NAME.flat     the same solid for programs that share no code with quoin's reader: a line for each leaf,
                  S centre r | B min size | C base axis h r     (numbers are the decimals of NAME.csg)
                then one line "T" and the tree in prefix order: a leaf's number, or u N or d N with N children after it
  NAME.pov      the same in POV-Ray's language, without camera and lights (scenes of up to POV_LEAVES leaves)

Names: the peer scenes (sphere1, plate1000, spheres10k, spheres1M, tree1024, tree1024fat, menger4, parts2000, plate100k, tree65k), `coplanar`
(a lattice of touching and flush boxes and cylinders), `part50` and `part50flush` (a part as people draw them) and the growth families
spheres-N, dense-N, plate-N, tree-N (N leaves) and menger-L (level L). Everything is drawn from splitmix64 with a fixed seed."""
import math
import os
import sys

POV_LEAVES = 20000
VIEW = [0.3, 0.4, -0.85]


class Random:  # splitmix64
    def __init__(self, seed):
        self.x = seed & (2**64 - 1)

    def u64(self):
        self.x = (self.x + 0x9E3779B97F4A7C15) & (2**64 - 1)
        z = self.x
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & (2**64 - 1)
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & (2**64 - 1)
        return z ^ (z >> 31)

    def f(self, a=0.0, b=1.0):
        return a + (b - a) * ((self.u64() >> 11) * 2.0**-53)

    def direction(self):
        z = self.f(-1, 1)
        p = self.f(0, 2 * math.pi)
        q = math.sqrt(1 - z * z)
        return [q * math.cos(p), q * math.sin(p), z]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def unit(a):
    length = math.sqrt(dot(a, a))
    return [x / length for x in a]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def ortho(lo, hi, d=VIEW, size=1024):
    """The rectangle is the projection of the box lo..hi on the plane perpendicular to d."""
    d = unit(d)
    up = [0, 0, 1] if abs(d[2]) < .9 else [0, 1, 0]
    u = unit(cross(d, up))
    v = cross(u, d)
    corners = [[(lo, hi)[(k >> a) & 1][a] for a in range(3)] for k in range(8)]
    us, vs, ds = ([dot(c, w) for c in corners] for w in (u, v, d))
    back = min(ds) - 1.0
    o = [u[k] * min(us) + v[k] * min(vs) + d[k] * back for k in range(3)]
    return o, [x * (max(us) - min(us)) for x in u], [x * (max(vs) - min(vs)) for x in v], d, size


class Scene:
    """leaves: ('S', cx, cy, cz, r), ('B', min(3), size(3)), ('C', base(3), axis(3), h, r); tree: a leaf's number or (op, children)."""

    def __init__(self, camera):
        self.leaves = []
        self.camera = camera
        self.tree = None

    def sphere(self, c, r):
        self.leaves.append(('S', *c, r))
        return len(self.leaves) - 1

    def box(self, lo, hi):
        self.leaves.append(('B', *lo, *[b - a for a, b in zip(lo, hi)]))
        return len(self.leaves) - 1

    def cylinder(self, base, axis, r):
        h = axis[2] if axis[0] == 0 and axis[1] == 0 and axis[2] > 0 else math.sqrt(dot(axis, axis))
        self.leaves.append(('C', *base, *axis, h, r))
        return len(self.leaves) - 1


def union_of_spheres(n, seed, radius, view=VIEW, lo=-1, hi=101):
    g = Random(seed)
    s = Scene(ortho([lo] * 3, [hi] * 3, view))
    s.tree = ('u', [s.sphere([g.f(0, 100) for _ in range(3)], radius(g)) for _ in range(n)])
    return s


def plate(nx, ny, size, r, poke, pitch):
    s = Scene(ortho([0, 0, 0], size))
    body = s.box([0, 0, 0], size)
    s.tree = ('d', [body] + [s.cylinder([pitch * (i + .5), pitch * (j + .5), -poke], [0, 0, size[2] + 2 * poke], r)
                             for j in range(ny) for i in range(nx)])
    return s


def random_leaf(s, g, q):
    kind = int(g.f(0, 3))
    c = [g.f(0, 100) for _ in range(3)]
    if kind == 0:
        return s.sphere(c, q * g.f(4, 10))
    if kind == 1:
        h = [q * g.f(3, 9) for _ in range(3)]
        return s.box([a - b for a, b in zip(c, h)], [a + b for a, b in zip(c, h)])
    d = g.direction()
    length = q * g.f(8, 20)
    r = q * g.f(3, 8)
    return s.cylinder([a - b * length / 2 for a, b in zip(c, d)], [b * length for b in d], r)


def balanced(first, n, depth=0):
    """Union at even depth, difference at odd depth."""
    if n == 1:
        return first
    return ('ud'[depth & 1], [balanced(first, n // 2, depth + 1), balanced(first + n // 2, n - n // 2, depth + 1)])


def tree(n, seed, q):
    g = Random(seed)
    s = Scene(ortho([-12] * 3, [112] * 3))
    for _ in range(n):
        random_leaf(s, g, q)
    s.tree = balanced(0, n)
    return s


def menger(level):
    """A box minus square holes: integer coordinates, every face coplanar with others."""
    side = 3**level
    s = Scene(ortho([0] * 3, [side] * 3))
    holes = []

    def drill(x, y, size, depth):
        c = size // 3
        for axis in range(3):
            lo, hi = [-1] * 3, [side + 1] * 3
            a, b = [(1, 2), (2, 0), (0, 1)][axis]
            lo[a], hi[a], lo[b], hi[b] = x + c, x + 2 * c, y + c, y + 2 * c
            holes.append(s.box(lo, hi))
        if depth < level:
            for i in range(3):
                for j in range(3):
                    if i != 1 or j != 1:
                        drill(x + i * c, y + j * c, c, depth + 1)

    body = s.box([0] * 3, [side] * 3)
    drill(0, 0, side, 1)
    s.tree = ('d', [body] + holes)
    return s


def parts(n, seed=20240005):
    """Nested: n parts of a plate minus (25 holes minus a sphere)."""
    g = Random(seed)
    s = Scene(ortho([-1] * 3, [106] * 3))
    every = []
    for _ in range(n):
        c = [g.f(0, 100) for _ in range(3)]
        body = s.box(c, [c[0] + 5, c[1] + 5, c[2] + 1])
        holes = [s.cylinder([c[0] + .5 + i, c[1] + .5 + j, c[2] - .1], [0, 0, 1.2], .3) for j in range(5) for i in range(5)]
        ball = s.sphere([c[0] + 2.5, c[1] + 2.5, c[2] + .5], 1.5)
        every.append(('d', [body, ('d', [('u', holes), ball])]))
    s.tree = ('u', every)
    return s


def coplanar(n=16):
    """A lattice of boxes of pitch 0.1 that share every face, minus cylinders flush with them, plus spheres that touch faces."""
    s = Scene(ortho([0] * 3, [n / 10] * 3))
    dec = lambda k: float('%d.%d' % (k // 10, k % 10))  # the decimal k/10
    keep, cut = [], []
    for i in range(n):
        for j in range(n):
            k = (i * 7 + j * 3) % n
            s.leaves.append(('B', dec(i), dec(j), 0.0, 0.1, 0.1, dec(k + 1)))
            keep.append(len(s.leaves) - 1)
            if (i + j) % 2:
                s.leaves.append(('C', dec(i) + .05 if i == 0 else float('%d.%d5' % (i // 10, i % 10)), float('%d.%d5' % (j // 10, j % 10)), 0.0,
                                 0, 0, 1, dec(k + 1), 0.03))
                cut.append(len(s.leaves) - 1)
            else:
                s.leaves.append(('S', float('%d.%d5' % (i // 10, i % 10)), float('%d.%d5' % (j // 10, j % 10)), float('%d.%d5' % ((k + 1) // 10, (k + 1) % 10)), 0.05))
                keep.append(len(s.leaves) - 1)
    s.tree = ('d', [('u', keep)] + cut)
    return s


def part50(poke=1):
    """A bracket of some 50 leaves: two plates, ribs, bosses with bores, rows of holes. Cuts stick out by `poke`, as other programs need it: with 0
    they are flush, which quoin cuts as cleanly, and POV-Ray does not cut at all."""
    s = Scene(ortho([0, 0, 0], [120, 80, 60], [0.5, 0.6, -0.6]))
    add = [s.box([0, 0, 0], [120, 80, 8]), s.box([0, 0, 0], [8, 80, 60])]
    add += [s.box([8, y, 8], [40, y + 6, 30]) for y in (0, 37, 74)]
    add += [s.cylinder([x, y, 8], [0, 0, 14], 9) for x in (60, 100) for y in (20, 60)]
    add += [s.cylinder([0, 40, 40], [20, 0, 0], 16), s.sphere([80, 40, 8], 14)]
    drill = lambda base, axis, r: s.cylinder([b - poke * (a > 0) for a, b in zip(axis, base)], [a + 2 * poke * (a > 0) for a in axis], r)
    cut = [drill([x, y, 0], [0, 0, 22], 5) for x in (60, 100) for y in (20, 60)]
    cut += [drill([0, 40, 40], [20, 0, 0], 10), s.sphere([80, 40, 8], 11), drill([80, 40, 0], [0, 0, 8], 4)]
    cut += [drill([10 + 10 * k, y, 0], [0, 0, 8], 2) for k in range(4, 11) for y in (6, 74)]
    cut += [drill([0, y, z], [8, 0, 0], 2.5) for y in (8, 72) for z in (16, 50)]
    cut += [s.box([50 + 15 * k, 35, -poke], [56 + 15 * k, 45, 3]) for k in range(4)]
    s.tree = ('d', [('u', add), ('u', cut)])
    return s


PEERS = {
    'sphere1': lambda: one_sphere(),
    'plate1000': lambda: plate(40, 25, [400, 250, 10], 3, 1, 10),
    'spheres10k': lambda: union_of_spheres(10000, 20240001, lambda g: g.f(.3, 1)),
    'spheres1M': lambda: union_of_spheres(1000000, 20240006, lambda g: .3 * g.f(.5, 1.5), [0.0, 0.0, -1.0]),
    'tree1024': lambda: tree(1024, 20240002, 1.0),
    'tree1024fat': lambda: tree(1024, 20240002, 3.0),
    'menger4': lambda: menger(4),
    'parts2000': lambda: parts(2000),
    'plate100k': lambda: plate(400, 250, [400, 250, 1], .3, .1, 1),
    'tree65k': lambda: tree(65536, 20240004, .25),
    'coplanar': coplanar,
    'part50': part50,
    'part50flush': lambda: part50(0),
}


def one_sphere():
    s = Scene(ortho([-50] * 3, [50] * 3))
    s.tree = s.sphere([0, 0, 0], 50)
    return s


def growth(name):
    family, n = name.split('-')
    n = int(n)
    if family == 'menger':
        return menger(n)
    small = (10000 / n)**(1 / 3)
    if family == 'spheres':
        return union_of_spheres(n, 20250001, lambda g: small * g.f(.3, 1), lo=-small, hi=100 + small)
    if family == 'dense': # a ray gets as deep, in leaves, into a million as into a thousand
        wide = 100 / n**(1 / 3)
        return union_of_spheres(n, 20250003, lambda g: wide * g.f(.3, 1), lo=0, hi=100)
    if family == 'tree':
        return tree(n, 20250002, (1024 / n)**(1 / 3))
    if family == 'plate':
        nx = max(1, round(math.sqrt(1.6 * (n - 1))))
        ny = max(1, round((n - 1) / nx))
        pitch = 400 / nx
        return plate(nx, ny, [400, pitch * ny, pitch], .3 * pitch, .1 * pitch, pitch)
    raise KeyError(name)


# How large a growth family's leaves are beside the whole scene, of n leaves (menger: level n), but for a factor.
LEAF = {'spheres': lambda n: n**(-1 / 3), 'dense': lambda n: n**(-1 / 3), 'plate': lambda n: n**-.5, 'tree': lambda n: n**(-1 / 3), 'menger': lambda n: 3.0**(9 - n)}


def near(name, camera):
    """The camera so near to the middle that leaves are as large in its picture as those of ten leaves (menger: of level 1) in the whole."""
    family, n = name.split('-')
    f = LEAF[family](int(n)) / LEAF[family](1 if family == 'menger' else 10)
    o, u, v, d, size = camera
    return [o[k] + (u[k] + v[k]) * (1 - f) / 2 for k in range(3)], [f * x for x in u], [f * x for x in v], d, size


def make(name):
    if name in PEERS:
        return PEERS[name]()
    try:
        return growth(name)
    except (KeyError, ValueError):
        raise SystemExit('scenes.py: no scene is called ' + name)


# --- writing ---------------------------------------------------------------------------------------------------------

def num(x):
    return repr(x)


def vec(v, brackets='[]'):
    return brackets[0] + ','.join(map(num, v)) + brackets[1]


def csg_leaf(leaf):
    kind, v = leaf[0], leaf[1:]
    if kind == 'S':
        return 'translate(%s) sphere(r=%s);' % (vec(v[:3]), num(v[3]))
    if kind == 'B':
        return 'translate(%s) cube(%s);' % (vec(v[:3]), vec(v[3:]))
    if v[3] == 0 and v[4] == 0 and v[5] > 0:
        return 'translate(%s) cylinder(h=%s,r=%s);' % (vec(v[:3]), num(v[6]), num(v[7]))
    return 'cylinder(base=%s,axis=%s,h=%s,r=%s);' % (vec(v[:3]), vec(v[3:6]), num(v[6]), num(v[7]))


def pov_leaf(leaf):
    kind, v = leaf[0], leaf[1:]
    if kind == 'S':
        return 'sphere{%s,%s}' % (vec(v[:3], '<>'), num(v[3]))
    if kind == 'B':
        return 'box{%s,%s}' % (vec(v[:3], '<>'), vec([a + b for a, b in zip(v[:3], v[3:])], '<>'))
    axis = [v[6] * x for x in unit(v[3:6])]
    return 'cylinder{%s,%s,%s}' % (vec(v[:3], '<>'), vec([a + b for a, b in zip(v[:3], axis)], '<>'), num(v[7]))


def write_tree(f, node, leaf, words, open_, depth=0):
    if not isinstance(node, tuple):
        f.write(leaf(node) + '\n')
        return
    op, children = node
    if words['merge'] and op == 'd' and len(children) > 2:
        children = [children[0], ('u', children[1:])]
    f.write(words[op] + open_ + '\n')
    for c in children:
        write_tree(f, c, leaf, words, open_, depth + 1)
    f.write('}\n')


def write_flat(f, node):
    if isinstance(node, tuple):
        f.write('%s %d\n' % (node[0], len(node[1])))
        for c in node[1]:
            write_flat(f, c)
    else:
        f.write('%d\n' % node)


def write(directory, name):
    s = make(name)
    base = os.path.join(directory, name)
    with open(base + '.csg', 'w') as f:
        write_tree(f, s.tree, lambda i: csg_leaf(s.leaves[i]), {'u': 'union', 'd': 'difference', 'merge': False}, '() {')
    cameras = {'camera': s.camera}
    if name.split('-')[0] in LEAF:
        cameras['near'] = near(name, s.camera)
    for ending, (o, u, v, d, size) in cameras.items():
        with open('%s.%s' % (base, ending), 'w') as f:
            f.write('ortho %s %d %d\n' % (' '.join(map(num, [*o, *u, *v, *d])), size, size))
    if len(s.leaves) <= POV_LEAVES:
        with open(base + '.pov', 'w') as f:
            node = s.tree if isinstance(s.tree, tuple) else ('u', [s.tree, s.tree])
            write_tree(f, node, lambda i: pov_leaf(s.leaves[i]), {'u': 'union', 'd': 'difference', 'merge': True}, ' {')
    with open(base + '.flat', 'w') as f: # last: its presence says that the scene is whole
        f.writelines('%s %s\n' % (leaf[0], ' '.join(map(num, leaf[1:]))) for leaf in s.leaves)
        f.write('T\n')
        write_flat(f, s.tree)


def main():
    if sys.argv[1:] == ['--list']:
        print('\n'.join(PEERS))
        return
    if len(sys.argv) < 3:
        raise SystemExit(__doc__)
    os.makedirs(sys.argv[1], exist_ok=True)
    for name in sys.argv[2:]:
        write(sys.argv[1], name)


if __name__ == '__main__':
    main()
