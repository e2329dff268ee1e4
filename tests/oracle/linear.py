"""Compares paths under a linear field of errors: each point has a correction of its own, which is known exactly."""
import math

from compare import Findings, difference, distance, short

SAMPLES = 16     # on a written piece
DENSE = 360      # on a wanted arc
NEAR_CONTOUR = 12  # lines before and after a contour under G41 or G42 that have its one shift too


def contour_lines(facts):
    """Lines of contours under cutter radius compensation and about them."""
    near = set()
    for line, fact in facts.items():
        if fact['side']:
            near.update(range(line - NEAR_CONTOUR, line + NEAR_CONTOUR + 1))
    return near


def to_polyline(p, points):
    """Distance of `p` from the nearest of the chords between `points`."""
    best = math.inf
    for a, b in zip(points, points[1:]):
        ab, ap = difference(b, a), difference(p, a)
        length = sum(v * v for v in ab)
        t = min(1.0, max(0.0, sum(x * y for x, y in zip(ab, ap)) / length)) if length > 0 else 0.0
        best = min(best, math.dist(p, [x + t * v for x, v in zip(a, ab)]))
    return best


class FieldCheck:
    """Corrected moves end, and go, within `tolerance` (mm) of where the gantry must be commanded. What is held, left
    alone or has axes that are not known yet is not judged."""

    def __init__(self, gantry, facts, left_alone, tolerance):
        self.gantry, self.facts, self.tolerance = gantry, facts, tolerance
        self.skipped = left_alone | contour_lines(facts)
        self.known, self.offset = [False] * 3, None
        self.findings = Findings()

    def run(self, pairs):
        for pair in pairs:
            fact = self.facts[pair.line]
            self.findings.total += 1
            if pair.steps[0].offset != self.offset:  # where that takes the other axes is not in the program
                self.known, self.offset = [False] * 3, pair.steps[0].offset
            if fact['machine'] or pair.line in self.skipped or fact['doubtful']:
                self.forget(fact)
                continue
            started = all(self.known)
            self.known = [k or a in fact['axes'] for a, k in enumerate(self.known)]
            if all(self.known):
                self.judge(pair, started)
        return self.findings

    def forget(self, fact):
        self.known = [k and a not in fact['axes'] and bool(fact['axes']) for a, k in enumerate(self.known)]

    def wanted(self, step, p):
        """Program coordinates that must be commanded for `p`."""
        q = self.gantry.commanded([a + b for a, b in zip(p, step.offset)])
        return difference(q, step.offset)

    def judge(self, pair, started):
        o = pair.steps[0]
        if o.kind == 'rapid' and distance(o.start, o.end) < 1e-9:
            return  # to where a cycle has left the tool: it keeps the correction of the hole
        self.findings.judged += 1
        if len(pair.steps) > 1:
            return self.cycle(pair)
        c = pair.corrected[-1]
        miss = distance(self.wanted(o, o.end), c.end)
        if miss > self.tolerance:
            return self.findings.add(pair, 'ends %.5f off: %s instead of %s' % (
                miss, short(c.end), short(self.wanted(o, o.end))))
        if started and o.kind != 'rapid':
            self.way(pair, o)

    def cycle(self, pair):
        """A hole has the correction of its bottom."""
        o = min(pair.steps, key=lambda s: s.end[2])
        c = min(pair.corrected, key=lambda s: s.end[2])
        if distance(self.wanted(o, o.end), c.end) > self.tolerance:
            self.findings.add(pair, 'a hole has its bottom at %s instead of %s' % (short(c.end), short(self.wanted(o, o.end))))

    def way(self, pair, o):
        count = DENSE if o.arc else 1
        points = [self.wanted(o, o.at(k / count)) for k in range(count + 1)]
        for c in pair.corrected:
            for k in range(1, SAMPLES):
                miss = to_polyline(c.at(k / SAMPLES), points)
                if miss > self.tolerance:
                    return self.findings.add(pair, 'goes %.5f off the wanted path' % miss)
        if o.arc:
            self.sweep(pair, o)

    def sweep(self, pair, o):
        """The whole angle, chords by what they cover about the centre."""
        wanted = o.angles()[1]
        covered = sum(c.angles()[1] if c.arc else self.covered(o, c) for c in pair.corrected)
        if abs(wanted - covered) > 0.02:
            self.findings.add(pair, 'an arc turns %.4f rad instead of %.4f' % (covered, wanted))

    @staticmethod
    def covered(o, c):
        a = o.arc
        angles = [math.atan2(p[a.second] - a.centre[1], p[a.first] - a.centre[0]) for p in (c.start, c.end)]
        return math.remainder(angles[1] - angles[0], 2 * math.pi)
