"""Builds plumb's wheel with nothing but Python, cmake and a compiler: a back end after PEP 517.

`python3 -m pip install .` needs no network with it: nothing is downloaded to build. Debian's packages pybind11-dev,
python3-dev, nlohmann-json3-dev, cmake, ninja-build and g++ must be there. PLUMB_BUILD_DIR names a configured build folder
to use instead of a new one. `--config-settings harness=yes` packs the program `plumb` as well, which plumb.compare, tune and
hunt call: that compiles the harness, with what docs/python.md lists.
"""

import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "bindings/python/plumb"
VERSION = re.search(r"project\(plumb VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)


def tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def metadata():
    return (f"Metadata-Version: 2.1\nName: plumb\nVersion: {VERSION}\nSummary: A 2D rigid-body physics engine\n"
            "License: MIT\nRequires-Python: >=3.10\nRequires-Dist: numpy\n")


def build(folder, harness):
    """Paths of the built extension module and, where it is asked for, of the program."""
    place = os.environ.get("PLUMB_BUILD_DIR")
    if not place:
        place = folder
        subprocess.run(["cmake", "-S", ROOT, "-B", place, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DPLUMB_TESTS=OFF",
                        "-DPLUMB_BENCHES=OFF", "-DPLUMB_WINDOW=OFF", f"-DPLUMB_LIBRARY_ONLY={'OFF' if harness else 'ON'}",
                        "-DPLUMB_PYTHON=REQUIRED", f"-DPLUMB_PYTHON_PROGRAM={sys.executable}"], check=True)
    targets = ["plumb_python"] + (["plumb_app"] if harness else [])
    subprocess.run(["cmake", "--build", place, "--target", *targets], check=True)
    place = pathlib.Path(place)
    return next((place / "bindings/python").glob("_plumb*.so")), place / "bin/plumb" if harness else None


def wheel_file():
    return f"Wheel-Version: 1.0\nGenerator: plumb\nRoot-Is-Purelib: false\nTag: {tag()}\n"


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    name = f"plumb-{VERSION}.dist-info"
    info = pathlib.Path(metadata_directory) / name
    info.mkdir()
    (info / "METADATA").write_text(metadata())
    (info / "WHEEL").write_text(wheel_file())
    return name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    with tempfile.TemporaryDirectory() as folder:
        files = {f"plumb/{path.relative_to(PACKAGE).as_posix()}": path.read_bytes()
                 for path in sorted(PACKAGE.rglob("*")) if path.is_file() and "__pycache__" not in path.parts}
        harness = (config_settings or {}).get("harness", "no") == "yes"
        module, program = build(folder, harness)
        files[f"plumb/{module.name}"] = module.read_bytes()
        if program:
            files["plumb/bin/plumb"] = program.read_bytes()
        info = f"plumb-{VERSION}.dist-info"
        files[f"{info}/METADATA"] = metadata().encode()
        files[f"{info}/WHEEL"] = wheel_file().encode()
        record = "".join(f"{name},sha256={digest(data)},{len(data)}\n" for name, data in files.items())
        files[f"{info}/RECORD"] = f"{record}{info}/RECORD,,\n".encode()
        name = f"plumb-{VERSION}-{tag()}.whl"
        with zipfile.ZipFile(pathlib.Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
            for path, data in files.items():
                entry = zipfile.ZipInfo(path, (1980, 1, 1, 0, 0, 0))
                entry.external_attr = (0o100755 if path.startswith("plumb/bin/") else 0o100644) << 16
                wheel.writestr(entry, data, zipfile.ZIP_DEFLATED)
        return name


def digest(data):
    return base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()


def get_requires_for_build_wheel(config_settings=None):
    return []
