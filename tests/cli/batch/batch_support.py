"""A batch of small jobs, disturbed runs of it, and the valid states of its folder."""
import fcntl
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

DATA = os.path.join(os.path.dirname(os.path.realpath(__file__)), "../data")
TEMPORARY = re.compile(r".*\.[0-9]+-[0-9]+\.tmp")
LIMIT = 120  # s, for every wait

failures = 0
sentence = ""


def it(text):
    global sentence
    sentence = text


def fail(message):
    global failures
    failures += 1
    print(f"FAILED: {sentence}: {message}", flush=True)


def check(holds, message):
    if not holds:
        fail(message)


def finish():
    print(f"{failures} failed" if failures else "all as it should be")
    sys.exit(1 if failures else 0)


def contents(folder):
    """The bytes of all files below, by their paths; None for a folder."""
    found = {}
    for place, folders, files in os.walk(folder):
        for name in folders:
            found[os.path.relpath(os.path.join(place, name), folder)] = None
        for name in files:
            path = os.path.join(place, name)
            try:
                with open(path, "rb") as file:
                    found[os.path.relpath(path, folder)] = file.read()
            except FileNotFoundError:  # another process is writing
                pass
    return found


def program(numbers):
    """A short milling program."""
    moves = [f"X{numbers.uniform(0, 80):.3f} Y{numbers.uniform(0, 60):.3f} F600" for _ in range(numbers.randint(4, 10))]
    return "\n".join(["%", "G21 G90 G17 G54", "T1 M6", "S8000 M3", "G0 X0. Y0. Z5.", "G1 Z-1. F200", *moves, "G0 Z20.", "M5",
                      "M30", "%", ""])


def memory_disk():
    """A fast file system: it makes no difference for killed processes."""
    return "/dev/shm" if os.access("/dev/shm", os.W_OK) and shutil.disk_usage("/dev/shm").free > 1 << 28 else None


class Batch:
    """Jobs in a folder of their own, the last few of them with reports."""

    def __init__(self, programs, jobs, reports=0, seed=1):
        self.counterflex, self.faulty_io = (os.path.realpath(path) for path in (programs[0], programs[2]))
        self.folder = os.path.realpath(tempfile.mkdtemp(dir=memory_disk()))
        self.out = os.path.join(self.folder, "out")
        self.log = os.path.join(self.folder, "log")
        os.mkdir(self.path("parts"))
        shutil.copy(os.path.join(DATA, "mill.toml"), self.folder)
        numbers = random.Random(seed)
        for job in range(jobs):
            self.write(self.program(job), program(numbers))
        lists = ['format = "counterflex-jobs 1"\noutput = "out"\nmachine = "mill.toml"\nforce = [300, -150, -80]\n']
        for first, last, more in ((0, jobs - reports, ""), (jobs - reports, jobs, "report = true\n")):
            names = ", ".join(f'"{self.program(job)}"' for job in range(first, last))
            if names:
                lists.append(f"[[job]]\nprogram = [{names}]\n{more}")
        self.write("jobs.toml", "".join(lists))

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="ascii") as file:
            file.write(text)

    @staticmethod
    def program(job):
        return f"parts/p{job:03}.ngc"

    @staticmethod
    def output(job):
        return f"p{job:03}.ngc"

    def start(self, *flags, faults=None, **process):
        """In a group of its own. `faults` are the variables of the library that disturbs it."""
        surroundings = {name: value for name, value in os.environ.items() if not name.startswith("COUNTERFLEX_")}
        if faults:
            if os.path.exists(self.log):
                os.remove(self.log)
            surroundings |= {"FAULTY_FOLDER": self.out, "FAULTY_LOG": self.log, "LD_PRELOAD": self.faulty_io,
                             "ASAN_OPTIONS": "verify_asan_link_order=0"}
            surroundings |= {"FAULTY_" + name: str(value) for name, value in faults.items()}
        return subprocess.Popen([self.counterflex, "batch", "jobs.toml", *flags], cwd=self.folder, env=surroundings,
                                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                errors="replace", start_new_session=True, **process)

    def start_stopped(self, *flags, at, **faults):
        """Stopped with its group before the call `at`, until SIGCONT."""
        process = self.start(*flags, faults={"WITH": "stop-group", "AT": at} | faults)
        _, status = os.waitpid(process.pid, os.WUNTRACED)
        check(os.WIFSTOPPED(status), f"it does not stop at call {at}: status {status}")
        return process

    def run(self, *flags, **how):
        """The exit status, and the text on standard error."""
        process = self.start(*flags, **how)
        errors = process.communicate(timeout=LIMIT)[1]
        return process.returncode, errors

    def faults_met(self):
        if not os.path.exists(self.log):
            return []
        with open(self.log, encoding="utf-8", errors="replace") as file:
            return file.read().splitlines()

    def clear(self):
        shutil.rmtree(self.out, ignore_errors=True)

    def remove(self):
        shutil.rmtree(self.folder, ignore_errors=True)

    def undisturbed(self):
        """The contents of the folder after an undisturbed run, and its duration."""
        self.clear()
        begin = time.monotonic()
        status, errors = self.run()
        check(status == 0, f"a quiet run has status {status}: {errors[:500]}")
        return contents(self.out), time.monotonic() - begin

    def wait_until_all_are_dead(self):
        """Processes that inherited the lock hold it."""
        path = os.path.join(self.out, ".counterflex/lock")
        if not os.path.exists(path):
            return
        with open(path, "rb") as file:
            end = time.monotonic() + LIMIT
            while time.monotonic() < end:
                try:
                    fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                    return
                except BlockingIOError:
                    time.sleep(0.001)
        fail("some process outlives the batch")

    def nothing_is_half_written(self, good, where, leftovers=True):
        """A file is complete, or missing, or has a temporary name; a manifest is complete. Without `leftovers` a
        temporary file is there only if the disk refused to remove it."""
        refused = [line.partition(" ")[2] for line in self.faults_met() if line.startswith("unlink ")]
        for name, found in contents(self.out).items():
            if name in (".counterflex", ".counterflex/lock") or name.startswith((".counterflex/shards", ".counterflex/merged")):
                continue
            if TEMPORARY.fullmatch(name):
                left = leftovers or os.path.join(self.out, name) in refused
                check(left, f"{where}: {name} was left behind")
            elif name == ".counterflex/manifest.json":
                check(found.endswith(b'"}\n'), f"{where}: the manifest is not whole")
            elif name in ("summary.json", "summary.csv"):  # of a run that has ended, with jobs that failed
                check(found.endswith((b"}\n", b"\n")[name.endswith("csv")]), f"{where}: {name} is not whole")
            else:
                check(name in good and found == good[name], f"{where}: {name} is neither good nor missing")

    def is_like(self, good, where):
        found = contents(self.out)
        different = sorted(name for name in found.keys() | good.keys() if found.get(name, b"-") != good.get(name, b"-"))
        check(not different, f"{where}: not as in a quiet run: {different[:5]}")

    def resume(self, good, where):
        status, errors = self.run("--resume")
        check(status == 0, f"{where}: status {status} of --resume: {errors[:500]}")
        self.is_like(good, where)

    def identities(self):
        """The state of a file that changes when it is written again."""
        return {name: (os.stat(os.path.join(self.out, name)).st_ino, os.stat(os.path.join(self.out, name)).st_mtime_ns)
                for name in os.listdir(self.out)}


def killed_after(process, seconds, whole_group):
    """Whether it was still running then."""
    try:
        process.wait(timeout=seconds)
    except subprocess.TimeoutExpired:
        if whole_group:
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
        process.wait(timeout=LIMIT)
        return True
    return False
