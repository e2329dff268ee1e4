"""A thousand small programs: as a batch, and each by itself."""
import os
import subprocess
import time

from timing import Failed

JOBS = 1000
SAMPLE = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'samples', 'mill3')
JOBS_FILE = '''format = "counterflex-jobs 1"
output = "batch"
machine = "machine.toml"
forces = "forces.csv"
[[job]]
program = "parts/*.ngc"
'''


def run(arguments, folder):
    if subprocess.run(arguments, cwd=folder, stdout=subprocess.DEVNULL).returncode != 0:
        raise Failed(' '.join(arguments))


def seconds_of(work):
    begun = time.monotonic()
    work()
    return time.monotonic() - begun


def prepare(folder):
    os.makedirs(os.path.join(folder, 'parts'))
    for name in ('machine.toml', 'forces.csv'):
        with open(os.path.join(SAMPLE, name)) as source, open(os.path.join(folder, name), 'w') as copy:
            copy.write(source.read())
    with open(os.path.join(SAMPLE, 'pocket.ngc')) as source:
        program = source.read()
    names = ['part%d.ngc' % i for i in range(JOBS)]
    for i, name in enumerate(names):
        with open(os.path.join(folder, 'parts', name), 'w') as part:
            part.write(program.replace('S8000', 'S%d' % (8000 + i)))
    with open(os.path.join(folder, 'jobs.toml'), 'w') as jobs:
        jobs.write(JOBS_FILE)
    return names


def table(counterflex, work, say):
    """One line: the time of the batch, that of all runs one after another, and the first over the second and the cores."""
    folder = os.path.join(work, 'small_jobs')
    names = prepare(folder)
    cores = len(os.sched_getaffinity(0))
    batch = seconds_of(lambda: run([counterflex, 'batch', 'jobs.toml', '--threads', str(cores)], folder))
    alone = [counterflex, 'compensate', '-q', '-m', 'machine.toml', '-f', 'forces.csv', '--threads', '1', '-o', 'alone.ngc']
    singly = seconds_of(lambda: [run(alone + ['parts/' + name], folder) for name in names])
    say('batch of %d programs of 69 blocks on %d cores %.2f s, one after another %.2f s, ratio per core %.2f' %
        (JOBS, cores, batch, singly, batch * cores / singly))
