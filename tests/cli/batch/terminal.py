"""Runs on a terminal that is stopped, as by Ctrl-S or a connection that hangs. Arguments: what to try, and counterflex."""
import glob
import os
import pty
import re
import select
import signal
import sys
import time

STOP, GO_ON = b"\x13", b"\x11"
LIMIT = 60  # s, for every wait


def fail(message):
    print(message)
    sys.exit(1)


def start(*arguments, command=("batch", "jobs.toml")):
    """The process, and the other end of the terminal that it is on."""
    process, terminal = pty.fork()
    if process == 0:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        os.execv(sys.argv[2], ["counterflex", *command, *arguments])
    return process, terminal


def until(holds, what):
    end = time.monotonic() + LIMIT
    while not holds():
        if time.monotonic() > end:
            fail(f"never: {what}")
        time.sleep(0.02)


def ended(process):
    """Its exit status, None while it runs."""
    found, status = os.waitpid(process, os.WNOHANG)
    return os.waitstatus_to_exitcode(status) if found else None


def status_of(process, what):
    found = []

    def has_ended():
        status = ended(process)
        if status is not None:
            found.append(status)
        return bool(found)

    until(has_ended, what)
    return found[0]


def said(terminal, process):
    """Its output until it ends, and its status."""
    text, status = b"", None
    end = time.monotonic() + LIMIT
    while time.monotonic() < end:
        if select.select([terminal], [], [], 0.05)[0]:
            try:
                text += os.read(terminal, 65536)
            except OSError:  # the terminal is closed
                return text.decode(), status if status is not None else status_of(process, "it ends")
        elif status is not None:
            return text.decode(), status
        if status is None:
            status = ended(process)
    return fail("it does not end")


def stopped():
    """More jobs are done than were begun when it stopped; others are to come when the signal does."""
    process, terminal = start("--threads", "2")
    os.write(terminal, STOP)
    try:
        until(lambda: len(glob.glob("done/*.ngc")) >= 3, "the jobs continue")
        os.kill(process, signal.SIGTERM)
        if (status := status_of(process, "SIGTERM is handled")) != 143:
            fail(f"status {status} after SIGTERM")
    finally:
        if ended_now(process) is None:
            os.kill(process, signal.SIGKILL)


def ended_now(process):
    try:
        return ended(process)
    except ChildProcessError:
        return 0


def goes_on():
    process, terminal = start()
    os.write(terminal, STOP)
    until(lambda: os.path.exists("done/a.ngc") and os.path.exists("done/b.ngc"), "the jobs continue")
    os.write(terminal, GO_ON)
    text, status = said(terminal, process)
    if status != 2 or "missing.ngc: error: cannot read" not in text.replace("\x1b[1;31m", "").replace("\x1b[0m", ""):
        fail(f"status {status}: {text[:2000]!r}")
    if "2 of 3 jobs done, 1 failed" not in text:
        fail(f"no table: {text[:2000]!r}")


def many():
    begin = time.monotonic()
    process, terminal = start()
    text, status = said(terminal, process)
    lines = len(re.findall(r"\d+ of 40 jobs(?! done)", text))
    if status != 0 or not 1 <= lines <= 4 * (time.monotonic() - begin) + 2:
        fail(f"status {status}, {lines} lines of progress in {time.monotonic() - begin:.1f} s")


def single():
    process, terminal = start(command=("compensate", "long.ngc", "-m", "mill.toml", "-o", "single.ngc"))
    os.write(terminal, STOP)
    until(lambda: os.path.exists("single.ngc"), "the program is written")
    os.write(terminal, GO_ON)
    text, status = said(terminal, process)
    if status != 0 or "before" not in text:
        fail(f"status {status}: {text[:2000]!r}")


{"stopped": stopped, "goes_on": goes_on, "many": many, "single": single}[sys.argv[1]]()
