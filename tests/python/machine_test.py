"""Machines on arrays: solve, targets, stiffness, parameters, errors, threads."""
import threading
import unittest

import numpy as np

import counterflex
from support import MILLING, SAMPLES, sample

Q2, Q5 = (-0.07365, -0.07365, -0.07365), (-0.07365, 0.12635, -0.07365)


def positions(count, seed=1, least=-0.07, most=0.12):
    return np.random.default_rng(seed).uniform(least, most, (count, 3))


def close_positions(count, seed=1):
    """In a small box: most of the time of a call that solves few places far from each other is that of their starts."""
    return positions(count, seed, 0, 0.02)


class Solving(unittest.TestCase):
    def test_the_deviation_is_that_of_analyze(self):
        machine = sample('orthoglide-assembly/case_a.toml')
        solved = machine.solve(machine.poses([Q2, Q5]), MILLING)
        self.assertEqual(list(solved.status), ['converged', 'converged'])
        # quoted by samples/orthoglide-groove/README.md
        np.testing.assert_allclose(1000 * solved.deviation[:, :3], [[2.3752, 2.1153, 2.0405], [0.7474, 1.1482, 0.3642]], atol=5.1e-5)
        np.testing.assert_allclose(np.degrees(solved.deviation[0, 3:]), [-0.0254, 0.3711, -0.0803], atol=5.1e-5)

    def test_the_pose_is_the_wanted_one_and_the_deviation(self):
        machine = sample('orthoglide-assembly/case_b.toml')
        poses = machine.poses(positions(20))
        solved = machine.solve(poses, MILLING)
        np.testing.assert_allclose(solved.pose[:, :3, 3], poses[:, :3, 3] + solved.deviation[:, :3], atol=1e-12)

    def test_a_commanded_target_has_the_tip_at_the_wanted_pose(self):
        for path, places in (('orthoglide-assembly/case_b.toml', positions(20)), ('mill3/machine.toml', positions(5) + (0.2, 0.1, -0.3))):
            machine = sample(path)
            poses = machine.poses(places)
            targets = machine.targets(poses, MILLING)
            self.assertEqual(set(targets.status), {'converged'}, path)
            reached = machine.solve(targets.pose, MILLING)
            np.testing.assert_allclose(reached.pose[:, :3, 3], poses[:, :3, 3], atol=1e-9)
            np.testing.assert_allclose(reached.actuators, targets.actuators, atol=1e-9)

    def test_a_robot_is_corrected_in_its_orientation_too(self):
        machine = sample('robot-spindle/machine.toml')
        poses = np.repeat(machine.home[None], 3, axis=0)
        poses[:, 0, 3] += (0, 0.02, 0.04)
        turn = np.radians(3)
        poses[:, :3, :3] = poses[:, :3, :3] @ [[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]]
        wrench = (50, -30, -20, 1, 0, 0.5)
        before = machine.solve(poses, wrench)
        self.assertGreater(np.abs(before.deviation[:, 3:]).max(), 1e-5)
        targets = machine.targets(poses, wrench)
        self.assertEqual(set(targets.status), {'converged'})
        np.testing.assert_allclose(machine.solve(targets.pose, wrench).pose, poses, atol=1e-9)

    def test_a_pose_outside_of_the_workspace_is_a_status_and_nan(self):
        machine = sample('mill3/machine.toml')
        solved = machine.solve(machine.poses([(0.2, 0.1, -0.3), (9, 0, 0)]))
        self.assertEqual(list(solved.status), ['converged', 'outside_travel'])
        self.assertTrue(np.isfinite(solved.deviation[0]).all() and np.isnan(solved.deviation[1]).all())
        self.assertTrue(np.isnan(machine.stiffness(machine.poses([(9, 0, 0)]))).all())

    def test_no_pose_gives_no_row(self):
        machine = sample('mill3/machine.toml')
        none = np.empty((0, 4, 4))
        self.assertEqual(machine.solve(none).deviation.shape, (0, 6))
        self.assertEqual(machine.stiffness(none).shape, (0, 6, 6))

    def test_the_result_does_not_depend_on_threads_or_neighbours(self):
        machine = sample('orthoglide-assembly/case_b.toml')
        poses = machine.poses(close_positions(300))
        one, two = machine.solve(poses, MILLING, threads=1), machine.solve(poses, MILLING, threads=2)
        alone = counterflex.Machine.load(machine.path).solve(poses[70:71], MILLING)
        np.testing.assert_array_equal(one.pose, two.pose)
        np.testing.assert_array_equal(one.pose[70], alone.pose[0])


class Stiffness(unittest.TestCase):
    def test_the_compliance_is_the_change_of_the_tip_with_the_wrench(self):
        step = np.diag([1, 1, 1, 0.1, 0.1, 0.1])
        for path, at in (('orthoglide-assembly/case_b.toml', Q5), ('mill3/machine.toml', (0.2, 0.1, -0.3))):
            machine = sample(path)
            pose = machine.poses([at])
            poses = np.repeat(pose, 6, axis=0)
            change = machine.solve(poses, MILLING + step).deviation - machine.solve(poses, MILLING - step).deviation
            expected = (change / (2 * np.diag(step))[:, None]).T
            found = machine.compliance(pose, MILLING)[0]
            # deviations are rotation vectors of finite size: their change is that of the orientation to first order
            np.testing.assert_allclose(found[:3], expected[:3], atol=1e-5 * np.abs(expected[:3]).max())
            np.testing.assert_allclose(machine.stiffness(pose, MILLING)[0] @ found, np.eye(6), atol=1e-7)


class Parameters(unittest.TestCase):
    def test_changed_parameters_are_a_changed_file(self):
        text = (SAMPLES / 'orthoglide-assembly/case_a.toml').read_text()
        machine = counterflex.Machine.from_text(text)
        half = machine.with_parameters({f'{axis}.mount.x_mm': 0.5 for axis in 'xyz'})
        file = counterflex.Machine.from_text(text.replace('xyz_mm = [1, 0, 0]', 'xyz_mm = [0.5, 0, 0]'))
        poses = machine.poses(positions(10))
        np.testing.assert_array_equal(half.solve(poses, MILLING).deviation, file.solve(poses, MILLING).deviation)
        self.assertEqual(half.parameters['y.mount.x_mm'], 0.5)
        self.assertEqual(machine.parameters['y.mount.x_mm'], 1)  # the machine itself stays

    def test_a_perfect_machine_without_load_has_no_deviation(self):
        machine = sample('orthoglide-assembly/case_b.toml')
        perfect = machine.with_parameters({name: 0 for name in machine.parameters if '.mount.' in name})
        self.assertGreater(np.abs(machine.solve(machine.poses([Q2])).deviation).max(), 1e-4)
        self.assertLess(np.abs(perfect.solve(machine.poses([Q2])).deviation).max(), 1e-12)

    def test_wrong_parameters_raise(self):
        machine = sample('orthoglide-assembly/case_a.toml')
        for changes, words in (({'x.mount.x_m': 1}, "did you mean 'x.mount.x_mm'?"), ({'x.mount.x_mm': np.nan}, 'must be finite'),
                               ({'x.foot.compliance_m_per_N': 0}, 'must be above 0')):
            with self.assertRaisesRegex(ValueError, words.replace('?', r'\?')):
                machine.with_parameters(changes)


class Errors(unittest.TestCase):
    def test_bad_machine_files_raise_with_their_place(self):
        with self.assertRaises(counterflex.InputError) as raised:
            counterflex.Machine.from_text('format = "counterflex-machine 1"\nname = "m"\nspeed = 3\n', 'bad.toml')
        error = raised.exception
        self.assertEqual((error.file, error.line, error.column), ('bad.toml', 3, 1))
        self.assertTrue(str(error).startswith('bad.toml:3:1: error: '), str(error))
        self.assertIsInstance(error, ValueError)

    def test_files_that_cannot_be_read_raise(self):
        for path in ('no-such.toml', '/'):
            with self.assertRaises(counterflex.InputError) as raised:
                counterflex.Machine.load(path)
            self.assertEqual((raised.exception.file, raised.exception.line), (path, None))

    def test_wrong_arrays_raise(self):
        machine = sample('mill3/machine.toml')
        pose = machine.poses([(0.2, 0.1, -0.3)])
        mirrored, tall = pose.copy(), pose.copy()
        mirrored[0, 0, 0] = -1
        tall[0, 3, 3] = 2
        infinite = pose.copy()
        infinite[0, 1, 3] = np.inf
        for wrong, words in ((pose[0], r'shape \(4, 4\), must be \(n, 4, 4\)'), (np.zeros((3, 3)), r'must be \(n, 4, 4\)'),
                             (infinite, r'poses\[0, 1, 3\] is inf'), (mirrored, r'poses\[0\] is not a pose'),
                             (tall, r'poses\[0\] is not a pose'), ('text', ''), ([[1, 2], [3]], ''), (1j * pose, 'must be real')):
            for call in (machine.solve, machine.targets, machine.stiffness, machine.compliance):
                with self.assertRaisesRegex(ValueError, words):
                    call(wrong)
        for wrong, words in ((np.zeros((1, 3)), r'must be \(n, 6\)'), (np.zeros((2, 6)), '2 wrenches and 1 poses'),
                             ([0, 0, np.nan, 0, 0, 0], 'must be finite')):
            with self.assertRaisesRegex(ValueError, words):
                machine.solve(pose, wrong)
        with self.assertRaisesRegex(ValueError, r'must be \(n, 3\)'):
            machine.poses([0, 0, 0])
        with self.assertRaisesRegex(ValueError, 'threads is 0'):
            machine.solve(pose, threads=0)


class Threads(unittest.TestCase):
    def test_threads_solve_at_once_and_get_what_one_gets(self):
        machine = sample('orthoglide-assembly/case_b.toml')
        sets = [machine.poses(close_positions(2000, seed)) for seed in (1, 2)]
        shared = counterflex.Machine.load(machine.path)  # its table of starts is empty
        found = [None, None]
        both = threading.Barrier(2)

        def solve(i):
            both.wait()
            found[i] = (shared.solve(sets[i], MILLING, threads=1).pose, shared.stiffness(sets[i][:50], threads=1))
        threads = [threading.Thread(target=solve, args=(i,)) for i in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for poses, (pose, stiffness) in zip(sets, found):
            np.testing.assert_array_equal(pose, machine.solve(poses, MILLING, threads=1).pose)
            np.testing.assert_array_equal(stiffness, machine.stiffness(poses[:50], threads=1))

    def test_python_runs_while_a_call_solves(self):
        machine = sample('orthoglide-assembly/case_b.toml')
        poses = machine.poses(close_positions(100))
        solver = threading.Thread(target=machine.stiffness, args=(poses,), kwargs={'threads': 1})
        solver.start()
        steps = 0
        while solver.is_alive():
            steps += 1
        self.assertGreater(steps, 1000)


if __name__ == '__main__':
    unittest.main()
