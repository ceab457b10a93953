"""POV-Ray on the scenes of scenes.py: rays a second by its own "Trace Time" (start, parsing, bounding and output are not counted, which favours
it), and the depth that each pixel shows, read from a 16-bit picture whose colour is the distance along the view."""
import array
import math
import os
import re
import subprocess
import time


def camera_of(path):
    words = open(path).read().split()
    v = [float(x) for x in words[1:13]]
    return v[0:3], v[3:6], v[6:9], v[9:12]


def vector(a):
    return '<%s>' % ','.join(repr(x) for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def scene_text(base, depth):
    """The whole scene; depth: None for a white picture, else (nearest, farthest) along the view from the camera's plane."""
    o, u, v, d = camera_of(base + '.camera')
    middle = [o[i] + u[i] / 2 + v[i] / 2 for i in range(3)]
    text = '#version 3.7; global_settings{assumed_gamma 1}\n'
    text += 'camera{orthographic location %s direction %s right %s up %s}\n' % tuple(map(vector, (middle, d, u, v)))
    if depth is None:
        pigment = 'pigment{rgb 1}'
    else:
        text += 'background{rgb <1,0,0>}\n'
        # `gradient` repeats after its vector's length; the pattern is moved so that the nearest depth is 0 and the farthest is just under 1.
        low, high = depth
        start = [o[i] + low * d[i] for i in range(3)]
        pigment = 'pigment{gradient %s color_map{[0 rgb 0][1 rgb <0,1,1>]} scale %r translate %s}' % (vector(d), high - low, vector(start))
    text += '#default{texture{%s finish{ambient 1 diffuse 0}}}\n' % pigment
    return text + '#include "%s.pov"\n' % os.path.basename(base)


def seconds_in(output, what):
    m = re.search(what + r':.*\((\d+\.\d+) seconds\)', output)
    return float(m.group(1)) if m else math.inf


def run(base, text, size, picture, limit):
    """Trace time in seconds, or None when it took longer than `limit`."""
    control = base + '.run.pov'
    with open(control, 'w') as f:
        f.write(text)
    command = ['povray', '+I' + os.path.basename(control), '+W%d' % size, '+H%d' % size, '-A', '+WT1', '-D', '-V', '+L' + os.path.dirname(base)]
    command += ['+O' + os.path.basename(picture), '+FP16', 'File_Gamma=1.0'] if picture else ['-F']
    try:
        done = subprocess.run(command, cwd=os.path.dirname(base), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return None
    if done.returncode != 0:
        raise SystemExit('povray failed on %s:\n%s' % (base, done.stdout[-2000:]))
    return seconds_in(done.stdout, 'Trace Time')


def rays_a_second(base, seconds, limit=60, most=1024, size=64):
    """(rays a second, rays), growing the picture until a run takes `seconds`; None when not even 16 x 16 rays end in time."""
    best = None
    while True:
        spent = run(base, scene_text(base, None), size, None, limit)
        if spent is None:
            if size > 16 and best is None:
                size = 16
                continue
            return best
        best = size * size / max(spent, 1e-3), size * size
        if spent >= seconds or size >= most or size < 64:
            return best
        size *= 2 if spent * 4 > seconds / 2 else 4


def read_ppm16(path):
    data = open(path, 'rb').read()
    at, words = 0, []
    while len(words) < 4:
        end = at
        if data[at:at + 1] == b'#':
            at = data.index(b'\n', at) + 1
            continue
        while not data[end:end + 1].isspace():
            end += 1
        words.append(data[at:end])
        at = end + 1
    assert words[0] == b'P6' and words[3] == b'65535', words
    values = array.array('H', data[at:])
    values.byteswap()
    return int(words[1]), int(words[2]), values


def judge(base, size, depths, limit=120):
    """Wrong first hits among size x size: (wrong, judged), or None. depths: the right parameters, row-major from the picture's bottom row on, infinite
    for a miss. Wrong: hit for miss or the other way round, or a depth off by more than a thousandth of the scene's range of depths. Pixels next
    to one of another kind or depth are left out: there, POV-Ray's rounding of the camera would decide."""
    seen = [t for t in depths if t < math.inf]
    if not seen:
        return None
    low, high = min(seen), max(seen)
    pad = max((high - low) * 0.05, 1e-6)
    low, high = low - pad, high + pad
    picture = base + '.depth.ppm'
    if run(base, scene_text(base, (low, high)), size, picture, limit) is None:
        return None
    w, h, values = read_ppm16(picture)
    os.remove(picture)
    codes = [-1 if t == math.inf else (t - low) / (high - low) for t in depths]
    wrong = judged = 0
    for y in range(1, h - 1):
        for x in range(1, w - 1):
            k = y * w + x
            right = codes[k]
            around = (codes[k - 1], codes[k + 1], codes[k - w], codes[k + w])
            if any((c < 0) != (right < 0) or abs(c - right) > 0.02 for c in around):
                continue
            p = 3 * ((h - 1 - y) * w + x)
            red, green = values[p], values[p + 1]
            judged += 1
            hit = red < 30000
            wrong += hit != (right >= 0) or (hit and abs(green / 65535 - right) > 1e-3)
    return wrong, judged


def picture_size(base, width):
    """Square pixels: as bench_pictures computes it."""
    _, u, v, _ = camera_of(base + '.camera')
    return width, int(width * math.sqrt(dot(v, v)) / math.sqrt(dot(u, u)) + 0.5)


def picture_text(base, width, height, light):
    """White, ambient 0.1, diffuse 0.9, one sun with shadows; the same as the model that run.py writes for quoin."""
    o, u, v, d = camera_of(base + '.camera')
    middle = [o[i] + u[i] / 2 + v[i] / 2 for i in range(3)]
    lu, lv = math.sqrt(dot(u, u)), math.sqrt(dot(v, v))
    right = [x / lu * (lv / height * width) for x in u]
    sun = [middle[i] - 1e4 * light[i] for i in range(3)]
    text = '#version 3.7; global_settings{assumed_gamma 1}\nbackground{rgb 0}\n'
    text += 'camera{orthographic location %s direction %s right %s up %s}\n' % tuple(map(vector, (middle, d, right, v)))
    text += 'light_source{%s rgb 1 parallel point_at %s}\n' % (vector(sun), vector(middle))
    text += '#default{texture{pigment{rgb 1} finish{ambient 0.1 diffuse 0.9}}}\n#include "%s.pov"\n' % os.path.basename(base)
    return text


def render(base, text, width, height, settings, threads, output, limit):
    """(trace seconds, seconds of the whole command), or None. settings: options of antialiasing."""
    control = base + '.run.pov'
    with open(control, 'w') as f:
        f.write(text)
    kind = '+FN8' if output.endswith('.png') else '+FP8'
    command = ['povray', '+I' + os.path.basename(control), '+W%d' % width, '+H%d' % height, '+WT%d' % threads, '-D', '-V', '-J', kind,
               '+O' + output] + settings
    begin = time.monotonic()
    try:
        done = subprocess.run(command, cwd=os.path.dirname(base), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return None
    if done.returncode != 0:
        raise SystemExit('povray failed on %s:\n%s' % (base, done.stdout[-2000:]))
    return seconds_in(done.stdout, 'Trace Time'), time.monotonic() - begin
