"""The macro and the post-processor for FreeCAD, in FreeCAD without its window.   WORK_FOLDER=FOLDER freecadcmd freecad_test.py

The working folder is samples/pipeline. Counterflex is in PATH.
"""

import os
import pathlib
import runpy
import shlex
import subprocess
import sys
import unittest
import webbrowser

import FreeCAD
from PathScripts import PathJob, PathPost, PathProfile

work = os.environ["WORK_FOLDER"]
machine = os.path.abspath("../mill3/machine.toml")
macro = os.path.abspath("counterflex.FCMacro")


class InFreeCAD(unittest.TestCase):
    def setUp(self):
        self.folder = os.path.join(work, self._testMethodName)
        os.mkdir(self.folder)
        self.document = FreeCAD.newDocument("plate")
        self.job = self.add_job()
        self.document.saveAs(os.path.join(self.folder, "plate.FCStd"))

    def tearDown(self):
        FreeCAD.closeDocument(self.document.Name)

    def add_job(self):
        box = self.document.addObject("Part::Box", "Box")
        box.Length, box.Width, box.Height = 40, 30, 10
        self.document.recompute()
        job = PathJob.Create("Job", [box])
        job.PostProcessor, job.PostProcessorArgs = "linuxcnc", "--no-show-editor"
        job.PostProcessorOutputFile = "%D/plate.ngc"
        PathProfile.Create("Profile", parentJob=job)
        controller = job.Tools.Group[0]
        controller.HorizFeed, controller.VertFeed = "900 mm/min", "300 mm/min"
        self.document.recompute()
        return job

    def path(self, name):
        return pathlib.Path(self.folder, name)

    def made_by_counterflex_alone(self, *options):
        command = ["counterflex", "compensate", self.path("plate.ngc"), *options, "-o", "-", "-q"]
        return subprocess.run(command, capture_output=True, check=True).stdout


class ThePostProcessor(InFreeCAD):
    def test_writes_what_counterflex_makes_of_the_program_of_another_one(self):
        self.job.PostProcessorArgs = "--no-header"  # the header has the time of day
        self.post()
        options = ["-m", machine, "--force=60,-30,-40", "--work", "G54=150,100,-240/machine"]
        expected = self.made_by_counterflex_alone(*options).replace(b"plate.ngc", b"standard input")
        self.job.PostProcessor = "counterflex"
        self.job.PostProcessorArgs = "--no-header --compensate " + shlex.quote(shlex.join(options))
        self.post()
        self.assertEqual(self.path("plate.ngc").read_bytes(), expected)

    def post(self):
        self.path("plate.ngc").unlink(missing_ok=True)
        command = PathPost.CommandPathPost()
        for objects in command.buildPostList(self.job):
            command.exportObjectsWith(objects, self.job)


class TheMacro(InFreeCAD):
    def setUp(self):
        super().setUp()
        self.opened = []
        webbrowser.open = self.opened.append

    def add_project(self, more=""):
        with open(os.path.join(self.folder, "counterflex.toml"), "w") as file:
            file.write('format = "counterflex-project 1"\nmachine = "%s"\nforce = "60,-30,-40"\n%s' % (machine, more))
            file.write('[work.G54]\nxyz_mm = [150, 100, -240]\ndatum = "machine"\n')

    def run_macro(self):
        runpy.run_path(macro, run_name="__main__")

    def test_writes_what_counterflex_makes_of_the_program_and_opens_the_page(self):
        self.add_project()
        self.run_macro()
        self.assertEqual(self.opened, [self.path("plate.html").as_uri()])
        self.assertIn("<html", self.path("plate.html").read_text()[:200])
        self.assertIn("G2 X42.500 Y30.000", self.path("plate.ngc").read_text())
        self.assertEqual(self.path("plate.comp.ngc").read_bytes(), self.made_by_counterflex_alone())

    def test_opens_the_page_of_a_program_that_is_not_written(self):
        self.add_project("max_correction_mm = 0.01\n")
        with self.assertRaisesRegex(RuntimeError, "status 6(.|\n)*correction"):
            self.run_macro()
        self.assertEqual(self.opened, [self.path("plate.html").as_uri()])
        self.assertFalse(self.path("plate.comp.ngc").exists())

    def test_passes_the_message_of_counterflex_on(self):
        with self.assertRaisesRegex(RuntimeError, "status 2(.|\n)*machine"):
            self.run_macro()
        self.assertEqual(self.opened, [])

    def test_does_not_choose_between_two_jobs(self):
        self.add_job()
        with self.assertRaisesRegex(RuntimeError, "several jobs: select one of Job, Job001"):
            self.run_macro()
        self.assertEqual(self.opened, [])
        self.assertFalse(self.path("plate.ngc").exists())


# Where FreeCAD looks for post-processors.
FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Macro").SetString("MacroPath", os.getcwd())
suites = map(unittest.defaultTestLoader.loadTestsFromTestCase, (TheMacro, ThePostProcessor))
result = unittest.TextTestRunner(stream=sys.stderr).run(unittest.TestSuite(suites))
sys.stderr.flush()
os._exit(0 if result.wasSuccessful() else 1)  # FreeCAD's own end has always status 0
