"""What the tests of the Python module share."""
import os
import pathlib

import counterflex

SOURCE = pathlib.Path(os.environ['COUNTERFLEX_SOURCE'])
PROGRAM = os.environ['COUNTERFLEX_PROGRAM']
SAMPLES = SOURCE / 'samples'
MILLING = (215, -10, -25, 1, 21.5, 0)  # N and N m, of the paper


def sample(path):
    return counterflex.Machine.load(SAMPLES / path)
