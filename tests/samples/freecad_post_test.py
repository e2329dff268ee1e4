"""The post-processor for FreeCAD with replacements of FreeCAD's own.   freecad_post_test.py WORK_FOLDER

The working folder is samples/pipeline; WORK_FOLDER/alone has what counterflex makes of its parts.
"""

import os
import sys
import types
import unittest

work = sys.argv.pop(1)
sys.path.insert(0, os.getcwd())
sys.dont_write_bytecode = True
import counterflex_post

OPTIONS = '--compensate "-m ../mill3/machine.toml --force=60,-30,-40"'


def read(path):
    with open(path, newline="") as file:
        return file.read()


class FakePost(types.ModuleType):
    """NAME_post, which creates the program `path` and records its arguments."""

    def __init__(self, name, path, returns=True, writes=False):
        super().__init__(f"{name}_post")
        self.path, self.returns, self.writes, self.asked = path, returns, writes, None
        sys.modules[self.__name__] = self

    def export(self, objectslist, filename, argstring):
        self.asked = objectslist, argstring
        text = read(self.path)
        if self.writes:
            with open(filename, "w", newline="") as file:
                file.write(text)
        return text if self.returns else None


class TheWrapper(unittest.TestCase):
    def setUp(self):
        self.out = os.path.join(work, "posted.ngc")
        self.expected = read(os.path.join(work, "alone", "plate.ngc"))
        if os.path.exists(self.out):
            os.remove(self.out)

    def test_returns_the_corrected_program_and_writes_it(self):
        FakePost("linuxcnc", "parts/plate.ngc")
        self.assertEqual(counterflex_post.export(["job"], self.out, OPTIONS), self.expected)
        self.assertEqual(read(self.out), self.expected)
        self.assertFalse(os.path.exists(self.out + ".part"))

    def test_writes_nothing_where_freecad_writes(self):
        FakePost("linuxcnc", "parts/plate.ngc")
        self.assertEqual(counterflex_post.export(["job"], "-", OPTIONS), self.expected)
        self.assertFalse(os.path.exists("-"))

    def test_takes_the_program_of_a_post_that_only_writes_it(self):
        FakePost("older", "parts/plate.ngc", returns=False, writes=True)
        self.assertEqual(counterflex_post.export(["job"], "-", "--post older " + OPTIONS), self.expected)

    def test_passes_other_arguments_on_and_opens_no_editor(self):
        post = FakePost("linuxcnc", "parts/plate.ngc")
        counterflex_post.export(["a", "b"], "-", "--no-header --preamble 'G17 G90' " + OPTIONS)
        self.assertEqual(post.asked, (["a", "b"], "--no-show-editor --no-header --preamble 'G17 G90'"))

    def test_fails_loudly_and_leaves_the_program_of_before(self):
        FakePost("linuxcnc", os.path.join(work, "alone", "plate.ngc"))  # corrected already
        with open(self.out, "w") as file:
            file.write("kept")
        with self.assertRaisesRegex(RuntimeError, "status 3.*header of a corrected program"):
            counterflex_post.export(["job"], self.out, OPTIONS)
        self.assertEqual(read(self.out), "kept")

    def test_says_that_a_post_makes_no_program(self):
        FakePost("silent", "parts/plate.ngc", returns=False)
        with self.assertRaisesRegex(RuntimeError, "made no program"):
            counterflex_post.export(["job"], "-", "--post silent " + OPTIONS)

    def test_says_that_a_post_is_no_script(self):
        sys.modules["classy_post"] = types.ModuleType("classy_post")
        with self.assertRaisesRegex(RuntimeError, "try classy_legacy"):
            counterflex_post.export(["job"], "-", "--post classy " + OPTIONS)


unittest.main()
