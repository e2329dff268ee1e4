"""A post-processor for the CAM (Path) workbench of FreeCAD. Another post-processor writes the program; this one compensates it.

Put this file into FreeCAD's folder of post-processors (Preferences, CAM, Job Preferences, Defaults) or into the folder of macros.
Choose `counterflex` as the post-processor of a job. Its arguments:

    --post NAME           the post-processor that writes the program; default `linuxcnc`. It must be a script with an `export`
                          function. In newer versions of FreeCAD the names of these scripts end in _legacy
    --counterflex PATH    the program counterflex, if it is not in PATH
    --compensate "..."    options of `counterflex compensate`: "-m /shop/mill.toml -f /shop/forces.csv --report /shop/reports/"

All other arguments are passed to the other post-processor. If counterflex fails, the post-processing fails with the message of
counterflex, and no file with the name of the program is written.
"""

import argparse
import importlib
import os
import shlex
import subprocess
import sys
import tempfile

TOOLTIP = "Compensates the program of another post-processor with counterflex."

parser = argparse.ArgumentParser(prog="counterflex", add_help=False, allow_abbrev=False)
parser.add_argument("--post", default="linuxcnc", help="the post-processor that writes the program")
parser.add_argument("--counterflex", default="counterflex", help="the program counterflex")
parser.add_argument("--compensate", default="", help='options of counterflex, as "-m mill.toml -f forces.csv"')
TOOLTIP_ARGS = parser.format_help()


def export(objectslist, filename, argstring):
    """Called by FreeCAD. Returns the corrected program and writes it to `filename`, except if `filename` is "-"."""
    own, others = parser.parse_known_args(shlex.split(argstring))
    program = posted(own.post, objectslist, shlex.join(["--no-show-editor", *others]))
    corrected = compensated(own.counterflex, shlex.split(own.compensate), program)
    if filename != "-":
        write(filename, corrected)
    return corrected


def posted(name, objectslist, argstring):
    """The program that the post-processor `name` makes. Some post-processors return it, others only write it."""
    post = find_post(name)
    with tempfile.TemporaryDirectory() as folder:
        filename = os.path.join(folder, "posted.nc")
        text = post.export(objectslist, filename, argstring)
        if isinstance(text, str) and text:
            return text
        if os.path.exists(filename):
            with open(filename, newline="") as file:
                return file.read()
    raise RuntimeError(f"counterflex: the post-processor {name} made no program")


def find_post(name):
    """The module NAME_post from FreeCAD's folders of post-processors."""
    places = []
    for preferences in ("Path.Preferences", "PathScripts.PathPreferences"):  # FreeCAD 0.21 and later; 0.20 and before
        try:
            places = importlib.import_module(preferences).searchPathsPost()
            break
        except ImportError:
            pass  # outside of FreeCAD Python searches its own folders
    sys.path[:0] = places
    try:
        post = importlib.import_module(f"{name}_post")
    finally:
        del sys.path[: len(places)]
    if not callable(getattr(post, "export", None)):
        raise RuntimeError(f"counterflex: {name} is no post-processor with an export function; try {name}_legacy")
    return post


def compensated(counterflex, options, program):
    """The corrected program. Raises RuntimeError with the message of counterflex if it fails."""
    command = [counterflex, "compensate", "-", *options, "-o", "-", "--quiet"]
    run = subprocess.run(command, input=program.encode(), capture_output=True)
    if run.returncode != 0:
        message = run.stderr.decode(errors="replace").strip()
        raise RuntimeError(f"counterflex ended with status {run.returncode}: {message}")
    return run.stdout.decode()


def write(filename, text):
    """Writes to another name and renames the file, so that `filename` is never incomplete."""
    unfinished = filename + ".part"
    with open(unfinished, "w", newline="") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    os.replace(unfinished, filename)
