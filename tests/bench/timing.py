"""Runs commands and measures them."""
import os
import subprocess
import time


class Failed(Exception):
    pass


class Run:
    """Of one process: seconds on the clock, seconds of processor time, peak memory in MB (its own, or this process' where
    that is more), and what it printed."""

    def __init__(self, wall, usage, text):
        self.wall, self.cpu = wall, usage.ru_utime + usage.ru_stime
        self.peak_mb, self.text = usage.ru_maxrss / 1024, text


def measured(command, work, env=None):
    """Output goes to a file, as reading it would disturb. Raises Failed where the exit status is not 0."""
    with open(work + '/printed', 'w+', encoding='utf-8', errors='replace') as printed:
        begun = time.monotonic()
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=printed, stderr=subprocess.STDOUT, env=env)
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.monotonic() - begun
        process.returncode = os.waitstatus_to_exitcode(status)
        printed.seek(0)
        text = printed.read(20000)
    if process.returncode != 0:
        raise Failed('%s: exit status %d: %s' % (' '.join(command[:2]), process.returncode, text.strip()[-300:]))
    return Run(wall, usage, text)


def best_alternating(contenders, rounds):
    """Of functions that give a Run, each called once a round: for each the least times and the largest memory."""
    best = {}
    for _ in range(rounds):
        for name, run in contenders.items():
            now = run()
            if name not in best:
                best[name] = now
                continue
            kept = best[name]
            kept.wall, kept.cpu = min(kept.wall, now.wall), min(kept.cpu, now.cpu)
            kept.peak_mb = max(kept.peak_mb, now.peak_mb)
    return best
