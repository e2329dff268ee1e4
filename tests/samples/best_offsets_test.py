"""predict --offsets against a search of its own, on the samples.

    best_offsets_test.py COUNTERFLEX SAMPLES_FOLDER

The work offset is moved, the program is predicted with it, and the deviation from the path that was wanted before
is the deviation of the prediction and the motion of the wanted place. Predictions with each number of the offset
moved alone give a linear model. Lawson's algorithm minimises its largest deviation: weights grow where the deviation
is large, and the weighted least squares are a lower bound of what any shift leaves. A prediction with the shift found
is the deviation that it leaves. Nothing of the product's search is used. The lower bound, the deviation left and the
product's must agree to 0.1 um, and no prediction with a number moved by 1 um may leave less than the product.
"""
import csv
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

AGREEMENT_MM = 1e-4
PROBE = 1e-3  # mm; a thousandth of a degree for angles


class Sample:
    """A program, its options, and the numbers of its offset: `work` names the offset of --work."""

    def __init__(self, folder, program, machine, forces, work='G54', start=(0, 0, 0), **more):
        self.folder, self.program, self.machine, self.forces = folder, program, machine, forces
        self.work, self.start = work, list(start)
        self.frame_in_program = more.get('frame_in_program')  # a pattern: the numbers are in the program
        self.beside = more.get('beside', ())  # files that the program reads
        self.tools = more.get('tools', ())  # a pattern of the change of tool for each but the first
        self.holes = set(more.get('holes', ()))  # lines of cycles

    def count(self):
        return len(self.start) + len(self.tools)


MILL = '../mill3/machine.toml'
IN_MILL = (150, 100, -240)
CONSTANT = ['--force=60,-30,-40']
FORCE_OF_ROBOT = ['--force=5,-4,-3']  # one that turns with the path would turn with the base in the comparison
SAMPLES = [
    Sample('mill3', 'pocket.ngc', 'machine.toml', ['-f', 'cutting.toml'], start=IN_MILL),
    Sample('mill3', 'pocket.ngc', 'machine.toml', ['-f', 'forces.csv'], start=IN_MILL),
    Sample('mill3-slot', 'slot.ngc', 'machine.toml', ['-f', 'forces.toml'], start=IN_MILL),
    Sample('mill3-pocket-fanuc', 'bracket.nc', MILL, CONSTANT, start=IN_MILL, tools=('T2M6', 'T3M6'),
           holes=(47, 48, 49, 50)),
    Sample('pipeline', 'parts/plate.ngc', MILL, CONSTANT, start=IN_MILL),
    Sample('pipeline', 'parts/ring.ngc', MILL, CONSTANT, start=IN_MILL),
    Sample('delta', 'ring.ngc', 'machine.toml', ['-f', 'forces.toml'], start=(0, 0, 10)),
    Sample('hexapod', 'cap.ngc', 'machine.toml', ['-f', 'forces.toml'], start=(-60, -40, 600)),
    Sample('orthoglide-groove', 'groove.ngc', 'machine.toml', []),
    Sample('orthoglide-slot', 'slot.ngc', '../orthoglide-groove/machine.toml', ['-f', 'forces.toml']),
    Sample('orthoglide-cover', 'cover.ngc', '../orthoglide-groove/machine.toml', ['--force=0,0,-40']),
    Sample('robot-ur10', 'panel.script', 'machine.toml', FORCE_OF_ROBOT, frame_in_program=r'part = p\[.*\]',
           start=(620, -260, 100, 0, 0, math.degrees(1.5708))),
    Sample('robot-rail', 'wing.src', 'machine.toml', FORCE_OF_ROBOT, work='BASE_DATA[4]', start=(3950, -60, 640, 0, 0, 0),
           beside=('wing.dat',)),
    Sample('robot-spindle', 'face.ngc', 'machine.toml', ['-f', 'forces.toml'], start=(1450, -45, 640)),
]


def options_of(sample, numbers, folder):
    """The program file and the options of a prediction with these numbers."""
    program = sample.program
    frame, lengths = numbers[:len(sample.start)], numbers[len(sample.start):]
    with open(program, encoding='utf-8') as file:
        text = file.read()
    if sample.frame_in_program:
        values = [n / 1000 for n in frame[:3]] + [math.radians(n) for n in frame[3:]]
        text, count = re.subn(sample.frame_in_program, 'part = p[%s]' % ', '.join('%.12f' % v for v in values), text)
        assert count == 1, program
    works = [(sample.work, frame)]
    for i, (change, length) in enumerate(zip(sample.tools, lengths)):  # each tool gets a work offset of its own
        assert text.count(change) == 1, change
        text = text.replace(change, 'G%d%s' % (55 + i, change))
        works.append(('G%d' % (55 + i), [frame[0], frame[1], frame[2] + length]))
    path = os.path.join(folder, os.path.basename(program))
    with open(path, 'w', encoding='utf-8') as file:
        file.write(text)
    for name in sample.beside:
        shutil.copy(name, folder)
    options = ['-m', sample.machine, *sample.forces]
    if not sample.frame_in_program:
        for name, values in works:
            options += ['--work', '%s=%s/machine' % (name, ','.join('%.9f' % v for v in values))]
    return path, options


def run(counterflex, arguments):
    done = subprocess.run([counterflex, *arguments], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit('%s: exit status %d: %s' % (' '.join(arguments), done.returncode, done.stderr[-500:]))
    return done.stdout


def columns_at(columns, key):
    """Steps along a line of a round length may be one more or less after a shift: then between two places. The first
    place of a line is the last one of the line before it."""
    if key in columns:
        return columns[key]
    near = sorted(columns, key=lambda k: k[1])
    before = max((k for k in near if k[1] <= key[1]), key=lambda k: (k[1], k[0] == key[0]), default=near[0])
    behind = min((k for k in near if k[1] >= key[1]), key=lambda k: (k[1], k[0] != key[0]), default=near[-1])
    share = (key[1] - before[1]) / (behind[1] - before[1]) if behind[1] != before[1] else 0
    return [[a + share * (b - a) for a, b in zip(u, v)] for u, v in zip(columns[before], columns[behind])]


def product_of(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def applied(a, v):
    return [sum(a[i][k] * v[k] for k in range(3)) for i in range(3)]


def turn_about(axis, angle):
    """Rodrigues' formula; `axis` is a unit vector, `angle` in rad."""
    c, s = math.cos(angle), math.sin(angle)
    x, y, z = axis
    cross = [[0, -z, y], [z, 0, -x], [-y, x, 0]]
    return [[(c if i == j else 0) + s * cross[i][j] + (1 - c) * axis[i] * axis[j] for j in range(3)] for i in range(3)]


def rotation_of(sample, angles_deg):
    """A rotation vector of a program of a UR; roll, pitch and yaw of --work."""
    angles = [math.radians(a) for a in angles_deg]
    if sample.frame_in_program:
        size = norm(angles)
        return turn_about([a / size for a in angles] if size > 0 else [1, 0, 0], size)
    roll, pitch, yaw = (turn_about([float(i == k) for i in range(3)], angles[k]) for k in range(3))
    return product_of(yaw, product_of(pitch, roll))


def original_place(sample, numbers, tool, place):
    """Where the program with the original numbers wants the tip, whose place is `place` with `numbers`."""
    def frame(values):
        lift = values[len(sample.start) + tool - 1] if tool > 0 else 0
        return (rotation_of(sample, values[3:6]) if len(sample.start) == 6 else None,
                [values[0], values[1], values[2] + lift])

    rotation, origin = frame(numbers)
    first_rotation, first_origin = frame(sample.start + [0.0] * len(sample.tools))
    local = [a - b for a, b in zip(place, origin)]
    if rotation:
        inverse = [[rotation[j][i] for j in range(3)] for i in range(3)]
        local = applied(first_rotation, applied(inverse, local))
    return [a + b for a, b in zip(local, first_origin)]


def tool_at(sample, line):
    if not sample.tools:
        return 0
    with open(sample.program, encoding='utf-8') as file:
        text = file.read().split('\n')
    return sum(any(change in one for one in text[:line]) for change in sample.tools)


def deviations_with(counterflex, sample, numbers):
    """Deviations (mm) from the path that the original numbers want, by line and path length."""
    with tempfile.TemporaryDirectory() as folder:
        path, options = options_of(sample, numbers, folder)
        stem = os.path.join(folder, 'moved')
        run(counterflex, ['predict', path, *options, '--report', stem, '-q'])
        places, tools, before = {}, {}, None

        def keep(row):
            line, s = int(row['line']), round(float(row['s_mm']), 3)
            tool = tools.setdefault(line, tool_at(sample, line))
            moved = [float(row[axis + '_mm']) for axis in 'xyz']
            off = [float(row['before_d%s_mm' % axis]) for axis in 'xyz']
            wanted = original_place(sample, numbers, tool, moved)
            key = (line, s)
            while key in places:  # the other side of a step of the force
                key += (1,)
            places[key] = [m + d - w for m, d, w in zip(moved, off, wanted)]

        with open(stem + '.csv', newline='', encoding='utf-8') as file:
            for row in csv.DictReader(file):
                cuts = row['cutting'] == '1'
                if cuts and before is not None and before['cutting'] != '1':
                    keep(before)  # the cut starts where the rapid ends, without force; the file has no row for it
                if cuts or (int(row['line']) in sample.holes and float(row['s_mm']) == 0):
                    keep(row)
                before = row
        return places


def solve(a, b):
    """A symmetric system, by elimination with pivots."""
    n = len(b)
    rows = [list(a[i]) + [b[i]] for i in range(n)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda k: abs(rows[k][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for k in range(i + 1, n):
            factor = rows[k][i] / rows[i][i]
            for j in range(i, n + 1):
                rows[k][j] -= factor * rows[i][j]
    x = [0.0] * n
    for i in reversed(range(n)):
        x[i] = (rows[i][n] - sum(rows[i][j] * x[j] for j in range(i + 1, n))) / rows[i][i]
    return x


def at(place, x):
    d, columns = place
    return [d[k] + sum(c[k] * v for c, v in zip(columns, x)) for k in range(3)]


def norm(v):
    return math.sqrt(sum(c * c for c in v))


def normal_system(places, weights, n):
    a = [[0.0] * n for _ in range(n)]
    b = [0.0] * n
    for (d, columns), w in zip(places, weights):
        for i in range(n):
            ci = columns[i]
            b[i] -= w * (ci[0] * d[0] + ci[1] * d[1] + ci[2] * d[2])
            for j in range(i, n):
                cj = columns[j]
                a[i][j] += w * (ci[0] * cj[0] + ci[1] * cj[1] + ci[2] * cj[2])
    ridge = 1e-12 * sum(a[i][i] for i in range(n))  # a tool without places among these stays where it is
    for i in range(n):
        a[i][i] += ridge
        for j in range(i):
            a[i][j] = a[j][i]
    return a, b


def lawson(places, n):
    """The shift of least largest deviation of some places, and a lower bound of that (mm)."""
    weights = [1 / len(places)] * len(places)
    best, best_x, bound, least = math.inf, [0.0] * n, 0.0, 0.0
    for _ in range(20000):
        x = solve(*normal_system(places, weights, n))
        sizes = [norm(at(p, x)) for p in places]
        bound = max(bound, math.sqrt(sum(w * s * s for w, s in zip(weights, sizes))))
        if max(sizes) < best:
            best, best_x = max(sizes), x
        if best - bound < AGREEMENT_MM / 5:
            break
        weights = [max(w * s, least) for w, s in zip(weights, sizes)]
        total = sum(weights)
        weights = [w / total for w in weights]
        least = 1e-10 * max(weights)  # a place that is small now may be the largest one later
    return best_x, bound


def least_largest(places, n):
    """The same over all places: those that are larger are added until there are none."""
    chosen = set(sorted(range(len(places)), key=lambda i: -norm(places[i][0]))[:4 * n])
    chosen.update(range(0, len(places), 1 + len(places) // 30))
    for _ in range(60):
        x, bound = lawson([places[i] for i in sorted(chosen)], n)
        sizes = [norm(at(p, x)) for p in places]
        largest = max(sizes)
        if largest - bound < AGREEMENT_MM / 4:
            break
        order = sorted(range(len(places)), key=lambda i: -sizes[i])
        before = len(chosen)
        chosen.update([i for i in order if i not in chosen][:2 * n])
        if len(chosen) == before:
            break
    return x, bound


def compare(counterflex, sample):
    with tempfile.TemporaryDirectory() as folder:
        path, options = options_of(sample, sample.start, folder)
        offsets = json.loads(run(counterflex, ['predict', path, *options, '--offsets', '--json', '-q']))['offsets']
    start = sample.start + [0.0] * len(sample.tools)
    n = sample.count()

    def deviations(x):
        return deviations_with(counterflex, sample, [a + b for a, b in zip(start, x)])

    def largest(x):
        return max(map(norm, deviations(x).values()))

    step = [0.1 if i < 3 or i >= len(sample.start) else 0.01 for i in range(n)]
    x, left = [0.0] * n, math.inf
    for _ in range(6):  # the model is linear about the last shift
        here = deviations(x)
        there = [deviations([v + (step[i] if k == i else 0) for k, v in enumerate(x)]) for i in range(n)]
        columns = {key: [[(a - b) / step[i] for a, b in zip(moved[key], here[key])] for i, moved in enumerate(there)]
                   for key in here if all(key in moved for moved in there)}
        places = [(here[key], columns_at(columns, key)) for key in here]
        dx, bound = least_largest(places, n)
        x = [a + b for a, b in zip(x, dx)]
        last, left = left, largest(x)
        if abs(left - last) < AGREEMENT_MM / 10:
            break
    near = min(largest([v + (side * PROBE if k == i else 0) for k, v in enumerate(x)])
               for i in range(n) for side in (-1, 1))
    return largest([0.0] * n), offsets['least_max_mm'], offsets['rest']['max_mm'], left, bound, near


def main():
    counterflex, samples = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    only = sys.argv[3] if len(sys.argv) > 3 else ''
    failed = 0
    print('%-34s %9s %9s %9s %9s %9s %9s' % ('mm', 'before', 'product', 'rounded', 'search', 'bound', 'beside'))
    for sample in SAMPLES:
        if only not in sample.folder:
            continue
        os.chdir(os.path.join(samples, sample.folder))
        before, product, rounded, left, bound, near = compare(counterflex, sample)
        agrees = abs(product - left) < AGREEMENT_MM and abs(product - bound) < AGREEMENT_MM
        agrees = agrees and near > product - AGREEMENT_MM
        failed += not agrees
        name = '%s/%s %s' % (sample.folder, sample.program, sample.forces[-1] if sample.forces else '')
        print('%-34s %9.6f %9.6f %9.6f %9.6f %9.6f %9.6f%s'
              % (name[:34], before, product, rounded, left, bound, near, '' if agrees else '  DIFFERS'), flush=True)
        os.chdir(os.path.dirname(os.path.abspath(__file__)))
    sys.exit(1 if failed else 0)


if __name__ == '__main__':
    main()
