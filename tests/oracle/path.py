"""Canonical calls as a path: steps in program coordinates (mm), each with its line."""
import math
import subprocess
from dataclasses import dataclass, field
from typing import Optional

import interpreter

INCH = 25.4
# Axes of an arc's plane, first and second, and its normal, by the number that the interpreter gives it.
PLANES = {1: (0, 1, 2), 2: (1, 2, 0), 3: (2, 0, 1)}
STRAIGHT = {'straight_traverse': 'rapid', 'straight_feed': 'feed', 'straight_probe': 'probe', 'rigid_tap': 'tap'}
FUZZ = 1e-6  # an arc whose angle is smaller than this is a full turn


class Refused(Exception):
    """The interpreter does not accept the program."""


@dataclass
class Arc:
    first: int
    second: int
    normal: int
    centre: tuple  # in the plane: first, second
    turns: int     # positive: counterclockwise


@dataclass
class Step:
    line: int
    kind: str  # rapid, feed, arc, probe, tap
    start: list
    end: list
    arc: Optional[Arc] = None
    offset: list = field(default_factory=lambda: [0.0] * 3)  # of the program's origin in the machine
    feed: float = 0  # mm/min

    def angles(self):
        """Angle of the start and the signed sweep (rad) of an arc."""
        a = self.arc
        begin, end = (math.atan2(p[a.second] - a.centre[1], p[a.first] - a.centre[0]) for p in (self.start, self.end))
        sweep = end - begin
        if a.turns > 0:
            while sweep < FUZZ: sweep += 2 * math.pi
        else:
            while sweep > -FUZZ: sweep -= 2 * math.pi
        return begin, sweep + math.copysign(2 * math.pi * (abs(a.turns) - 1), sweep)

    def radii(self):
        """Distances of start and end from the centre of an arc."""
        a = self.arc
        return [math.hypot(p[a.first] - a.centre[0], p[a.second] - a.centre[1]) for p in (self.start, self.end)]

    def at(self, u):
        """The point at fraction `u`: an arc's radius and height are linear in the angle."""
        if not self.arc:
            return [s + u * (e - s) for s, e in zip(self.start, self.end)]
        a, (begin, sweep), (r0, r1) = self.arc, self.angles(), self.radii()
        r, angle = r0 + u * (r1 - r0), begin + u * sweep
        p = [0.0] * 3
        p[a.first] = a.centre[0] + r * math.cos(angle)
        p[a.second] = a.centre[1] + r * math.sin(angle)
        p[a.normal] = self.start[a.normal] + u * (self.end[a.normal] - self.start[a.normal])
        return p


class Walk:
    """Follows the calls; the machine's position joins what offsets tear apart."""

    def __init__(self):
        self.steps = []
        self.machine = [0.0] * 3
        self.g5x, self.g92, self.tool = [0.0] * 3, [0.0] * 3, [0.0] * 3
        self.plane, self.feed = 1, 0.0

    def origin(self):
        return [a + b for a, b in zip(self.g5x, self.g92)]

    def move(self, line, kind, end, arc=None):
        shift = [a + b for a, b in zip(self.origin(), self.tool)]
        start = [m - s for m, s in zip(self.machine, shift)]
        self.steps.append(Step(line, kind, start, end, arc, self.origin(), self.feed))
        self.machine = [e + s for e, s in zip(end, shift)]

    def arc(self, line, given):
        end = [0.0] * 3
        first, second, normal = PLANES[self.plane]
        end[first], end[second], end[normal] = (INCH * given[i] for i in (0, 1, 5))
        self.move(line, 'arc', end, Arc(first, second, normal, (INCH * given[2], INCH * given[3]), int(given[4])))

    def call(self, line, name, given):
        if name in STRAIGHT:
            self.move(line, STRAIGHT[name], [INCH * v for v in given[:3]])
        elif name == 'arc_feed':
            self.arc(line, given)
        elif name == 'set_g5x_offset':
            self.g5x = [INCH * v for v in given[1:4]]
        elif name == 'set_g92_offset':
            self.g92 = [INCH * v for v in given[:3]]
        elif name == 'tool_offset':
            self.tool = [INCH * v for v in given[:3]]
        elif name == 'set_plane':
            self.plane = int(given[0])
        elif name == 'set_feed_rate':
            self.feed = INCH * given[0]
        elif name == 'set_xy_rotation' and given[0] != 0:
            raise Refused('rotations are not followed')


@dataclass
class Bench:
    """Where the interpreter runs: its folder, a folder for files, offsets by number (1: G54), tool lengths, mm."""
    interpreter: str
    folder: str
    offsets: dict = field(default_factory=dict)
    lengths: dict = field(default_factory=dict)


def write_tables(bench):
    tools, variables = bench.folder + '/tools.tbl', bench.folder + '/variables'
    with open(tools, 'w') as out:
        for tool in range(1, 1000):
            out.write('T%d P%d Z%r D0\n' % (tool, tool, bench.lengths.get(tool, 0.0)))
    with open(variables, 'w') as out:
        for number, xyz in sorted(bench.offsets.items()):
            for axis, value in enumerate(xyz):
                out.write('%d\t%r\n' % (5201 + 20 * number + axis, value))
    return tools, variables


def walk(bench, lines, unit='G21', skip=False):
    """The steps of a program that is given as plain lines. Raises Refused."""
    program = bench.folder + '/plain.ngc'
    with open(program, 'w', encoding='latin-1') as out:
        out.write('\n'.join(lines) + '\n')
    tools, variables = write_tables(bench)
    canon = __file__.replace('path.py', 'canon.py')
    done = subprocess.run(['/usr/bin/python3', canon, bench.interpreter, program, tools, variables, unit, str(int(skip))],
                          env=interpreter.environment(bench.interpreter), capture_output=True, text=True)
    if done.returncode != 0:
        raise Refused((done.stderr.strip().splitlines() or ['no message'])[-1].replace(program, 'line'))
    following = Walk()
    for row in done.stdout.splitlines():
        number, name, *given = row.split(' ')
        if name in ('set_xy_rotation', 'set_plane', 'set_feed_rate', 'set_g5x_offset', 'set_g92_offset', 'tool_offset',
                    'arc_feed', *STRAIGHT):
            following.call(int(number), name, [float(v) for v in given])
    return following.steps
