"""Machines to compensate for, and programs made up for them: a raster of short straight feeds over a gentle relief, with a
force for every block. The same arguments give the same bytes."""
import math
import os

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

FIRST_LINE = 5  # of the feeds
STEP_MM, PASS_MM, SIDE_MM = 0.5, 0.25, 100.0
CONSTANT_FORCE = '120,-10,-25'  # N, machine axes


class Machine:
    """A machine file, and the middle of the patch that is cut, in the program's coordinates (mm)."""

    def __init__(self, name, file, middle):
        self.name, self.file, self.middle = name, os.path.join(TOP, file), middle


MACHINES = [
    Machine('orthoglide', 'tests/statics/data/orthoglide_case_b.toml', (0, 0, -20)),
    Machine('mill3', 'samples/mill3/machine.toml', (60, 60, -20)),
    Machine('hexapod', 'tests/statics/data/hexapod_joint_springs.toml', (0, 0, 850)),
]


def there_and_back(i, count):
    """0 ... count-1, count-1 ... 0, 0 ..."""
    i %= 2 * count
    return i if i < count else 2 * count - 1 - i


def place(i, middle):
    """End of feed i, mm: rows there and back, the patch from front to rear and back."""
    columns, rows = round(SIDE_MM / STEP_MM), round(SIDE_MM / PASS_MM)
    x = STEP_MM * (there_and_back(i, columns) + 0.5) - SIDE_MM / 2
    y = PASS_MM * (there_and_back(i // columns, rows) + 0.5) - SIDE_MM / 2
    z = 4 * math.sin(x / 17) * math.cos(y / 13)
    return middle[0] + x, middle[1] + y, middle[2] + z


def fine_place(i, middle):
    """End of feed i, mm: steps of some hundredths of a millimetre in all axes."""
    t = 0.001 * i
    return (middle[0] + 40 * math.cos(t) * (1 + 0.3 * math.sin(0.013 * t)), middle[1] + 40 * math.sin(t),
            middle[2] + 20 * math.sin(0.05 * t))


def force(i):
    """On the tool, machine axes, N: smooth, and a little different on every block."""
    return (120 + 60 * math.sin(i / 50) + 5 * math.sin(1.7 * i),
            -10 + 40 * math.cos(i / 37) + 4 * math.cos(2.3 * i),
            -25 + 10 * math.sin(i / 11))


def write_program(machine, blocks, file, place_of=place):
    x, y, z = place_of(0, machine.middle)
    with open(file, 'w', encoding='ascii', newline='\n') as out:
        out.write('%%\nG21 G90 G94 G17\nG54 S12000 M3\nG0 X%.4f Y%.4f Z%.4f\n' % (x - STEP_MM, y, z + 5))
        for i in range(blocks):
            out.write('G1 X%.4f Y%.4f Z%.4f%s\n' % (*place_of(i, machine.middle), ' F1200' if i == 0 else ''))
        out.write('G0 Z%.4f\nM30\n%%\n' % (machine.middle[2] + 20))


def write_forces(blocks, file):
    with open(file, 'w', encoding='ascii', newline='\n') as out:
        out.write('# frame = machine\n# sense = on_tool\nline,fx_N,fy_N,fz_N\n')
        for i in range(blocks):
            out.write('%d,%.2f,%.2f,%.2f\n' % (FIRST_LINE + i, *force(i)))
