#!/usr/bin/env python3
"""Prints the table of times; tests/bench/run builds what this runs.

    measure.py COUNTERFLEX BENCH INTERPRETER_FOLDER [--blocks N] [--long] [--short] [--rounds N] [--filter REGEX]
"""
import argparse
import datetime
import os
import platform
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True  # leaves no files in the tree

import kernels
import small_jobs
import whole_runs
from reader import Reader
from timing import Failed

HERE = os.path.dirname(os.path.abspath(__file__))
QUOTED = os.path.join(HERE, 'quoted.txt')
LONG = 1000000


def arguments():
    parser = argparse.ArgumentParser(prog='tests/bench/run', description='Measures speed and prints one table.')
    parser.add_argument('counterflex', help=argparse.SUPPRESS)
    parser.add_argument('bench', help=argparse.SUPPRESS)
    parser.add_argument('interpreter', help=argparse.SUPPRESS)
    parser.add_argument('--blocks', type=int, default=200000, help='length of the programs of whole runs [200000]')
    parser.add_argument('--long', action='store_true', help='whole runs of %d blocks too' % LONG)
    parser.add_argument('--rounds', type=int, default=3, help='whole runs of a kind, the best of which counts [3]')
    parser.add_argument('--short', action='store_true',
                        help='only the ratios to nested, which must not be below half of the quoted ones')
    parser.add_argument('--filter', default='.', help='kernels whose names match; then without whole runs')
    return parser.parse_args()


def computer():
    with open('/proc/cpuinfo', encoding='utf-8') as info:
        models = [line.split(':', 1)[1].strip() for line in info if line.startswith('model name')]
    return '%d x %s' % (len(models), models[0]) if models else platform.machine()


def say(line=''):
    print(line, flush=True)


def check(options):
    """The short form."""
    found = kernels.measure(options.bench, '/(direct|shipped|nested)$', 0.03, 5)
    for line in kernels.ratio_lines(found):
        say(line)
    with open(QUOTED, encoding='utf-8') as quoted:
        wrong = kernels.findings(found, quoted.read())
    for line in wrong:
        say('FAILED ' + line)
    return int(bool(wrong))


def kernel_table(options):
    found = kernels.measure(options.bench, options.filter, 0.1, 3)
    say('One waypoint under a milling load, processor time; text of 8 MB, read and rewritten')
    for kernel in found.values():
        say(kernel.line())
    if options.filter == '.':
        say()
        for line in kernels.ratio_lines(found):
            say(line)
    return int(any(kernel.failure for kernel in found.values()))


def main():
    options = arguments()
    if options.short:
        return check(options)
    version = subprocess.run([options.counterflex, '--version'], capture_output=True, text=True, check=True).stdout
    say('%s, %s, %s' % (version.split('\n')[0], datetime.date.today().isoformat(), computer()))
    say()
    status = kernel_table(options)
    if options.filter != '.':
        return status
    say()
    sizes = [options.blocks] + ([LONG] if options.long and options.blocks != LONG else [])
    with tempfile.TemporaryDirectory() as work:
        try:
            whole_runs.tables(options.counterflex, Reader(options.interpreter, work), sizes, work, options.rounds, say)
            small_jobs.table(options.counterflex, work, say)
        except Failed as failure:
            say('failed: %s' % failure)
            return 1
    return status


sys.exit(main())
