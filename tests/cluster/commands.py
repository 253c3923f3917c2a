"""Runs plumb for the tests of units, and reads what units leave. The program and the checkout are the first arguments."""

import ctypes
import json
import pathlib
import resource
import subprocess
import sys
import tempfile

PROGRAM, CHECKOUT = sys.argv[1], pathlib.Path(sys.argv[2])
QUICK = ["--calibration", "0.01"]
SKIPPED = 77
# Small scenes without costs: their results are the same bits wherever they run.
SMALL = ["compare", "free_fall", "elastic_collision", "--engine", "plumb,plumb-float", "--no-cost"]


def plumb(*words, code=0, cwd=None, limit=None, program=PROGRAM):
    """Runs plumb, which has to end with `code` (None: any). `limit`: bytes of the largest file it may write."""
    def before():
        if limit is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    run = subprocess.run([program, *map(str, words)], capture_output=True, text=True, cwd=cwd, preexec_fn=before)
    if code is not None:
        assert run.returncode == code, f"{words}: exit code {run.returncode}\n{run.stdout}\n{run.stderr}"
    return run


def start(*words):
    return subprocess.Popen([PROGRAM, *map(str, words)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def rows_of(folder, file="results.jsonl"):
    """Results without what differs from run to run: the time of day, and how long it took."""
    rows = []
    for line in (pathlib.Path(folder) / file).read_text().splitlines():
        row = json.loads(line)
        for name in ("environment", "cost", "seconds", "engine_seconds", "memory"):
            row.pop(name, None)
        if row.get("kind") != "environment":
            rows.append(json.dumps(row))
    return rows


def local(folder, *words):
    """What the command itself gives, on this machine, in one go."""
    plumb(*words, "--no-report", "--out", folder)
    return rows_of(folder)


def unpacked(path):
    """Text of a unit's file, which zstd may have compressed."""
    path = pathlib.Path(path)
    if path.exists():
        return path.read_text()
    packed = path.with_name(path.name + ".zst").read_bytes()
    zstd = ctypes.CDLL("libzstd.so.1")
    zstd.ZSTD_decompress.restype = zstd.ZSTD_getFrameContentSize.restype = ctypes.c_ulonglong
    size = zstd.ZSTD_getFrameContentSize(packed, ctypes.c_size_t(len(packed)))
    out = ctypes.create_string_buffer(size)
    assert zstd.ZSTD_decompress(out, ctypes.c_size_t(size), packed, ctypes.c_size_t(len(packed))) == size
    return out.raw[:size].decode()


def make_plain(work, number):
    """Replaces a unit's compressed results by plain ones, as a plumb without zstd leaves them."""
    unit = pathlib.Path(work) / "done" / f"{number:05}"
    text = unpacked(unit / "results.jsonl")
    (unit / "results.jsonl.zst").unlink(missing_ok=True)
    (unit / "results.jsonl").write_text(text)
    facts = json.loads((unit / "unit.json").read_text())
    facts["bytes"].pop("results.jsonl.zst", None)
    facts["bytes"]["results.jsonl"] = (unit / "results.jsonl").stat().st_size
    (unit / "unit.json").write_text(json.dumps(facts))
    return unit / "results.jsonl"


def entries(folder):
    return sorted(path.name for path in pathlib.Path(folder).iterdir())


def units_of(work):
    return [json.loads(line) for line in (pathlib.Path(work) / "units.jsonl").read_text().splitlines()]


def rows_of_nothing(work):
    """Files of results that units have left."""
    return [path for path in (pathlib.Path(work) / "done").rglob("results.jsonl*")]


def state(work):
    return json.loads(plumb("status", work, "--format", "json").stdout)


def run_test(tests):
    """Runs the test that the third argument names, in a folder of its own."""
    with tempfile.TemporaryDirectory(prefix="plumb-cluster-") as name:
        tests[sys.argv[3]](pathlib.Path(name))
