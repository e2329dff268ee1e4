"""The scripts of samples/python draw and print what the samples' pages quote."""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np

from support import PROGRAM, SAMPLES, SOURCE, sample

sys.path.insert(0, str(SAMPLES / 'python'))
import figures
import monte_carlo
import stiffness_map

ROW = re.compile(r'^y +(\S+) +x: assembly +(\S+), load +(\S+), together +(\S+) +z: assembly +(\S+)$', re.M)


def run_script(name, *arguments, folder='.'):
    done = subprocess.run([sys.executable, SAMPLES / 'python' / name, *arguments], cwd=folder, check=True, capture_output=True, text=True)
    return done.stdout


class Figures(unittest.TestCase):
    def test_the_curves_of_the_figures_are_those_of_the_groove(self):
        page = (SAMPLES / 'orthoglide-groove/README.md').read_text()
        rows = np.array(ROW.findall(page), dtype=float)
        self.assertEqual(len(rows), 12)
        for case, quoted in (('b', rows[:6]), ('a', rows[6:])):
            causes = figures.causes_mm(sample(f'orthoglide-assembly/case_{case}.toml'), quoted[:, 0])
            curves = [causes['assembly errors'][:, 0], causes['load'][:, 0], causes['both'][:, 0], causes['assembly errors'][:, 2]]
            np.testing.assert_allclose(np.transpose(curves), quoted[:, 1:], atol=1e-4)

    def test_figures_are_drawn(self):
        try:
            import matplotlib  # noqa: F401
        except ImportError:
            self.skipTest('matplotlib is not installed')
        with tempfile.TemporaryDirectory() as folder:
            printed = run_script('figures.py', folder=folder)
            self.assertIn('in x 2.3752 mm at Q2, 0.7474 mm at Q5', printed)
            self.assertIn('in x -0.5560 mm at Q2, 0.1021 mm at Q5', printed)
            for name in ('figure7.svg', 'figure8.svg'):
                self.assertIn('<svg', pathlib.Path(folder, name).read_text()[:1000])


class MonteCarlo(unittest.TestCase):
    def test_the_scatter_grows_with_the_lever(self):
        machine = sample('mill3/machine.toml')
        places = [(0.2, 0.05, -0.3), (0.2, 0.20, -0.3)]
        deviations = monte_carlo.drawn_deviations(machine, places, 50, np.random.default_rng(1))
        self.assertEqual(deviations.shape, (50, 2))
        self.assertGreater(deviations.std(axis=0).min(), 0.001)
        self.assertIn('50 machines', run_script('monte_carlo.py', '50'))


class StiffnessMap(unittest.TestCase):
    def test_the_least_stiffness_is_that_of_the_map_command(self):
        machine = sample('orthoglide-groove/machine.toml')
        home = stiffness_map.least_stiffness(machine, np.zeros((1, 3)))
        done = subprocess.run([PROGRAM, 'map', '-m', machine.path, '--box', '0,0,0,0,0,0', '--json'], check=True, capture_output=True)
        self.assertAlmostEqual(home[0], json.loads(done.stdout)['best']['value'], places=4)
        self.assertIn('16 solved', run_script('stiffness_map.py', '4'))


class Guide(unittest.TestCase):
    def test_the_code_of_the_page_runs(self):
        page = (SOURCE / 'programs/guide/python.md').read_text()
        blocks = re.findall(r'^```python\n(.*?)^```', page, re.M | re.S)
        self.assertEqual(len(blocks), 3)
        subprocess.run([sys.executable, '-c', '\n'.join(blocks)], cwd=SOURCE, check=True)


if __name__ == '__main__':
    unittest.main()
