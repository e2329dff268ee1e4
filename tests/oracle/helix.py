"""Helices of Klartext, a CC and a CP with IPA and IZ behind it, that a corrected program writes as lines: L with X, Y and IZ."""
import math
import re

from text import Mismatch

NUMBER = r'[-+]?\d*\.?\d+\.?'
CENTRE = re.compile(r'CC X(%s) Y(%s)\s*$' % (NUMBER, NUMBER))
HELIX = re.compile(r'CP IPA(%s) IZ(%s) DR([-+])(.*)$' % (NUMBER, NUMBER), re.S)
# A coordinate that stays where it is may be left out.
PIECE = re.compile(r'L(?: X(%s))?(?: Y(%s))? IZ(%s)((?: F%s)?[ \t\r]*)$' % (NUMBER, NUMBER, NUMBER, NUMBER))


def helices_of(lines):
    """Indices of the CC of each helix, whether it is a CP or lines."""
    return [i for i, line in enumerate(lines[:-1])
            if CENTRE.match(line) and (HELIX.match(lines[i + 1]) or PIECE.match(lines[i + 1]))]


def position_before(lines, index):
    """X, Y and Z where the tool is, by the absolute words of lines and arcs before the line at `index`."""
    found = {}
    for line in reversed(lines[:index]):
        if not re.match(r'(L|C) ', line):
            continue
        for incremental, axis, number in re.findall(r'(I?)([XYZ])(%s)' % NUMBER, line):
            if incremental and axis not in found:
                raise Mismatch('the start of a helix is not followed: %r' % line)
            found.setdefault(axis, float(number))
        if len(found) == 3:
            return [found[axis] for axis in 'XYZ']
    raise Mismatch('a helix starts where the program has set no position')


class Helix:
    def __init__(self, lines, index):
        centre, words = CENTRE.match(lines[index]), HELIX.match(lines[index + 1])
        self.centre = [float(v) for v in centre.groups()]
        self.start = position_before(lines, index)
        self.sense = 1 if words.group(3) == '+' else -1
        self.turn = math.radians(abs(float(words.group(1))))  # in its sense
        self.height = float(words.group(2))
        self.rest = words.group(4)

    def angle(self, p):
        return self.sense * math.atan2(p[1] - self.centre[1], p[0] - self.centre[0])

    def at(self, turn):
        radius, angle = math.dist(self.start[:2], self.centre), self.sense * (self.angle(self.start) + turn)
        return [self.centre[0] + radius * math.cos(angle), self.centre[1] + radius * math.sin(angle),
                self.start[2] + self.height * turn / self.turn]

    def check(self, points, reached, tolerance):
        """`points` are commanded, with lines between: they take the tool along the helix and to its end."""
        turn = 0.0
        for a, b in zip(points, points[1:]):
            ends = [reached(p) for p in (a, b)]
            step = math.remainder(self.angle(ends[1]) - self.angle(ends[0]), 2 * math.pi)
            if step <= 0:
                raise Mismatch('a line of a helix goes back')
            middle = reached([(u + v) / 2 for u, v in zip(a, b)])
            for p, at in ((middle, turn + step / 2), (ends[1], turn + step)):
                if math.dist(p, self.at(at)) > tolerance:
                    raise Mismatch('a line of a helix goes %.5f off it' % math.dist(p, self.at(at)))
            turn += step
        missed = math.dist(reached(points[-1]), self.at(self.turn))
        if abs(turn - self.turn) > 1 or missed > tolerance:
            raise Mismatch('the lines of a helix end %.5f from its end, after %.3f rad of %.3f' % (missed, turn, self.turn))


def with_helices(original, corrected, reached, tolerance):
    """`corrected` with the text of the original's CP in the place of the lines that stand for it. These have its feed and no
    other word, go along it within `tolerance` (mm), and end where it ends. Raises Mismatch where they do not. `reached`
    is where the tool stands (mm) when a position is commanded."""
    wanted, found = helices_of(original), helices_of(corrected)
    if len(wanted) != len(found):
        raise Mismatch('%d helices became %d' % (len(wanted), len(found)))
    result, done = [], 0
    for i, j in zip(wanted, found):
        if HELIX.match(corrected[j + 1]):
            continue
        if corrected[j] != original[i]:
            raise Mismatch('line %d, %r, became %r' % (i + 1, original[i], corrected[j]))
        helix, points, end = Helix(original, i), [position_before(corrected, j)], j + 1
        while end < len(corrected) and (piece := PIECE.match(corrected[end])) and piece.group(4) == helix.rest:
            x, y, z = points[-1]
            points.append([float(piece.group(1) or x), float(piece.group(2) or y), z + float(piece.group(3))])
            end += 1
        try:
            helix.check(points, reached, tolerance)
        except Mismatch as error:
            raise Mismatch('line %d: %s' % (i + 2, error))
        result += corrected[done:j + 1] + [original[i + 1]]
        done = end
    return result + corrected[done:]
