"""LinuxCNC's interpreter, unpacked from Debian's packages into a folder; nothing is installed, no root is needed."""
import glob
import os
import subprocess

from skip import Skip

PACKAGE = 'linuxcnc-uspace'


def module_of(folder):
    """The extension module `gcode` of the interpreter under `folder`, or None."""
    found = glob.glob(folder + '/usr/lib/python3/dist-packages/gcode*.so')
    return found[0] if found else None


def environment(folder):
    """What a process needs in order to load the interpreter."""
    libraries = [folder + '/usr/lib'] + glob.glob(folder + '/usr/lib/*-linux-gnu*')
    return dict(os.environ, LD_LIBRARY_PATH=':'.join(libraries))


def missing_libraries(folder):
    listed = subprocess.run(['ldd', module_of(folder)], env=environment(folder), capture_output=True, text=True)
    return [line.split()[0] for line in listed.stdout.splitlines() if 'not found' in line]


def packages_of(libraries):
    """The dependencies of the package that are named as these libraries are: libboost_python311.so.1.74.0 is in
    libboost-python1.74.0."""
    listed = subprocess.run(['apt-cache', 'depends', PACKAGE], capture_output=True, text=True).stdout
    names = {word for line in listed.splitlines() for word in line.split()[-1:] if word.startswith('lib')}
    starts = [library.split('.so')[0].replace('_', '-').rstrip('0123456789') for library in libraries]
    return sorted(name for name in names for start in starts if name.startswith(start))


def unpack(packages, folder):
    with_debs = folder + '.debs'
    os.makedirs(with_debs, exist_ok=True)
    got = subprocess.run(['apt-get', 'download', *packages], cwd=with_debs, capture_output=True, text=True)
    if got.returncode != 0:
        raise Skip('apt-get cannot download ' + ' '.join(packages) + ': ' + got.stderr.strip()[-200:])
    for deb in glob.glob(with_debs + '/*.deb'):
        subprocess.run(['dpkg', '-x', deb, folder], check=True)
        os.remove(deb)


def obtain(folder):
    """Unpacks the interpreter into `folder` unless it is there. Raises Skip where that cannot be done."""
    try:
        if not module_of(folder):
            unpack([PACKAGE], folder)
        missing = missing_libraries(folder)
        if missing:
            unpack(packages_of(missing), folder)
            missing = missing_libraries(folder)
    except FileNotFoundError as error:
        raise Skip('this is not a Debian system: %s is missing' % error.filename)
    if missing:
        raise Skip('the interpreter needs ' + ' '.join(missing))
    return folder
