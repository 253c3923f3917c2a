#!/usr/bin/env python3
"""Runs the fuzzers, several at a time, and keeps what they learn.

    fuzz.py [TARGET...] [--minutes M | --seconds S] [--jobs N] [--build DIR]
    fuzz.py --list              names the targets
    fuzz.py --reduce [TARGET...]  leaves out of DIR/corpus what reaches nothing of its own: less to read for the next run
    fuzz.py --keep [TARGET...]  makes the few inputs that reach most the corpus in tests/fuzz/corpus

`./plumb fuzz` builds the fuzzers and calls this. Each target runs for the time given; as many run at once as there are
cores. What they learn stays in DIR/corpus/TARGET, also when they are interrupted, and the next run goes on from there.
Findings are in DIR/findings, with the command that replays them.

Exit status: 0 when nothing was found, 1 when something was, 130 when interrupted.
"""

import argparse
import ctypes
import dataclasses
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
SEEDS = HERE / "corpus"

# Bytes of the longest input: short ones run often.
LONGEST = {"scene": 3000, "worker": 3000, "host": 2000, "world": 600, "snapshot": 500, "recording": 600}
DICTIONARIES = {"scene": "json.dict", "worker": "json.dict", "host": "json.dict",
                "snapshot": "lengths.dict", "recording": "lengths.dict"}
SLOWEST = 60  # s that one input may take, on a machine that does other things too
MEMORY = 2048  # MB
KEPT_FILES, KEPT_BYTES = 45, 150_000  # a target, at most


def all_targets():
    return sorted(path.stem for path in (HERE / "targets").glob("*.cpp"))


def end_with_parent():
    """A fuzzer does not run on when this program is killed."""
    pr_set_pdeathsig = 1
    ctypes.CDLL(None).prctl(pr_set_pdeathsig, signal.SIGKILL)


def environment():
    variables = dict(os.environ)
    variables.setdefault("ASAN_OPTIONS", "allocator_may_return_null=1:detect_stack_use_after_return=0")
    variables.setdefault("UBSAN_OPTIONS", "print_stacktrace=1")
    return variables


@dataclasses.dataclass
class Run:
    """A fuzzer at work."""

    target: str
    build: pathlib.Path
    seconds: float

    def __post_init__(self):
        self.corpus = self.build / "corpus" / self.target
        self.findings = self.build / "findings"
        self.log = self.build / "logs" / f"{self.target}.log"
        self.before = set()

    def start(self):
        for folder in (self.corpus, self.findings, self.log.parent):
            folder.mkdir(parents=True, exist_ok=True)
        self.before = self.found()
        self.begin = time.monotonic()
        seeds = [SEEDS / self.target] if (SEEDS / self.target).is_dir() else []
        words = [f"-dict={HERE / DICTIONARIES[self.target]}"] if self.target in DICTIONARIES else []
        command = [program(self.build, self.target), self.corpus, *seeds, *words,
                   f"-max_total_time={max(1, round(self.seconds))}", f"-max_len={LONGEST.get(self.target, 1000)}",
                   f"-timeout={SLOWEST}", f"-rss_limit_mb={MEMORY}", "-print_final_stats=1",
                   f"-artifact_prefix={self.findings}/{self.target}-"]
        with open(self.log, "wb") as log:
            self.process = subprocess.Popen([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=log,
                                            stderr=subprocess.STDOUT, env=environment(), preexec_fn=end_with_parent)

    def found(self):
        return set(self.findings.glob(f"{self.target}-*"))

    def status(self):
        """Runs, coverage and inputs so far, from the last line that says so."""
        text = self.log.read_text(encoding="utf-8", errors="replace") if self.log.exists() else ""
        lines = re.findall(r"^#(\d+)\s+\w+\s+cov: (\d+) ft: (\d+) corp: (\d+)", text, re.MULTILINE)
        runs, cover, _, inputs = lines[-1] if lines else ("0", "0", "0", "0")
        final = re.search(r"stat::number_of_executed_units:\s*(\d+)", text)
        return int(final.group(1)) if final else int(runs), int(cover), int(inputs)

    def report(self):
        """One line, and what is to be said of a finding; whether there was none."""
        runs, cover, inputs = self.status()
        seconds = time.monotonic() - self.begin
        line = f"{self.target:10} {runs:>10} runs  {runs / max(seconds, 1):>7.0f}/s  {cover:>6} edges  {inputs:>5} inputs"
        new = sorted(self.found() - self.before)
        # Inputs that are merely slow end no run.
        bad = [path for path in new if not path.name.startswith(f"{self.target}-slow-unit")]
        if self.process.returncode == 0 and not bad:
            print(f"{line}  nothing found", flush=True)
            return True
        print(f"{line}  FOUND SOMETHING", flush=True)
        print("\n".join(f"    {text}" for text in explanation(self.log)))
        print(f"    log: {self.log}")
        for path in bad:
            print(f"    kept: {path}\n    replay: {program(self.build, self.target)} {path}")
        return False


def program(build, target):
    return build / "tests" / "fuzz" / f"fuzz_{target}"


def explanation(log):
    """The lines of a log that say what went wrong."""
    text = log.read_text(encoding="utf-8", errors="replace")
    said = re.findall(r"^(?:does not hold: .*|.*runtime error: .*|.*ERROR: .*|SUMMARY: .*|terminate called.*|"
                      r"  what\(\): .*|.*Assertion.*)$", text, re.MULTILINE)
    return list(dict.fromkeys(said))[:8] or text.splitlines()[-5:]


def show(running, waiting, done, seconds, jobs):
    """A line that is written over again: on terminals alone."""
    if not sys.stderr.isatty():
        return
    parts = []
    for run in running:
        runs, cover, _ = run.status()
        parts.append(f"{run.target} {runs} runs {cover} edges")
    now = time.monotonic()
    left = max([run.seconds - (now - run.begin) for run in running] + [0]) + -(-len(waiting) // jobs) * seconds
    minutes, rest = divmod(max(0, round(left)), 60)
    sys.stderr.write(f"\r\033[K{done} done; {'; '.join(parts)}; {minutes}:{rest:02} left")
    sys.stderr.flush()


def clear_line():
    if sys.stderr.isatty():
        sys.stderr.write("\r\033[K")
        sys.stderr.flush()


def fuzz(targets, build, seconds, jobs):
    waiting, running = [Run(target, build, seconds) for target in targets], []
    clean, done, interrupted = True, 0, False
    try:
        while waiting or running:
            while waiting and len(running) < jobs:
                run = waiting.pop(0)
                run.start()
                running.append(run)
            time.sleep(0.5)
            show(running, waiting, done, seconds, jobs)
            for run in [run for run in running if run.process.poll() is not None]:
                running.remove(run)
                clear_line()
                clean = run.report() and clean
                done += 1
    except KeyboardInterrupt:
        interrupted = True
        clear_line()
        for run in running:
            run.process.terminate()
        for run in running:
            run.process.wait()
        print(f"interrupted; what was learnt is in {build / 'corpus'}", flush=True)
    return 130 if interrupted else 0 if clean else 1


def merge(build, target, folders, out, notes):
    """Copies to `out` the inputs of `folders` that together reach all that these reach; `notes` tells how far it is."""
    command = [program(build, target), "-merge=1", f"-merge_control_file={notes}", f"-max_len={LONGEST.get(target, 1000)}",
               f"-timeout={SLOWEST}", f"-rss_limit_mb={MEMORY}", out, *folders]
    return subprocess.Popen([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL, env=environment(), preexec_fn=end_with_parent)


def show_merge(target, notes, count, begin):
    """How many inputs a merge has read, and how long it takes at that rate: on terminals alone."""
    if not sys.stderr.isatty() or not notes.exists():
        return
    read = notes.read_bytes().count(b"STARTED ")
    left = (time.monotonic() - begin) / max(read, 1) * (count - read)
    sys.stderr.write(f"\r\033[K{target}: {read} of {count} inputs read; {round(left)} s left")
    sys.stderr.flush()


def reduce(targets, build):
    """Replaces the corpus of each target by fewer inputs that reach as much. Interrupted, it changes nothing."""
    for target in targets:
        corpus = build / "corpus" / target
        before = len(list(corpus.iterdir())) if corpus.is_dir() else 0
        if before == 0:
            print(f"{target:10} nothing learnt so far")
            continue
        with tempfile.TemporaryDirectory(dir=build) as name:
            out, notes = pathlib.Path(name) / "corpus", pathlib.Path(name) / "notes"
            out.mkdir()
            begin = time.monotonic()
            process = merge(build, target, [corpus], out, notes)
            while process.poll() is None:
                time.sleep(0.2)
                show_merge(target, notes, before, begin)
            clear_line()
            after = len(list(out.iterdir()))
            if process.returncode != 0 or after == 0:
                print(f"{target}: the merge ended with {process.returncode}; the {before} inputs are as they were",
                      file=sys.stderr)
                return 1
            corpus.rename(pathlib.Path(name) / "replaced")
            out.rename(corpus)
        print(f"{target:10} {after} of {before} inputs kept", flush=True)
    return 0


def features(build, target, folders):
    """What each file reaches: path -> (features, size), by a merge whose notes are read."""
    with tempfile.TemporaryDirectory() as name:
        notes, out = pathlib.Path(name) / "notes", pathlib.Path(name) / "out"
        out.mkdir()
        command = [program(build, target), "-merge=1", "-set_cover_merge=1", f"-merge_control_file={notes}",
                   f"-timeout={SLOWEST}", out, *folders]
        subprocess.run([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL, env=environment(), check=False)
        lines = notes.read_text(encoding="utf-8").splitlines()
    count = int(lines[0])
    files = lines[2:2 + count]
    reached = {}
    for line in lines[2 + count:]:
        words = line.split()
        if words[0] == "FT":
            reached[files[int(words[1])]] = set(map(int, words[2:]))
    return {pathlib.Path(path): found for path, found in reached.items()}


def keep(targets, build):
    """Few small inputs that reach most, greedily by what is new a byte."""
    for target in targets:
        seeds = SEEDS / target
        seeds.mkdir(parents=True, exist_ok=True)
        folders = [folder for folder in (seeds, build / "corpus" / target) if folder.is_dir()]
        reached = features(build, target, folders)
        everything = set().union(*reached.values()) if reached else set()
        covered, chosen, size = set(), [], 0
        while reached and len(chosen) < KEPT_FILES:
            best = max(reached, key=lambda path: (len(reached[path] - covered) / (64 + path.stat().st_size), path.name))
            new = reached.pop(best) - covered
            if not new or size + best.stat().st_size > KEPT_BYTES:
                continue
            covered |= new
            chosen.append(best)
            size += best.stat().st_size
        with tempfile.TemporaryDirectory() as name:
            for path in chosen:
                shutil.copy(path, pathlib.Path(name) / path.name)
            # Files with a name of their own are findings of the past: they stay.
            for path in seeds.iterdir():
                if re.fullmatch(r"[0-9a-f]{40}", path.name):
                    path.unlink()
            for path in pathlib.Path(name).iterdir():
                shutil.copy(path, seeds / path.name)
        print(f"{target:10} {len(chosen)} inputs, {size} bytes, {len(covered)} of {len(everything)} features")
    return 0


def main():
    parser = argparse.ArgumentParser(prog="./plumb fuzz", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("targets", nargs="*", metavar="TARGET")
    parser.add_argument("--minutes", type=float, default=5, help="a target (5)")
    parser.add_argument("--seconds", type=float, help="a target, in place of minutes")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)), help="fuzzers at a time: the cores")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "fuzz")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--reduce", action="store_true")
    parser.add_argument("--keep", action="store_true")
    options = parser.parse_args()
    known = all_targets()
    if options.list:
        print("\n".join(known))
        return 0
    unknown = [target for target in options.targets if target not in known]
    seconds = options.seconds if options.seconds is not None else 60 * options.minutes
    if unknown or not seconds > 0 or options.jobs < 1:
        parser.error(f"there is no target '{unknown[0]}'; there are {', '.join(known)}" if unknown
                     else "times and jobs must be positive")
    targets = options.targets or known
    missing = [target for target in targets if not program(options.build, target).exists()]
    if missing:
        print(f"not built: {', '.join(missing)}; ./plumb fuzz builds the fuzzers", file=sys.stderr)
        return 2
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    if options.reduce:
        try:
            return reduce(targets, options.build)
        except KeyboardInterrupt:
            clear_line()
            print("interrupted; the target at work is as it was", file=sys.stderr)
            return 130
    if options.keep:
        return keep(targets, options.build)
    return fuzz(targets, options.build, seconds, options.jobs)


if __name__ == "__main__":
    sys.exit(main())
