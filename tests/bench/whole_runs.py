"""`counterflex compensate` from files to files, beside an interpreter that merely reads the program."""
import glob
import os
import re

import made_programs
from timing import best_alternating, measured

HEAD = '%-10s %-8s %8s %8s %8s %11s %9s %6s %8s %7s %7s %7s' % (
    'machine', 'forces', 'blocks', '1 thread', '2', 'waypoints/s', '2', '2 to 1', 'rs274', 'ratio 1', '2', 'memory')


class Work:
    """One kind of run: `forces` is `csv` (another force on every block), `constant`, `fine` (constant, along a finer path in all
    axes) or `reports` (csv, with reports)."""

    def __init__(self, machine, forces, blocks, folder):
        self.machine, self.forces, self.blocks, self.folder = machine, forces, blocks, folder
        self.program = '%s/%s-%s-%d.ngc' % (folder, machine.name, 'fine' if forces == 'fine' else 'raster', blocks)
        self.csv = '%s/forces-%d.csv' % (folder, blocks)
        if not os.path.exists(self.program):
            place_of = made_programs.fine_place if forces == 'fine' else made_programs.place
            made_programs.write_program(machine, blocks, self.program, place_of)
        if not os.path.exists(self.csv):
            made_programs.write_forces(blocks, self.csv)

    def arguments(self, counterflex, threads):
        arguments = [counterflex, 'compensate', self.program, '-m', self.machine.file, '-o', self.folder + '/out.ngc',
                     '--max-correction-mm', '5', '--threads', str(threads)]
        if self.forces in ('constant', 'fine'):
            return arguments + ['--force=' + made_programs.CONSTANT_FORCE]
        arguments += ['-f', self.csv]
        return arguments + (['--report', self.folder + '/report'] if self.forces == 'reports' else [])

    def run(self, counterflex, threads):
        for old in glob.glob(self.folder + '/out.ngc') + glob.glob(self.folder + '/report.*'):
            os.remove(old)
        return measured(self.arguments(counterflex, threads), self.folder)


def waypoints(text):
    """The number of written places in the summary, each solved and verified."""
    corrected, added = re.search(r'(\d+) of \d+ moves corrected(?:, (\d+) points? added)?', text).groups()
    return int(corrected) + int(added or 0)


def kinds(blocks, folder):
    orthoglide, mill, hexapod = made_programs.MACHINES
    for machine, forces in ((orthoglide, 'csv'), (orthoglide, 'constant'), (orthoglide, 'fine'), (orthoglide, 'reports'), (mill, 'csv'),
                            (mill, 'constant'), (hexapod, 'csv'), (hexapod, 'constant')):
        yield Work(machine, forces, blocks, folder)


def row(work, counterflex, reader, rounds):
    contenders = {1: lambda: work.run(counterflex, 1), 2: lambda: work.run(counterflex, 2)}
    if not reader.why_not:
        contenders['rs274'] = lambda: reader.read(work.program)
    best = best_alternating(contenders, rounds)
    count = waypoints(best[1].text)
    one, two = best[1].wall, best[2].wall
    read = ('-', '-', '-')
    if not reader.why_not:
        seconds = best['rs274'].wall
        read = ('%.2f s' % seconds, '%.2f' % (one / seconds), '%.2f' % (two / seconds))
    return '%-10s %-8s %8d %6.2f s %6.2f s %11.0f %9.0f %6.2f %8s %7s %7s %4.0f MB' % (
        work.machine.name, work.forces, work.blocks, one, two, count / one, count / two, one / two, *read,
        max(best[1].peak_mb, best[2].peak_mb))


def growth(counterflex, blocks, folder, rounds):
    """A line that says how the time of a waypoint grows from a hundredth of the blocks to all of them, or None. One
    thread and processor time, the best of more runs of the few, as 1 % of a run is short."""
    few = max(100, blocks // 100)
    if few >= blocks:
        return None

    def each(count, times):
        work = Work(made_programs.MACHINES[0], 'csv', count, folder)
        best = best_alternating({1: lambda: work.run(counterflex, 1)}, times)[1]
        return 1e6 * best.cpu / waypoints(best.text)

    short, long = each(few, 3 * rounds), each(blocks, rounds)
    return 'processor time of a waypoint: %.2f us of %d blocks, %.2f us of %d, %+.1f %%' % (
        short, few, long, blocks, 100 * (long / short - 1))


def tables(counterflex, reader, sizes, folder, rounds, say):
    say('Whole runs from files to files with 1 and 2 threads, the best of %d in turns; the ratios are to the time that rs274,'
        % rounds)
    say("LinuxCNC's interpreter, takes for merely reading the same program%s." % (
        ', which is not available: ' + reader.why_not if reader.why_not else ''))
    say(HEAD)
    for blocks in sizes:
        for work in kinds(blocks, folder):
            say(row(work, counterflex, reader, rounds))
        say(growth(counterflex, blocks, folder, rounds) or 'too few blocks for how time grows with them')
        for old in glob.glob(folder + '/*-*.*') + glob.glob(folder + '/report.*'):
            os.remove(old)
