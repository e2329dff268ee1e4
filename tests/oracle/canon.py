#!/usr/bin/python3
"""What LinuxCNC's interpreter asks of the machine, in full doubles: a line `LINE CALL ARGUMENTS` each, lengths in inches.

    canon.py INTERPRETER PROGRAM TOOLS VARIABLES UNIT SKIP

TOOLS is a tool table, VARIABLES a file of parameters, UNIT G20 or G21: what acts before the program says; SKIP 1 leaves
out blocks with '/'. A program that the interpreter refuses: exit 1 and PROGRAM:LINE: what it says.
"""
import ctypes
import os
import sys
import tempfile

folder, program, tools, variables, unit, skip = sys.argv[1:]
sys.path.insert(0, folder + '/usr/lib/python3/dist-packages')
os.environ['HOME'] = os.path.dirname(os.path.abspath(variables))  # the tool table is shared in a file there

data = ctypes.CDLL('libtooldata.so.0')
data._Z17tool_mmap_creatorPK13EMC_TOOL_STATi(None, 0)
data._Z13tooldata_loadPKcPPc(tools.encode(), None)

import gcode  # noqa: E402  it looks for the shared table


def lengths_of(path):
    """Length by tool; the lines are T1 P1 Z10 D0."""
    rows = [dict((word[0], float(word[1:])) for word in line.split()) for line in open(path)]
    return {int(row['T']): row['Z'] for row in rows}


class Calls:
    """Takes the interpreter's calls and prints them."""
    lengths = lengths_of(tools)
    parameter_file = variables

    def __init__(self):
        self.line = 0
        self.printed = []

    def next_line(self, state):
        self.line = state.sequence_number

    def __getattr__(self, name):
        if name.startswith('_'):
            raise AttributeError(name)
        return lambda *given: self.printed.append('%d %s %s' % (self.line, name, ' '.join(map(repr, given))))

    def comment(self, text): pass
    message = comment

    def check_abort(self): return False
    def get_external_angular_units(self): return 1.0
    def get_external_length_units(self): return 1.0
    def get_axis_mask(self): return 7
    def get_block_delete(self): return int(skip)

    def get_tool(self, tool):
        return (tool, 0., 0., self.lengths.get(tool, 0.)) + (0.,) * 9 + (0,)


calls = Calls()
result, line = gcode.parse(program, calls, unit, '')
print('\n'.join(calls.printed))
if result > gcode.MIN_ERROR:
    sys.exit('%s:%d: %s' % (program, line, gcode.strerror(result)))
