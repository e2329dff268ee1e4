#!/usr/bin/env python3
"""A map of the least stiffness of the Orthoglide's tip over its workspace.

    stiffness_map.py [COUNT [FIGURE.svg]]    COUNT places along each side, default 100
"""
import pathlib
import sys

import numpy as np

import counterflex

SAMPLES = pathlib.Path(__file__).resolve().parent.parent


def least_stiffness(machine, positions):
    """The least force over motion in any direction (N/µm) at positions (n, 3) in m; NaN where it is not solved."""
    compliance = machine.compliance(machine.poses(positions))[:, :3, :3]
    solved = np.isfinite(compliance).all(axis=(1, 2))
    least = np.full(len(positions), np.nan)
    least[solved] = 1e-6 / np.linalg.norm(compliance[solved], 2, axis=(1, 2))
    return least


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    machine = counterflex.Machine.load(SAMPLES / 'orthoglide-groove/machine.toml')
    side = np.linspace(-0.07365, 0.12635, count)
    x, y = np.meshgrid(side, side)
    positions = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, -0.07365)])
    least = least_stiffness(machine, positions)
    softest, stiffest = np.nanargmin(least), np.nanargmax(least)
    print(f'{machine.name}: {len(least)} places at z = -73.65 mm, {np.isfinite(least).sum()} solved')
    for word, at in (('least', softest), ('most', stiffest)):
        print('{} {:.3f} N/µm at x {:.2f}, y {:.2f} mm'.format(word, least[at], *(1000 * positions[at, :2])))
    if len(sys.argv) > 2:
        import matplotlib
        matplotlib.use('svg')
        from matplotlib import pyplot
        filled = pyplot.contourf(1000 * side, 1000 * side, least.reshape(x.shape), 20)
        pyplot.colorbar(filled, label='least stiffness, N/µm')
        pyplot.gca().set(xlabel='x, mm', ylabel='y, mm', aspect='equal')
        pyplot.savefig(sys.argv[2])


if __name__ == '__main__':
    main()
