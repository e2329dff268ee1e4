"""Runs of programs in memory are those of the commands."""
import concurrent.futures
import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import counterflex
from support import MILLING, PROGRAM, SAMPLES, sample

GROOVE = SAMPLES / 'orthoglide-groove'
PLAIN = {name: value for name, value in os.environ.items() if not name.startswith('COUNTERFLEX_')}
TEXT = (GROOVE / 'groove.ngc').read_bytes()


def run_command(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], cwd=GROOVE, check=True, capture_output=True, env=PLAIN)


class Compensating(unittest.TestCase):
    def setUp(self):
        self.machine = sample('orthoglide-groove/machine.toml')
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_the_text_and_the_report_are_those_of_the_command(self):
        out = self.folder / 'out'
        run_command('compensate', 'groove.ngc', '-m', 'machine.toml', '-o', f'{out}.ngc', '--report', out, '--tolerance-mm', 0.01)
        text, report = counterflex.compensate(TEXT, self.machine, name='groove.ngc', tolerance_mm=0.01)
        self.assertEqual(text, (self.folder / 'out.ngc').read_bytes())
        document = json.loads((self.folder / 'out.json').read_text())
        for key in ('verdict', 'summary', 'blocks', 'forces', 'warnings', 'worst'):
            self.assertEqual(report.data[key], document[key], key)
        with open(self.folder / 'out.csv', newline='') as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(report.waypoints), len(rows))
        self.assertEqual(report.waypoints.dtype.names, tuple(rows[0]))
        for name in rows[0]:
            if name == 'status':
                self.assertEqual(list(report.waypoints[name]), [row[name] for row in rows])
            else:
                expected = [float(row[name]) if row[name] else math.nan for row in rows]
                np.testing.assert_array_equal(report.waypoints[name].astype(float), expected, name)

    def test_a_text_stays_a_text(self):
        text, report = counterflex.compensate(TEXT.decode(), self.machine, causes=False)
        self.assertEqual(report.verdict, 'OK')
        self.assertEqual(repr(report), f'<counterflex.Report OK, {len(report.waypoints)} waypoints>')
        self.assertIsInstance(text, str)
        self.assertEqual(text.encode(), counterflex.compensate(TEXT, self.machine, causes=False).text)
        self.assertTrue(np.isnan(report.waypoints['geometry_dx_mm']).all())
        self.assertTrue(all(worst['text'] for worst in report.data['worst']))

    def test_nothing_is_written_without_success(self):
        text, report = counterflex.compensate(TEXT, self.machine, max_correction_mm=0.1)
        self.assertIsNone(text)
        self.assertEqual(report.verdict, 'FAILED')
        self.assertEqual((report.data['failure']['line'], report.data['failure']['exit']), (7, 6))
        plain = counterflex.compensate(TEXT, self.machine, causes=False, max_correction_mm=0.1).report
        self.assertEqual(plain.data['failure'], report.data['failure'])

    def test_the_header_names_the_changed_machine(self):
        other = self.machine.with_parameters({'x.mount.rx_deg': 0.9})
        first, second = (counterflex.compensate(TEXT, machine, causes=False).text for machine in (self.machine, other))
        hashes = [next(line for line in text.splitlines() if b'MACHINE' in line) for text in (first, second)]
        self.assertNotEqual(*hashes)

    def test_forces_are_a_wrench_or_files(self):
        plain = b'\n'.join(line for line in TEXT.split(b'\n') if b'FORCE' not in line)
        by_wrench = counterflex.predict(plain, self.machine, MILLING)
        by_option = counterflex.predict(plain, self.machine, force='215,-10,-25,1,21.5,0')
        self.assertEqual(by_wrench.waypoints.tobytes(), by_option.waypoints.tobytes())
        self.assertEqual(by_wrench.verdict, 'PREDICTED')
        by_numbers = counterflex.predict(plain, self.machine, force=MILLING)
        self.assertEqual(by_wrench.waypoints.tobytes(), by_numbers.waypoints.tobytes())
        with self.assertRaisesRegex(counterflex.InputError, 'both are given for the whole program'):
            counterflex.predict(plain, self.machine, MILLING, force='1,2,3')
        slot = SAMPLES / 'orthoglide-slot'
        by_file = counterflex.predict((slot / 'slot.ngc').read_bytes(), self.machine, slot / 'forces.toml')
        self.assertGreater(by_file.data['forces']['largest_N'], 30)

    def test_verify_judges_the_text(self):
        text = counterflex.compensate(TEXT, self.machine).text
        self.assertEqual(counterflex.verify(TEXT, text, self.machine).verdict, 'OK')
        report = counterflex.verify(TEXT, text.replace(b'Y126.728', b'Y126.828'), self.machine)
        self.assertNotEqual(report.verdict, 'OK')
        other = self.machine.with_parameters({'x.mount.rx_deg': 1.0000001})
        self.assertTrue(any('machine' in warning for warning in counterflex.verify(TEXT, text, other).warnings))

    def test_warnings_are_those_of_the_command(self):
        cover = SAMPLES / 'orthoglide-cover/cover.ngc'
        done = run_command('predict', '../orthoglide-cover/cover.ngc', '-m', 'machine.toml', '--force=0,0,0')
        report = counterflex.predict(cover.read_bytes(), self.machine, (0, 0, 0), name='../orthoglide-cover/cover.ngc')
        self.assertEqual(report.warnings, done.stderr.decode().splitlines())
        self.assertIn('warning: G64', report.warnings[0])

    def test_bad_input_raises_with_its_place(self):
        with self.assertRaises(counterflex.InputError) as raised:
            counterflex.predict('G21 G90\nG1 X1 F100\nG1 X=#7\n', self.machine, name='bad.ngc', dialect='fanuc')
        self.assertEqual((raised.exception.file, raised.exception.line), ('bad.ngc', 3))
        for call, words in ((lambda: counterflex.predict(TEXT, self.machine, tolerance_mm=-1), 'tolerance_mm is'),
                            (lambda: counterflex.predict(TEXT, self.machine, tolerance_mm=math.nan), 'tolerance_mm is'),
                            (lambda: counterflex.predict(TEXT, self.machine, 'no-such.csv'), 'no-such.csv'),
                            (lambda: counterflex.predict(TEXT, self.machine, [1, 2]), 'wrench of 3 or 6'),
                            (lambda: counterflex.predict(TEXT, self.machine, [1, 2, math.nan]), 'wrench of 3 or 6')):
            with self.assertRaisesRegex(ValueError, words):
                call()
        with self.assertRaisesRegex(TypeError, 'a text is str or bytes, not int'):
            counterflex.predict(5, self.machine)
        for option in ('tolerance', 'output', 'max_points'):
            with self.assertRaisesRegex(TypeError, f"unknown option '{option}'"):
                counterflex.predict(TEXT, self.machine, **{option: 1})

    def test_bytes_that_are_not_utf8_stay(self):
        text = counterflex.compensate(TEXT.replace(b'CUTTER', b'FR\xc4SER'), self.machine, causes=False).text
        self.assertIn(b'(FR\xc4SER 8 MM,', text)

    def test_threads_run_programs_at_once(self):
        tolerances = (0.01, 0.005, 0.002)
        alone = [counterflex.compensate(TEXT, self.machine, tolerance_mm=tolerance).text for tolerance in tolerances]
        with concurrent.futures.ThreadPoolExecutor(3) as pool:
            runs = [pool.submit(counterflex.compensate, TEXT, self.machine, tolerance_mm=tolerance) for tolerance in tolerances]
        self.assertEqual([run.result().text for run in runs], alone)

    def test_nothing_is_printed(self):
        code = ('import counterflex, pathlib; machine = counterflex.Machine.load("machine.toml"); '
                'counterflex.compensate(pathlib.Path("../orthoglide-cover/cover.ngc").read_bytes(), machine, (0, 0, 0))')
        done = subprocess.run([sys.executable, '-c', code], cwd=GROOVE, check=True, capture_output=True)
        self.assertEqual((done.stdout, done.stderr), (b'', b''))


AXIS = '''format = "counterflex-machine 1"
name = "axis"
controlled = ["x", "y", "z"]

[error_tables.x]
positions_mm = [0, 100, 200, 300]
EXX_um = [0, 0, 0, 0]
sigma_um = 20

[parameters]
"X.error[0]_um" = { sigma = 0, source = "prior" }

[[chain]]
name = "serial"
elements = [
  { actuator = "prismatic", axis = "x", min_mm = 0, max_mm = 300, error_table = "x" },
  { actuator = "prismatic", axis = "y", min_mm = 0, max_mm = 300 },
  { actuator = "prismatic", axis = "z", min_mm = 0, max_mm = 300 },
]
'''


class Identifying(unittest.TestCase):
    def test_the_identified_machine_has_the_measured_errors(self):
        errors_um = (0, 4, 12, 18)
        rows = ['kind,session,axis,position_mm,deviation_um,direction,sigma_um']
        for run in range(6):
            for k, error in enumerate(errors_um):
                rows.append(f'axis_table,laser,X,{100 * k},{error + 3 + (1 if (run + k) % 2 else -1)},0,1')
        machine = counterflex.Machine.from_text(AXIS, 'axis.toml')
        with tempfile.TemporaryDirectory() as folder:
            data = pathlib.Path(folder, 'laser.csv')
            data.write_text('\n'.join(rows) + '\n')
            earlier = '# Identified by counterflex 0.0.1 from other.csv\n' + AXIS.lstrip()
            found = counterflex.identify(counterflex.Machine.from_text(earlier, 'axis.toml'), data)
            with self.assertRaises(counterflex.InputError) as raised:
                counterflex.identify(machine, [pathlib.Path(folder, 'none.csv')])
            self.assertTrue(raised.exception.file.endswith('none.csv'))
            with self.assertRaisesRegex(counterflex.InputError, 'fit'):
                counterflex.identify(machine, data, fit='everything')
        values = [found.machine.parameters[f'X.error[{100 * k}]_um'] for k in range(4)]
        np.testing.assert_allclose(values, errors_um, atol=2)
        self.assertEqual(found.data['schema'], 'counterflex-identification 1')
        again = counterflex.Machine.from_text(found.text)
        self.assertEqual(again.parameters, found.machine.parameters)
        self.assertRegex(found.text, r'\A# Identified by counterflex \S+ from laser\.csv\n')
        self.assertEqual(found.text.count('# Identified by'), 1)
        poses = machine.poses([(0.2, 0, 0)])
        self.assertAlmostEqual(1e6 * found.machine.solve(poses).deviation[0, 0], values[2], places=6)
        self.assertEqual(machine.parameters['X.error[200]_um'], 0)


if __name__ == '__main__':
    unittest.main()
