#!/usr/bin/env python3
"""Runs the catalogue through Slurm, or through GNU parallel over ssh, on this machine, and kills parts of it on the way.

    real_schedulers.py PROGRAM slurm|parallel [--sweep] [--times FILE] [SCENE ...]

Plans a comparison of all scenes (or of those named) on plumb and Box2D, a unit a scene and engine, has the units done, and holds the
gathered results against those of `plumb compare` in one go: every error, check and status must be the same bits. Needs root.

--sweep: a sweep instead. A sweep chooses what to run by costs, which are measured anew, so another sweep makes other runs: all that
were gathered are made again here in one go (`plumb compare --again`), and every one must be the same bits.

slurm: a controller and three slurmd of its own (Debian's slurm-wlm: names of one machine, a port each) in a folder of their own.
Units are killed with SIGKILL, then a slurmd, which comes back when its node has been given up.
parallel: an sshd in each of two network namespaces. Units are killed with SIGKILL, then GNU parallel itself; it is started again.

Prints the figures; FILE gets a line "estimate seconds" for each unit, for simulate.py. Exit code 77 where a package is missing (slurm-wlm; parallel, openssh-server, iproute2).
"""

import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM = os.path.abspath(sys.argv[1]) if len(sys.argv) > 1 else ""
ENGINES = "plumb,box2d"
SKIPPED = 77
KILLED_UNITS = 8
LIMIT = 3600  # s for the whole
SWEEP_SECONDS = 540  # that a sweep of all scenes may take: some seconds for the front of each
NODES = ("n1", "n2", "n3")
HOSTS = {"plumb-host-a": "10.213.1", "plumb-host-b": "10.213.2"}  # namespace: network of its link to this one


def need(*programs):
    for program in programs:
        if shutil.which(program, path=os.environ["PATH"] + ":/usr/sbin:/sbin") is None:
            print(f"skipped: {program} is not installed")
            sys.exit(SKIPPED)
    if os.geteuid() != 0:
        print("skipped: daemons and namespaces are root's")
        sys.exit(SKIPPED)


def run(*words, **options):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise RuntimeError(f"{words}: exit code {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


def state(work):
    return json.loads(run(PROGRAM, "status", work, "--format", "json"))


def workers(work):
    """Processes that do a unit of this folder, and the programs that these have started."""
    out = []
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            words = (entry / "cmdline").read_bytes().split(b"\0")
        except OSError:
            continue
        inside = any(word.startswith(f"{work}/doing/".encode()) for word in words)
        if inside or (b"work" in words and str(work).encode() in words and b"--unit" in words and b"bash" not in words[0]
                      and b"perl" not in words[0] and b"ssh" not in words[0]):
            out.append(int(entry.name))
    return out


def kill_units(work, count):
    """Kills `count` units under way, one after the other, at instants drawn by chance."""
    killed = 0
    while killed < count:
        time.sleep(random.uniform(0.2, 1.2))
        there = workers(work)
        if not there:
            if not state(work)["free"] and not state(work)["running"]:
                break
            continue
        try:
            os.kill(random.choice(there), signal.SIGKILL)
            killed += 1
        except ProcessLookupError:
            pass
    return killed


def errors_of(folder):
    """Reads what the runs found, by scene, engine and settings asked for: nothing of when, where and how fast. Runs that were stopped
    for their time found nothing; a known limit is a remark of `compare`, not a finding."""
    out, stopped = {}, 0
    for line in (pathlib.Path(folder) / "results.jsonl").read_text().splitlines():
        row = json.loads(line)
        if row["status"] == "timeout":
            stopped += 1
            continue
        key = row["label"], row["engine"], json.dumps(row["asked"], sort_keys=True)
        checks = [{name: value for name, value in check.items() if name != "known_limit"} for check in row["checks"]]
        out[key] = json.dumps([row["metrics"], checks, row["status"], row["reason"]])
    if stopped:
        print(f"{folder}: {stopped} runs were stopped for their time")
    return out


def compare_errors(here, there):
    """Prints how the errors of both agree; True if they do."""
    shared = here.keys() & there.keys()
    differ = sorted(key for key in shared if here[key] != there[key])
    alone = [sorted(one.keys() - other.keys()) for one, other in ((there, here), (here, there))]
    print(f"{len(there)} runs of {len({key[:2] for key in there})} scenes and engines gathered, {len(here)} in one go, {len(shared)} of "
          f"them in both, {len(differ)} of these not the same bits{': ' if differ else ''}{differ[:5] if differ else ''}")
    if any(alone):
        print(f"in one alone: {[keys[:5] for keys in alone]}")
    return not differ and not any(alone)


class Slurm:
    """A controller and slurmd of its own, in `folder`."""
    daemons = {}

    def __init__(self, folder, work):
        need("sbatch", "slurmctld", "slurmd", "munged")
        self.folder, self.work = folder, work
        self.daemons = {}
        key = folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        self.munge = folder / "munge.socket"
        for name in ("state", "log", *(f"spool.{node}" for node in NODES)):
            (folder / name).mkdir()
        self.conf = folder / "slurm.conf"
        host = os.uname().nodename.split(".")[0]
        self.conf.write_text(f"""ClusterName=plumb
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort=16817
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={self.munge}
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmctldPidFile={folder}/slurmctld.pid
SlurmctldLogFile={folder}/log/slurmctld
SlurmdSpoolDir={folder}/spool.%n
SlurmdPidFile={folder}/slurmd.%n.pid
SlurmdLogFile={folder}/log/slurmd.%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=2
MpiDefault=none
ReturnToService=2
SlurmdTimeout=10
MinJobAge=300
JobRequeue=1
SwitchType=switch/none
PropagateResourceLimits=NONE
NodeName={','.join(NODES)} NodeHostname={host} NodeAddr=127.0.0.1 Port=[17101-{17100 + len(NODES)}] CPUs=1 RealMemory=16000 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
""")
        self.environment = {**os.environ, "SLURM_CONF": str(self.conf)}
        self.start("munged", "munged", "--foreground", "--force", f"--socket={self.munge}", f"--key-file={key}",
                   f"--pid-file={folder}/munge.pid", f"--seed-file={folder}/munge.seed", f"--log-file={folder}/log/munged")
        wait_for(self.munge.exists, 20, "munged")
        self.start("slurmctld", "slurmctld", "-D", "-f", self.conf)
        for node in NODES:
            self.start_node(node)
        wait_for(lambda: self.states().count("idle") == len(NODES), 60, "slurmd")

    def start(self, name, *words):
        with open(self.folder / "log" / f"{name}.out", "a") as out:
            self.daemons[name] = subprocess.Popen([str(word) for word in words], stdout=out, stderr=out,
                                                  stdin=subprocess.DEVNULL, env=self.environment)

    def start_node(self, node):
        self.start(node, "slurmd", "-D", "-N", node, "-f", self.conf)

    def states(self):
        found = subprocess.run(["sinfo", "-h", "-N", "-o", "%t"], capture_output=True, text=True, env=self.environment)
        return found.stdout.split()

    def submit(self, out):
        run(PROGRAM, "submit", self.work, "--on", "slurm", "--memory", 1000, "--out", out, env=self.environment)

    def jobs(self):
        return run("squeue", "-h", "-r", "-o", "%i %t", env=self.environment).splitlines()

    def trouble(self):
        """Kills a slurmd with what it runs, and starts it again when its node has been given up."""
        node = random.choice(NODES)
        self.daemons[node].kill()
        self.daemons[node].wait()
        killed = 1
        wait_for(lambda: any(one.startswith("down") for one in self.states()), 120, f"{node} to be given up")
        self.start_node(node)
        return f"the slurmd of {node}", killed

    def finish(self, out):
        wait_for(lambda: not self.jobs(), LIMIT, "the jobs")

    def close(self):
        for name, daemon in reversed(list(self.daemons.items())):
            daemon.terminate()
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()


class Parallel:
    """Two hosts: network namespaces of this machine, each with an sshd."""
    daemons = ()

    def __init__(self, folder, work):
        need("parallel", "sshd", "ssh", "ssh-keygen", "ip")
        self.folder, self.work = folder, work
        self.daemons, self.job = [], None
        (folder / "log").mkdir()
        for name in ("host", "user"):
            run("ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", folder / name)
        pathlib.Path("/run/sshd").mkdir(exist_ok=True)
        (folder / "known").write_text("")
        login = []
        for number, (host, net) in enumerate(HOSTS.items()):
            run("ip", "netns", "add", host)
            run("ip", "link", "add", f"plumb{number}", "type", "veth", "peer", "name", "inside", "netns", host)
            run("ip", "addr", "add", f"{net}.1/30", "dev", f"plumb{number}")
            run("ip", "link", "set", f"plumb{number}", "up")
            inside = ("ip", "netns", "exec", host)
            run(*inside, "ip", "addr", "add", f"{net}.2/30", "dev", "inside")
            for link in ("lo", "inside"):
                run(*inside, "ip", "link", "set", link, "up")
            config = folder / f"sshd{number}"
            config.write_text(f"ListenAddress {net}.2:22\nHostKey {folder}/host\nPidFile none\nStrictModes no\nUsePAM no\n"
                              f"PermitRootLogin yes\nPasswordAuthentication no\nAuthorizedKeysFile {folder}/user.pub\nMaxStartups 100\n")
            self.daemons.append(subprocess.Popen([*inside, shutil.which("sshd", path="/usr/sbin"), "-D", "-f", config],
                                                 stderr=subprocess.DEVNULL))
            login.append(f"root@{net}.2")
        (folder / "hosts").write_text("".join(f"1/{host}\n" for host in login))
        # Not in the hosts: parallel does not read back a failure in its log if the host has blanks in it.
        self.ssh = (f"ssh -i {folder}/user -o UserKnownHostsFile={folder}/known -o StrictHostKeyChecking=no "
                    "-o LogLevel=ERROR")
        for host in login:
            wait_for(lambda: subprocess.run([*self.ssh.split(), host, "true"], capture_output=True).returncode == 0, 20, "sshd")

    def submit(self, out):
        run(PROGRAM, "submit", self.work, "--on", "parallel", "--hosts", self.folder / "hosts", "--out", out, "--dry-run")
        self.start()

    def start(self):
        with open(self.folder / "log" / "parallel", "a") as log:
            self.job = subprocess.Popen(["bash", self.work / "submit/001/parallel.sh"], start_new_session=True,
                                        stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                        env={**os.environ, "PARALLEL_SSH": self.ssh})

    def trouble(self):
        os.killpg(self.job.pid, signal.SIGKILL)
        self.job.wait()
        self.start()
        return "GNU parallel itself", 1

    def finish(self, out):
        self.job.wait(LIMIT)
        done = -1
        # Killed units use up the tries of a script; it is started again as long as that brings something.
        while self.job.returncode != 0 and state(self.work)["done"] > done:
            done = state(self.work)["done"]
            self.start()
            self.job.wait(LIMIT)

    def close(self):
        for daemon in self.daemons:
            daemon.terminate()
            daemon.wait()
        for number, host in enumerate(HOSTS):
            subprocess.run(["ip", "link", "del", f"plumb{number}"], capture_output=True)
            subprocess.run(["ip", "netns", "del", host], capture_output=True)


def wait_for(what, seconds, name):
    end = time.monotonic() + seconds
    while not what():
        if time.monotonic() > end:
            raise RuntimeError(f"waited {seconds} s for {name}")
        time.sleep(0.25)


def show_logs(folder):
    for log in sorted((folder / "cluster").glob("log/*")):
        print(f"--- {log.name}\n" + "\n".join(log.read_text(errors="replace").splitlines()[-25:]), file=sys.stderr)


def main():
    if len(sys.argv) < 3 or sys.argv[2] not in ("slurm", "parallel"):
        sys.exit(__doc__)
    random.seed(39)
    times = None
    if "--times" in sys.argv:
        at = sys.argv.index("--times")
        times = pathlib.Path(sys.argv[at + 1]).absolute()
        del sys.argv[at:at + 2]
    sweep = "--sweep" in sys.argv
    if sweep:
        sys.argv.remove("--sweep")
    kind = {"slurm": Slurm, "parallel": Parallel}[sys.argv[2]]
    scenes = sys.argv[3:]
    command = ["sweep" if sweep else "compare", *scenes, "--engine", ENGINES]
    with tempfile.TemporaryDirectory(prefix="plumb-schedulers-") as name:
        folder = pathlib.Path(name)
        work, out = folder / "work", folder / "out"
        run(PROGRAM, "plan", work, *([] if sweep else ["--by-engine"]), "--unit-seconds", 0, *command,
            *(["--budget", SWEEP_SECONDS] if sweep else ["--no-cost"]))
        count = state(work)["units"]
        (folder / "cluster").mkdir()
        cluster = kind.__new__(kind)
        try:
            cluster.__init__(folder / "cluster", work)
            began = time.monotonic()
            cluster.submit(out)
            wait_for(lambda: state(work)["done"] > 0, 120, "the first unit")
            killed = kill_units(work, KILLED_UNITS)
            at = state(work)["done"]
            what, _ = cluster.trouble()
            cluster.finish(out)
            took = time.monotonic() - began
            left = {key: state(work)[key] for key in ("free", "running", "failed", "damaged")}
        except BaseException:
            show_logs(folder)
            raise
        finally:
            cluster.close()
        hosts = {json.loads((unit / "unit.json").read_text())["machine"]["host"] for unit in (work / "done").iterdir()}
        done = state(work)["done"]
        if times:
            units = [json.loads(line) for line in (work / "units.jsonl").read_text().splitlines()]
            took_each = {number: json.loads((work / f"done/{number:05}/unit.json").read_text())["seconds"]
                         for number in (unit["unit"] for unit in units) if (work / f"done/{number:05}").exists()}
            times.write_text("# A unit a line, of the catalogue on plumb and Box2D: its estimate and how long it took, s.\n" + "".join(
                f"{unit['seconds']:g} {took_each[unit['unit']]:.3f}\n" for unit in units if unit["unit"] in took_each))
        if done < count or any(left.values()):
            show_logs(folder)
            sys.exit(f"{done} of {count} units are done: {left}")
        subprocess.run([PROGRAM, "gather", work, "--out", out, "--no-report"], capture_output=True)
        # The exit code says that an engine missed a check, here as there.
        local = [PROGRAM, *(["compare", "--again", str(out), "--jobs", str(os.cpu_count())] if sweep else command),
                 "--out", str(folder / "local"), "--no-cost", "--no-report"]
        made = subprocess.run(local, capture_output=True, text=True)
        print(f"{sys.argv[2]}: {count} units planned at first, {done} done in {took:.0f} s; {killed} units killed with SIGKILL, "
              f"and after {at} were done {what}; hosts: {', '.join(sorted(hosts))}")
        if sweep:
            print(f"plumb compare --again: {(made.stdout + made.stderr).splitlines()[-1]}")
        same = compare_errors(errors_of(folder / "local"), errors_of(out))
        if not same:
            show_logs(folder)
            sys.exit(1)


if __name__ == "__main__":
    main()
