#!/usr/bin/env python3
"""What the Python module adds to the time of the kernel: processor time of its calls over that of `counterflex map`, which solves the
same places. Both on one thread, in turns; the least of three. The ratios are to be at most 1.2.

    PYTHONPATH=build/release/python python_ratio.py COUNTERFLEX [PLACES]    default 10000
"""
import math
import pathlib
import resource
import subprocess
import sys
import time

import numpy as np

import counterflex

MACHINE = pathlib.Path(__file__).resolve().parents[2] / 'samples/orthoglide-groove/machine.toml'
BOX_MM = (-73.65, -73.65, -73.65, 126.35, 126.35, -73.65)


def seconds_of_map(program, quantity, side):
    used = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    grid = [f'--grid={side},{side},1', '--box=' + ','.join(map(str, BOX_MM))]
    subprocess.run([program, 'map', '-m', MACHINE, quantity, *grid, '--threads=1'], check=True, stdout=subprocess.DEVNULL)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - used


def seconds_of_module(call, side):
    x, y = (np.linspace(BOX_MM[k], BOX_MM[k + 3], side) / 1000 for k in (0, 1))
    places = np.array([(px, py, BOX_MM[2] / 1000) for py in y for px in x])
    begun = time.process_time()
    machine = counterflex.Machine.load(MACHINE)
    call(machine, machine.poses(places))
    return time.process_time() - begun


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    side = math.isqrt(int(sys.argv[2]) if len(sys.argv) > 2 else 10000)
    calls = {'--stiffness': lambda machine, poses: machine.stiffness(poses, threads=1),
             '--deviation': lambda machine, poses: machine.solve(poses, threads=1)}
    worst = 0
    for quantity, call in calls.items():
        rounds = [(seconds_of_map(sys.argv[1], quantity, side), seconds_of_module(call, side)) for _ in range(3)]
        of_map, of_module = (min(times) for times in zip(*rounds))
        worst = max(worst, of_module / of_map)
        print(f'{quantity[2:]:10} {side * side} places: map {of_map:.3f} s, module {of_module:.3f} s, ratio {of_module / of_map:.2f}')
    sys.exit(0 if worst <= 1.2 else 1)


if __name__ == '__main__':
    main()
