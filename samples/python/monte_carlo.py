#!/usr/bin/env python3
"""Monte Carlo: how the squareness of a mill's axes scatters the deviation over its workspace.

Each draw is the machine with other parameters. No machine file is written.

    monte_carlo.py [DRAWS]    default 200
"""
import pathlib
import sys

import numpy as np

import counterflex

SAMPLES = pathlib.Path(__file__).resolve().parent.parent
SIGMA_DEG = 0.005  # of each squareness
FORCE = (120, -60, 40, 0, 0, 0)  # N, at the tip


def drawn_deviations(machine, positions, draws, generator):
    """Norms (draws, n) of the tip's deviation in mm at positions (n, 3) in m."""
    names = ['y_to_x.rz_deg', 'z_to_y.rx_deg', 'z_to_y.ry_deg']
    mean = np.array([machine.parameters[name] for name in names])
    poses = machine.poses(positions)
    found = []
    for values in generator.normal(mean, SIGMA_DEG, (draws, len(names))):
        solved = machine.with_parameters(dict(zip(names, values))).solve(poses, FORCE)
        found.append(1000 * np.linalg.norm(solved.deviation[:, :3], axis=1))
    return np.array(found)


def main():
    draws = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    machine = counterflex.Machine.load(SAMPLES / 'mill3/machine.toml')
    grid = np.meshgrid([0.1, 0.2, 0.3], [0.05, 0.125, 0.2], [-0.35, -0.25])
    positions = np.column_stack([axis.ravel() for axis in grid])
    deviations = drawn_deviations(machine, positions, draws, np.random.default_rng(7))
    worst = deviations.max(axis=1)
    print(f'{machine.name}: {draws} machines, {len(positions)} places each')
    print('largest deviation over the places: median {:.4f} mm, 95 % below {:.4f} mm'.format(*np.percentile(worst, [50, 95])))


if __name__ == '__main__':
    main()
