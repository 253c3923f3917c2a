"""Starts programs in Python by forking one that already runs, as starting Python takes longer than most checks.

with WarmStart(client) as warm: warm.command(program) is a command whose process is a fork of this one. `client` is the
program of warm/main.cpp, which hands its standard streams over. A program is compiled once.
"""
import array
import json
import math
import os
import pathlib
import random
import signal
import socket
import sys
import tempfile
import traceback

STREAMS = 3
LONGEST = 120  # s that a fork may run: one that hangs outlives the client that plumb kills


class WarmStart:
    def __init__(self, client):
        self.client = str(client)

    def __enter__(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = str(pathlib.Path(self.folder.name) / "socket")
        listener = socket.socket(socket.AF_UNIX)
        listener.bind(self.path)
        listener.listen(64)
        self.server = os.fork()
        if self.server == 0:
            os.setpgid(0, 0)
            serve(listener)
        listener.close()
        return self

    def __exit__(self, *_):
        try:
            os.killpg(self.server, signal.SIGKILL)
        except ProcessLookupError:
            os.kill(self.server, signal.SIGKILL)
        os.waitpid(self.server, 0)
        self.folder.cleanup()

    def command(self, program):
        return [self.client, self.path, str(program)]


def serve(listener):
    parent = os.getppid()
    listener.settimeout(5)
    while os.getppid() == parent:
        reap()
        try:
            connection, _ = listener.accept()
        except TimeoutError:
            continue
        connection.settimeout(None)
        size = array.array("i").itemsize
        data, ancillary, _, _ = connection.recvmsg(4096, socket.CMSG_SPACE(STREAMS * size))
        descriptors = array.array("i")
        for _, _, content in ancillary:
            descriptors.frombytes(content[: len(content) - len(content) % size])
        if len(descriptors) == STREAMS and os.fork() == 0:
            listener.close()
            run(data.decode(), descriptors, connection)
        for descriptor in descriptors:
            os.close(descriptor)
        connection.close()
    os._exit(0)


def reap():
    try:
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass
    except ChildProcessError:
        pass


def run(program, descriptors, connection):
    code = 1
    try:
        signal.alarm(LONGEST)
        for stream, descriptor in enumerate(descriptors):
            os.dup2(descriptor, stream)
            os.close(descriptor)
        sys.stdin = open(0, encoding="utf-8", closefd=False)
        sys.stdout = open(1, "w", encoding="utf-8", closefd=False)
        sys.argv = [program]
        sys.path[0] = str(pathlib.Path(program).parent)
        text = pathlib.Path(program).read_text(encoding="utf-8")
        exec(compile(text, program, "exec"), {"__name__": "__main__", "__file__": program})
        code = 0
    except SystemExit as ended:
        code = ended.code if isinstance(ended.code, int) else 0 if ended.code is None else 1
    except BaseException:
        os.write(2, traceback.format_exc().encode())
    finally:
        try:
            sys.stdout.flush()
        except OSError:
            pass
        for stream in range(STREAMS):
            os.close(stream)
        try:
            connection.send(bytes([code & 255]))
        except OSError:
            pass
        os._exit(code & 255)
