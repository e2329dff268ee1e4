"""Results of Google Benchmark as lines of text, and the ratio of nested to the other ways of solving a waypoint."""
import json
import re
import subprocess
import sys

MACHINES = ('orthoglide', 'hexapod', 'robot_6r', 'mill')
WAYS = ('direct', 'shipped')
RATIO_TITLE = 'Of the time of nested, a waypoint takes'
LANES = {'AVX-512': 8, 'AVX2': 4, 'SSE2': 2, 'plain': 2}  # waypoints in one vector, by the label of `shipped`
IN_US = {'ns': 1e-3, 'us': 1.0, 'ms': 1e3, 's': 1e6}


class Kernel:
    """Least processor time in us of several repetitions, an item where there are several in one go."""

    def __init__(self, name):
        self.name, self.us, self.steps, self.rate, self.failure, self.label = name, float('inf'), None, None, '', ''

    def take(self, result):
        if result.get('error_occurred'):
            self.failure = result['error_message']
            return
        items = result.get('items', 1)
        us = result['cpu_time'] * IN_US[result['time_unit']] / items
        if us > self.us:
            return
        self.us, self.steps, self.label = us, result.get('steps'), result.get('label', '')
        self.rate = result.get('bytes_per_second', 0) / 1e6

    def line(self):
        if self.failure:
            return '%-32s failed: %s' % (self.name, self.failure)
        if self.rate:
            return '%-36s %6.0f MB/s' % (self.name, self.rate)
        steps = '   %4.1f iterations' % self.steps if self.steps else ''
        return ('%-32s %10.2f us%s   %s' % (self.name, self.us, steps, self.label)).rstrip()


def run(bench, *arguments):
    done = subprocess.run([bench, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        sys.exit('%s: exit status %d: %s' % (bench, done.returncode, done.stderr[-300:]))
    return done.stdout


def measure(bench, names, seconds, repetitions):
    """Kernels by name, of those that match the expression `names`; their repetitions are in turns, of so many seconds."""
    filtered = '--benchmark_filter=' + names
    kernels = {name: Kernel(name) for name in run(bench, filtered, '--benchmark_list_tests').split()}
    printed = run(bench, filtered, '--benchmark_format=json', '--benchmark_enable_random_interleaving=true',
                  '--benchmark_min_time=%g' % seconds, '--benchmark_repetitions=%d' % repetitions)
    for result in json.loads(printed)['benchmarks']:
        if result.get('run_type') != 'aggregate':
            kernels[result['run_name']].take(result)
    return kernels


def speed_up(kernels, machine, way):
    """How many times as long nested takes, or None."""
    nested, other = (kernels.get('%s/%s' % (machine, name)) for name in ('nested', way))
    if nested is None or other is None or nested.failure or other.failure:
        return None
    return nested.us / other.us


def ratio_lines(kernels):
    yield '%-40s %10s %10s' % (RATIO_TITLE, *WAYS)
    for machine in MACHINES:
        found = [speed_up(kernels, machine, way) for way in WAYS]
        yield '%-40s %10s %10s' % (machine, *('-' if r is None else '1/%.1f' % r for r in found))


def quoted_speed_ups(text):
    """The ratios in the output of `ratio_lines`, by machine and way."""
    lines = text.splitlines()
    at = next(i for i, line in enumerate(lines) if line.startswith(RATIO_TITLE))
    quoted = {}
    for line in lines[at + 1:at + 1 + len(MACHINES)]:
        machine, *values = line.split()
        for way, value in zip(WAYS, values):
            found = re.fullmatch(r'1/([0-9.]+)', value)
            if found:
                quoted[machine, way] = float(found.group(1))
    return quoted


def quoted_lanes(text):
    """The instructions with which the quoted table was measured."""
    return next((name for name in LANES if re.search(r'/shipped .* %s$' % re.escape(name), text, re.MULTILINE)), None)


def fewer_lanes(kernels, quoted_text, machine, way):
    """The share of the quoted lanes that this computer has, where they matter."""
    now, was = kernels['%s/%s' % (machine, way)].label, quoted_lanes(quoted_text)
    return min(1, LANES[now] / LANES[was]) if way == 'shipped' and now in LANES and was else 1


def findings(kernels, quoted_text):
    """Kernels that are less than half as fast, compared with nested, as quoted (shipped: for as many lanes); those that failed or are not quoted."""
    wrong = [kernel.line() for kernel in kernels.values() if kernel.failure]
    quoted = quoted_speed_ups(quoted_text)
    if set(quoted) != {(machine, way) for machine in MACHINES for way in WAYS}:
        wrong.append('the quoted table lacks a ratio')
    for (machine, way), was in quoted.items():
        now = speed_up(kernels, machine, way)
        if now is None:
            wrong.append('%s/%s was not measured' % (machine, way))
        elif now < was / 2 * fewer_lanes(kernels, quoted_text, machine, way):
            wrong.append('%s: %s takes 1/%.1f of the time of nested, quoted is 1/%.1f' % (machine, way, now, was))
    return wrong
