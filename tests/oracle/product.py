"""Runs of the program under test, on machines that are made here."""
import json
import math
import os
import re
import subprocess
from dataclasses import dataclass, field

FRAME_SHIFT = (0.5, -0.25, 0.125)  # mm: where the gantry of the constant shift really stands
NO_UNITS = 'before the unit is known'  # a program that says no units is refused with this


@dataclass
class Run:
    status: int
    text: bytes
    report: dict
    said: str

    def refused_with_place(self, name):
        return self.status == 3 and re.search(re.escape(name) + r':\d+:\d+: error: ', self.said)


@dataclass
class Gantry:
    """Three axes, X carrying Y carrying Z. `shift` displaces its frame (mm), `turned` turns it about Z, X and Y (rad);
    `squareness` turns Y about Z, Z about X and Z about Y (rad). Lengths of tools are known to it only by the table."""
    shift: tuple = (0.0, 0.0, 0.0)
    turned: tuple = (0.0, 0.0, 0.0)
    squareness: tuple = (0.0, 0.0, 0.0)
    offsets: dict = field(default_factory=dict)
    program: str = ''  # lines of the table [program]
    shown: bool = False  # the control shows the offsets as they are in the machine

    def toml(self):
        yaw, roll, pitch = (math.degrees(a) for a in self.squareness)
        z, x, y = (math.degrees(a) for a in self.turned)
        work = ''.join('[work."%s"]\nxyz_mm = [%r, %r, %r]\n' % (offset_name(n), *xyz) +
                       ('offset_mm = [%r, %r, %r]\n' % xyz if self.shown else '') for n, xyz in self.offsets.items())
        return ('format = "counterflex-machine 1"\nname = "gantry"\ncontrolled = ["x", "y", "z"]\n' +
                '[program]\n' + self.program + '\n' + work +
                '[[chain]]\nname = "serial"\n'
                'errors.frame = { xyz_mm = [%r, %r, %r], rpy_deg = [%r, %r, %r] }\n' % (*self.shift, x, y, z) +
                'errors.second = { rpy_deg = [0, 0, %r] }\nerrors.third = { rpy_deg = [%r, %r, 0] }\n' % (yaw, roll, pitch) +
                'elements = [\n  { error = "frame" },\n' + axis('x') + '  { error = "second" },\n' + axis('y') +
                '  { error = "third" },\n' + axis('z') + ']\n')

    def columns(self):
        """Where a unit of each axis takes the tool."""
        yaw, roll, pitch = self.squareness
        second = turn(2, yaw)
        third = product(second, product(turn(1, pitch), turn(0, roll)))
        return [1.0, 0.0, 0.0], [row[1] for row in second], [row[2] for row in third]

    def frame(self):
        z, x, y = self.turned
        return product(turn(2, z), product(turn(1, y), turn(0, x)))

    def reached(self, q):
        """Where the tool stands when `q` is commanded (mm, machine frame)."""
        columns, R = self.columns(), self.frame()
        p = [sum(columns[k][a] * q[k] for k in range(3)) for a in range(3)]
        return [self.shift[a] + sum(R[a][b] * p[b] for b in range(3)) for a in range(3)]

    def commanded(self, p):
        """What must be commanded so that the tool stands at `p` (mm, machine frame)."""
        (x, y, z), R = self.columns(), self.frame()
        q = [sum(R[b][a] * (p[b] - self.shift[b]) for b in range(3)) for a in range(3)]
        qz = [0.0] * 3
        qz[2] = (q[2] * y[1] - q[1] * y[2]) / (z[2] * y[1] - z[1] * y[2])
        qz[1] = (q[1] - z[1] * qz[2]) / y[1]
        qz[0] = q[0] - y[0] * qz[1] - z[0] * qz[2]
        return qz


def axis(name):
    return '  { actuator = "prismatic", axis = "%s", min_mm = -100000, max_mm = 100000 },\n' % name


def turn(about, angle):
    i, j = (about + 1) % 3, (about + 2) % 3
    R = [[float(a == b) for b in range(3)] for a in range(3)]
    R[i][i] = R[j][j] = math.cos(angle)
    R[i][j], R[j][i] = -math.sin(angle), math.sin(angle)
    return R


def product(A, B):
    return [[sum(A[i][k] * B[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def offset_name(number):
    """1: G54 ... 6: G59, 7: G59.1."""
    return 'G%d' % (53 + number) if number <= 6 else 'G59.%d' % (number - 6)


class Product:
    def __init__(self, executable, folder):
        self.executable, self.folder = executable, folder
        self.help = self.call(['compensate', '--help']).stdout.decode()

    def call(self, arguments):
        return subprocess.run([self.executable, *arguments], capture_output=True, stdin=subprocess.DEVNULL)

    def compensate(self, program, gantry, lengths=None, options=()):
        """Compensates the program at the path `program`, in mm where it does not say; no forces. Returns a Run."""
        machine, output = self.machine(gantry), self.folder + '/corrected' + os.path.splitext(program)[1]
        arguments = ['compensate', program, '-m', machine, '-o', output, '--json', '--max-correction-mm', '50',
                     '--accept-partial', *options]
        if lengths and '--tool-table' in self.help:
            arguments += ['--tool-table', self.tool_table(lengths)]
        if os.path.exists(output):
            os.remove(output)
        done = self.call(arguments)
        if done.returncode == 3 and NO_UNITS in done.stderr.decode('latin-1') and '--units' not in options:
            return self.compensate(program, gantry, lengths, (*options, '--units', 'mm'))
        if done.returncode == 3 and b'NOTHING CORRECTED' in done.stderr:  # the original is all there is
            return Run(0, open(program, 'rb').read(), json.loads(done.stdout), done.stderr.decode('latin-1').strip())
        text = open(output, 'rb').read() if done.returncode == 0 else b''
        report = json.loads(done.stdout) if done.returncode == 0 else {}
        return Run(done.returncode, text, report, done.stderr.decode('latin-1').strip())

    def offsets(self, program, gantry, options=()):
        """What predict --offsets finds, without forces, and what it said."""
        done = self.call(['predict', program, '-m', self.machine(gantry), '--offsets', '--json', *options])
        said = done.stderr.decode('latin-1').strip()
        if done.returncode == 3 and NO_UNITS in said and '--units' not in options:
            return self.offsets(program, gantry, (*options, '--units', 'mm'))
        return (json.loads(done.stdout) if done.returncode == 0 else {}), said

    def machine(self, gantry):
        path = self.folder + '/machine.toml'
        with open(path, 'w') as out:
            out.write(gantry.toml())
        return path

    def plan(self, program, gantry, options=()):
        """The plan that `check` prints of a program, and what it said."""
        done = self.call(['check', program, '-m', self.machine(gantry), '--json', *options])
        said = done.stderr.decode('latin-1').strip()
        if done.returncode == 3 and NO_UNITS in said and '--units' not in options:
            return self.plan(program, gantry, (*options, '--units', 'mm'))
        return (json.loads(done.stdout) if done.returncode == 0 else {}), said

    def tool_table(self, lengths):
        path = self.folder + '/lengths.tbl'
        with open(path, 'w') as out:
            out.write(''.join('T%d P%d Z%r D0\n' % (tool, tool, z) for tool, z in sorted(lengths.items())))
        return path
