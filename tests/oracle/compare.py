"""Compares the paths of an original and of its corrected program, step by step."""
import math
from dataclasses import dataclass
from itertools import groupby

from facts import unit_mm

SLACK = 2e-6    # mm: what differs between two ways to compute in doubles
SAMPLES = 16
SHOWN = 5


@dataclass
class Pair:
    """The steps of one execution of a line, and those of its version and of what was inserted before it."""
    line: int
    steps: list
    corrected: list


class Findings:
    """What is wrong, in order; `judged` counts the end points that were held to the expectation."""

    def __init__(self):
        self.rows, self.judged, self.total = [], 0, 0
        self.contours_leave = None  # mm, of the corrections of contours, which move as a whole

    def add(self, pair, what):
        self.rows.append('line %d: %s' % (pair.line, what))

    def __bool__(self):
        return bool(self.rows)

    def text(self):
        more = len(self.rows) - SHOWN
        return '; '.join(self.rows[:SHOWN]) + (' ... and %d more' % more if more > 0 else '')


def pairs_of(steps, corrected, line_of):
    """Executions of lines in order; `line_of` gives the original's line for a line of the corrected program. None and
    a message where they do not follow each other alike."""
    originals = [(line, list(run)) for line, run in groupby(steps, key=lambda s: s.line)]
    versions = [(line, list(run)) for line, run in groupby(corrected, key=lambda s: line_of(s.line))]
    for (line, _), (other, _) in zip(originals, versions):
        if line != other:
            return None, 'after line %d of the original comes line %d' % (line, other)
    if len(originals) != len(versions):
        return None, '%d lines move, %d in the original' % (len(versions), len(originals))
    return [Pair(line, run, others) for (line, run), (_, others) in zip(originals, versions)], ''


def give_back(pairs, facts):
    """Pieces that follow their block, because it says more than where to go, stand before the next: where a step there
    ends nearer to the block's end than the block does, it and those before it are the block's."""
    for pair, following in zip(pairs, pairs[1:]):
        rapid = pair.steps[0].kind == 'rapid'  # it is not divided
        if not facts[pair.line]['goes_first'] or len(pair.steps) > 1 or rapid:
            continue
        ends = [distance(c.end, pair.steps[0].end) for c in [pair.corrected[-1]] + following.corrected[:-1]]
        count = ends.index(min(ends))
        pair.corrected += following.corrected[:count]
        following.corrected = following.corrected[count:]
    return pairs


def difference(p, q):
    return [a - b for a, b in zip(p, q)]


def distance(p, q):
    return math.dist(p, q)


def short(p):
    return '(' + ', '.join('%.5f' % v for v in p) + ')'


class ShiftCheck:
    """All axes that a program has set are shifted by exactly minus the displacement; those it has not set yet keep
    what they have, or are set by a word that was inserted."""

    def __init__(self, displacement, facts, left_alone):
        self.shift = [-d for d in displacement]
        self.facts, self.left_alone = facts, left_alone
        self.held, self.known = [0.0] * 3, [False] * 3
        self.findings = Findings()

    def run(self, pairs):
        for pair in pairs:
            self.check(pair)
        return self.findings

    def check(self, pair):
        fact = self.facts[pair.line]
        tolerance = 0.5 * unit_mm(fact) + SLACK
        if fact['machine']:
            return self.machine_position(pair, fact)
        if len(pair.steps) > 1:
            return self.several(pair, fact, tolerance)
        self.end(pair, pair.steps[0], pair.corrected[-1], fact, tolerance)
        self.between(pair, pair.steps[0], pair.corrected, unit_mm(fact))

    def machine_position(self, pair, fact):
        o, c = pair.steps[-1], pair.corrected[-1]
        axes = fact['axes'] or {0, 1, 2}
        for a in range(3):
            self.held[a] = c.end[a] - o.end[a]
            if a in axes:
                if abs(self.held[a]) > SLACK:
                    self.findings.add(pair, 'a machine position was shifted by %.5f on %s' % (self.held[a], 'XYZ'[a]))
                self.known[a] = False

    def several(self, pair, fact, tolerance):
        extra = len(pair.corrected) - len(pair.steps)
        if extra < 0:
            return self.findings.add(pair, 'a cycle has %d steps instead of %d' % (len(pair.corrected), len(pair.steps)))
        begin = pair.steps[0].start
        for o, c in zip(pair.steps, pair.corrected[extra:]):
            self.end(pair, o, c, fact, tolerance, begin)

    def end(self, pair, o, c, fact, tolerance, begin=None):
        """`begin`: a cycle leaves an axis where it was before; it may still be there."""
        self.findings.total += 1
        self.findings.judged += 1
        found = difference(c.end, o.end)
        loose = pair.line in self.left_alone or fact['doubtful']
        before = begin or o.start
        for a in range(3):
            allowed = [self.shift[a]]
            sets = a in fact['axes'] and not loose
            if not self.known[a] and (not sets or abs(o.end[a] - before[a]) < 1e-9) or loose:
                allowed += [self.held[a]] + ([0.0] if loose else [])
            if min(abs(found[a] - s) for s in allowed) > tolerance:
                self.findings.add(pair, '%s ends %.5f from the original, not %.5f' % ('XYZ'[a], found[a], self.shift[a]))
            self.known[a] = abs(found[a] - self.shift[a]) <= tolerance and (self.known[a] or sets) and not loose
            self.held[a] = found[a]

    def between(self, pair, o, pieces, unit):
        if not o.arc:
            return
        if any(not c.arc for c in pieces):
            return self.findings.add(pair, 'an arc was written as lines')
        sweep, written = o.angles()[1], sum(c.angles()[1] for c in pieces)
        if abs(sweep - written) > 1e-3 + 4 * unit / max(min(o.radii()), unit):
            return self.findings.add(pair, 'an arc turns %.5f rad instead of %.5f' % (written, sweep))
        if len(pieces) > 1 and abs(sweep) < math.radians(150):
            self.findings.add(pair, 'an arc of %.3f rad was split for a constant shift' % sweep)
        self.follows(pair, o, pieces, sweep, unit)

    def follows(self, pair, o, pieces, sweep, unit):
        """Each piece covers its share of the sweep; start and end have been judged."""
        shift = difference(pieces[-1].end, o.end)
        u = 0.0
        for c in pieces:
            share = c.angles()[1] / sweep
            for k in range(1, SAMPLES):
                v = k / SAMPLES
                wanted = [a + b for a, b in zip(o.at(u + v * share), shift)]
                if distance(difference(c.start, o.start), shift) > 2 * unit and c is pieces[0]:
                    break  # it comes from a place that is not shifted alike
                if distance(wanted, c.at(v)) > 2.5 * unit + SLACK + abs(o.radii()[1] - o.radii()[0]):
                    return self.findings.add(pair, 'inside the arc the path is %.5f off' % distance(wanted, c.at(v)))
            u += share


def moved_apart(steps, written, wanted_of, tolerance):
    """What is wrong with `written`, or an empty text: it must go through the ends of `steps`, in their order, each moved by
    `wanted_of`, by the same kinds of moves. An arc may be several."""
    at = 0
    for step in steps:
        wanted = wanted_of(step.end)
        while at < len(written) and step.arc and written[at].arc and distance(written[at].end, wanted) > tolerance:
            at += 1
        if at == len(written):
            return 'line %d: nothing goes to %s' % (step.line, short(wanted))
        if written[at].kind != step.kind or distance(written[at].end, wanted) > tolerance:
            return 'line %d: a %s to %s instead of a %s to %s' % (
                step.line, written[at].kind, short(written[at].end), step.kind, short(wanted))
        at += 1
    return 'line %d of the output goes on' % written[at].line if at < len(written) else ''
