#!/usr/bin/env python3
"""Draws Figs 7 and 8 of Klimchik, Pashkevich, Chablat, "Stiffness modeling of non-perfect parallel manipulators":
the deviation of the Orthoglide's tip along the milling line Q2 - Q5, and its causes.

    figures.py [FOLDER]    writes figure7.svg (case A) and figure8.svg (case B) into FOLDER, default: the present one
"""
import pathlib
import sys

import numpy as np

import counterflex

SAMPLES = pathlib.Path(__file__).resolve().parent.parent
WRENCH = (215, -10, -25, 1, 21.5, 0)  # N and N m, of the paper's milling experiment
LINE_MM = np.linspace(-73.65, 126.35, 101)  # y; x and z are at -73.65


def causes_mm(machine, y_mm):
    """Deviations (n, 3) in mm at places y of the line: of assembly errors, of the load, and of both together."""
    positions = np.column_stack([np.full_like(y_mm, -73.65), y_mm, np.full_like(y_mm, -73.65)])
    poses = machine.poses(positions / 1000)
    errors = [name for name in machine.parameters if '.mount.' in name]
    perfect = machine.with_parameters(dict.fromkeys(errors, 0))
    return {
        'assembly errors': 1000 * machine.solve(poses).deviation[:, :3],
        'load': 1000 * perfect.solve(poses, WRENCH).deviation[:, :3],
        'both': 1000 * machine.solve(poses, WRENCH).deviation[:, :3],
    }


def draw(machine, title, path):
    import matplotlib
    matplotlib.use('svg')
    from matplotlib import pyplot
    figure, panels = pyplot.subplots(1, 3, figsize=(11, 3.4), sharey=True, layout='constrained')
    for cause, deviation in causes_mm(machine, LINE_MM).items():
        for panel, axis in zip(panels, range(3)):
            panel.plot(LINE_MM, deviation[:, axis], label=cause)
    for panel, axis in zip(panels, 'xyz'):
        panel.set(title=f'deviation in {axis}', xlabel='y, mm')
        panel.grid(True, alpha=0.3)
    panels[0].set_ylabel('mm')
    panels[0].legend()
    figure.suptitle(title)
    figure.savefig(path)
    pyplot.close(figure)


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else '.')
    for number, case in ((7, 'a'), (8, 'b')):
        machine = counterflex.Machine.load(SAMPLES / f'orthoglide-assembly/case_{case}.toml')
        draw(machine, f'Fig. {number}: {machine.name}, groove Q2 - Q5', folder / f'figure{number}.svg')
        ends = causes_mm(machine, LINE_MM[[0, -1]])['both'][:, 0]
        print(f'figure{number}.svg: both together in x {ends[0]:.4f} mm at Q2, {ends[1]:.4f} mm at Q5')


if __name__ == '__main__':
    main()
