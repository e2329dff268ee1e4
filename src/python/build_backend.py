"""Makes the wheel for `pip install ./src/python`: builds the module with CMake and packs it. Needs no other package.

The build folder is COUNTERFLEX_BUILD, default build/release: what has been built there is used.
"""
import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent


def version():
    return re.search(r'project\(counterflex VERSION (\S+)', (ROOT / 'CMakeLists.txt').read_text()).group(1)


def build_module():
    """The built extension for this Python."""
    folder = pathlib.Path(os.environ.get('COUNTERFLEX_BUILD', ROOT / 'build/release'))
    if not (folder / 'CMakeCache.txt').exists():
        subprocess.run(['cmake', '-S', ROOT, '-B', folder, '-DCMAKE_BUILD_TYPE=Release', '-DCOUNTERFLEX_TESTS=OFF',
                        f'-DPython_EXECUTABLE={sys.executable}'], check=True)
    subprocess.run(['cmake', '--build', folder, '--target', 'counterflex_python', '-j', str(os.cpu_count())], check=True)
    extension = folder / 'python/counterflex' / ('_core' + sysconfig.get_config_var('EXT_SUFFIX'))
    if not extension.exists():
        raise SystemExit(f'{folder} is configured for another Python than {sys.executable}; set COUNTERFLEX_BUILD to a new folder')
    return extension


def metadata():
    return (f'Metadata-Version: 2.1\nName: counterflex\nVersion: {version()}\n'
            'Summary: Corrects machining programs for the errors and the elasticity of their machine\n'
            'Requires-Python: >=3.9\nRequires-Dist: numpy\n')


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    extension = build_module()
    tag = f'cp{sys.version_info.major}{sys.version_info.minor}'
    tag += f'-{tag}-' + re.sub(r'[-.]', '_', sysconfig.get_platform())
    info = f'counterflex-{version()}.dist-info'
    sources = [path for path in sorted((HERE / 'counterflex').iterdir()) if path.suffix in ('.py', '.pyi', '.typed')]
    files = {f'counterflex/{path.name}': path.read_bytes() for path in sources}
    files[f'counterflex/{extension.name}'] = extension.read_bytes()
    files[f'{info}/METADATA'] = metadata().encode()
    files[f'{info}/WHEEL'] = f'Wheel-Version: 1.0\nGenerator: counterflex\nRoot-Is-Purelib: false\nTag: {tag}\n'.encode()
    record = ''
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b'=').decode()
        record += f'{name},sha256={digest},{len(content)}\n'
    files[f'{info}/RECORD'] = f'{record}{info}/RECORD,,\n'.encode()
    wheel = f'counterflex-{version()}-{tag}.whl'
    with zipfile.ZipFile(pathlib.Path(wheel_directory, wheel), 'w', zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    raise SystemExit('the module is built from a checkout of counterflex only: pip install ./src/python')
