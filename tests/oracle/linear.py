"""Compares paths under a linear field of errors: each point has a correction of its own, which is known exactly."""
import math

import contour
from compare import Findings, difference, distance, short
from facts import unit_mm

SAMPLES = 16  # on a written piece
SAMPLING = 5e-5  # mm: what the motion of a contour depends on where its cuts are sampled


def fraction_of(step, p):
    """The fraction of the step at which it is about nearest to `p`."""
    if step.arc:
        begin, sweep = step.angles()
        a = step.arc
        turned = math.atan2(p[a.second] - a.centre[1], p[a.first] - a.centre[0]) - begin
        fractions = [(turned + 2 * math.pi * k) / sweep for k in range(-abs(a.turns) - 2, abs(a.turns) + 3)]
        return min((min(1.0, max(0.0, u)) for u in fractions), key=lambda u: distance(step.at(u), p))
    way = difference(step.end, step.start)
    length = sum(v * v for v in way)
    return min(1.0, max(0.0, sum(x * y for x, y in zip(way, difference(p, step.start))) / length)) if length > 0 else 0.0


class FieldCheck:
    """Corrected moves end, and go, within `tolerance` (mm) of where the gantry must be commanded. Contours under cutter
    radius compensation are moved as a whole in X and Y, as the field asks of them, and follow it in Z. What is held, left
    alone or has axes that are not known yet is not judged."""

    def __init__(self, gantry, facts, left_alone, tolerance):
        self.gantry, self.facts, self.tolerance = gantry, facts, tolerance
        self.left_alone = left_alone
        self.known, self.offset = [False] * 3, None
        self.findings = Findings()

    def run(self, pairs):
        contours = {k: indices for indices in contour.contours_of(pairs, self.facts) for k in indices}
        for k, pair in enumerate(pairs):
            fact = self.facts[pair.line]
            self.findings.total += 1
            if pair.steps[0].offset != self.offset:  # where that takes the other axes is not in the program
                self.known, self.offset = [False] * 3, pair.steps[0].offset
            inside = k in contours
            begins = inside and k == contours[k][0]  # the list of what is left alone names the contour there
            if begins:
                self.begin_contour([pairs[i] for i in contours[k]])
            if fact['machine'] or fact['doubtful'] or pair.line in self.left_alone and not begins:
                self.forget(fact)
                continue
            started = all(self.known)
            self.known = [known or a in fact['axes'] for a, known in enumerate(self.known)]
            if inside:
                self.judge_contour(pair, fact, started)
            elif all(self.known):
                self.judge(pair, started)
        return self.findings

    def begin_contour(self, pairs):
        cuts = [p for p in pairs if contour.goes_across(p, self.facts) and p.steps[0].kind in ('feed', 'arc')]
        samples = contour.samples_of([s for p in cuts for s in p.steps], self.wanted)
        self.motion, left = contour.motion_of(samples)
        self.findings.contours_leave = max(self.findings.contours_leave or 0.0, left)
        self.entry = next(p.line for p in cuts if self.facts[p.line]['side'])

    def judge_contour(self, pair, fact, started):
        """The end has the motion of the contour, and the height that the field asks for, up to the rounding."""
        self.findings.judged += 1
        o, c, unit = pair.steps[-1], pair.corrected[-1], unit_mm(fact)
        wanted = self.motion.at(o.end)[:2] + [self.wanted(o, o.end)[2]]
        for a in range(3):
            miss = abs(c.end[a] - wanted[a])
            if self.known[a] and (a < 2 or all(self.known)) and miss > 0.5 * unit + SAMPLING:
                self.findings.add(pair, '%s of a contour ends %.5f off: %.5f instead of %.5f' % (
                    'XYZ'[a], miss, c.end[a], wanted[a]))
        if started and o.kind != 'rapid':
            self.way_of_contour(pair, o, 2 * unit)

    def way_of_contour(self, pair, o, room):
        """A contour keeps its form: lines stay lines, arcs keep centre and radius."""
        for c in pair.corrected:
            if bool(c.arc) != bool(o.arc):
                return self.findings.add(pair, 'a contour has another kind of move')
            if o.arc and self.centre_moved(pair, o, c):
                return self.findings.add(pair, 'an arc of a contour has its centre at %s' % short(c.arc.centre))
            for k in range(1, SAMPLES):
                p = c.at(k / SAMPLES)
                on = o.at(fraction_of(o, self.motion.back(p)[:2] + [self.reached(o, p)[2]]))
                off, height = distance(p[:2], self.motion.at(on)[:2]), self.wanted(o, on)[2]
                if off > room:
                    return self.findings.add(pair, 'a contour goes %.5f off' % off)
                if abs(p[2] - height) > self.tolerance and not (o.arc and pair.line == self.entry):
                    return self.findings.add(pair, 'a contour goes %.5f too high' % (p[2] - height))
        if o.arc:
            self.sweep(pair, o)

    def centre_moved(self, pair, o, c):
        """Whether the centre has not the motion of the contour: a word of I or J is rounded, and so is the start that it
        counts from. A radius leaves more room, and the way tells."""
        fact = self.facts[pair.line]
        wanted = self.motion.at([*o.arc.centre, 0.0])
        return fact['radius'] is None and any(abs(a - b) > unit_mm(fact) + SAMPLING for a, b in zip(c.arc.centre, wanted))

    def forget(self, fact):
        self.known = [k and a not in fact['axes'] and bool(fact['axes']) for a, k in enumerate(self.known)]

    def wanted(self, step, p):
        """Program coordinates that must be commanded for `p`."""
        q = self.gantry.commanded([a + b for a, b in zip(p, step.offset)])
        return difference(q, step.offset)

    def reached(self, step, q):
        """Where the tool stands, in program coordinates, when `q` is commanded."""
        p = self.gantry.reached([a + b for a, b in zip(q, step.offset)])
        return difference(p, step.offset)

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
        for c in pair.corrected:
            for k in range(1, SAMPLES):
                p = self.reached(o, c.at(k / SAMPLES))
                miss = distance(p, o.at(fraction_of(o, p)))
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
