"""LinuxCNC's stand-alone interpreter as something that reads a program: what a compensated program is compared with."""
import os
import sys

from timing import Failed, measured

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'oracle'))
import interpreter  # noqa: E402
from skip import Skip  # noqa: E402


class Reader:
    """`folder` gets the interpreter; `why_not` is the reason why it is missing, or empty."""

    def __init__(self, folder, work):
        self.folder, self.work, self.why_not = folder, work, ''
        for name in ('tools', 'variables'):
            open(work + '/' + name, 'w', encoding='ascii').close()
        probe = work + '/probe.ngc'
        with open(probe, 'w', encoding='ascii') as out:
            out.write('G21 G90\nG1 X1 F100\nM30\n')
        try:
            interpreter.obtain(folder)
            printed = self.read(probe, None).text
            if 'STRAIGHT_FEED' not in printed:
                self.why_not = 'it does not read a program: ' + printed.strip()[-100:]
        except (Skip, Failed, OSError) as reason:
            self.why_not = str(reason)

    def read(self, program, to=os.devnull):
        """A measured Run that reads the program, its canonical moves written to the file `to`."""
        command = [self.folder + '/usr/bin/rs274', '-t', self.work + '/tools', '-v', self.work + '/variables', '-g',
                   program] + ([to] if to else [])
        return measured(command, self.work, dict(interpreter.environment(self.folder), HOME=self.work))
