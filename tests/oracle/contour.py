"""Contours under cutter radius compensation: which moves belong to one, and the rigid motion that a field asks of it."""
import math

from compare import difference

SAMPLES = 16  # on a cut


def goes_across(pair, facts):
    return bool(facts[pair.line]['axes'] & {0, 1}) or any(s.arc for s in pair.steps)


def contours_of(pairs, facts):
    """Indices of the pairs of each contour: from the move across that leads to its plunge, over the moves between G41 and
    G40, to the moves along Z that follow. Contours with no move across between them are one."""
    contours = []

    def along_z(k):
        return 0 <= k < len(pairs) and not goes_across(pairs[k], facts) and not facts[pairs[k].line]['machine']

    def inside(k):
        return k < len(pairs) and facts[pairs[k].line]['side']
    k = 0
    while k < len(pairs):
        if not inside(k):
            k += 1
            continue
        end = contours[-1][-1] + 1 if contours else 0  # of the contour before
        first, last = k, k
        while first > end and along_z(first - 1):
            first -= 1
        joins = bool(contours) and first == end
        if not joins and first > end and not facts[pairs[first - 1].line]['machine']:
            first -= 1
        while inside(last) or along_z(last):
            last += 1
        if joins:
            contours[-1] += range(first, last)
        else:
            contours.append(list(range(first, last)))
        k = last
    return contours


class Motion:
    """A turn (rad) about Z about the point `about`, and a shift, in X and Y."""

    def __init__(self, about=(0.0, 0.0), turn=0.0):
        self.about, self.turn, self.shift = about, turn, (0.0, 0.0)

    def turned(self, p):
        """What the turn adds to `p`."""
        x, y = difference(p, self.about)
        c, s = math.cos(self.turn) - 1, math.sin(self.turn)
        return c * x - s * y, s * x + c * y

    def at(self, p):
        """Where `p` goes; Z stays."""
        return [p[a] + self.turned(p)[a] + self.shift[a] for a in (0, 1)] + [p[2]]

    def back(self, p):
        """What goes to `p`."""
        centre = [a + b for a, b in zip(self.about, self.shift)]
        x, y = difference(p, centre)
        c, s = math.cos(self.turn), math.sin(self.turn)
        return [self.about[0] + c * x + s * y, self.about[1] - s * x + c * y, p[2]]

    def fit_shift(self, samples):
        """The midpoint, per axis, of what the turn leaves of the samples. Half of the range of that, both axes together."""
        left = [difference(wanted, self.turned(p)) for p, wanted in samples]
        low, high = ([pick(v[a] for v in left) for a in (0, 1)] for pick in (min, max))
        self.shift = tuple((a + b) / 2 for a, b in zip(low, high))
        return math.dist(low, high) / 2


def best_turn(samples):
    """The turn that is nearest to the samples by least squares."""
    n = len(samples)
    about, mean = ([sum(s[which][a] for s in samples) / n for a in (0, 1)] for which in (0, 1))
    along = square = 0.0
    for p, wanted in samples:
        x, y = difference(p, about)
        along += x * (wanted[1] - mean[1]) - y * (wanted[0] - mean[0])
        square += x * x + y * y
    return Motion(about, math.atan2(along, square) if square > 0 else 0.0)


def motion_of(samples):
    """The motion for points and the shifts that a field asks for there, and what it leaves of them: one shift, and a turn
    where that leaves less than half as much."""
    shifted, turned = Motion(), best_turn(samples)
    left, less = shifted.fit_shift(samples), turned.fit_shift(samples)
    return (turned, less) if 2 * less < left else (shifted, left)


def samples_of(steps, wanted):
    """Points on the steps, and the shifts that `wanted` (of a step and a point) asks for there, in X and Y."""
    points = [(s, s.at(k / SAMPLES)) for s in steps for k in range(SAMPLES + 1)]
    return [(p[:2], difference(wanted(s, p), p)[:2]) for s, p in points]
