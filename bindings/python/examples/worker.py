"""plumb as an engine behind the process protocol (docs/protocol.md): plumb compare --engine-command "mine=python3 worker.py"

The scenes run in fixed steps, in double; an engine of your own answers the same four requests.
"""

import json
import sys
import time

import plumb

HELLO = {
    "protocol": 1, "name": "plumb from Python", "version": plumb.__version__, "precision": "double",
    "summary": "plumb's world by way of its Python module",
    "method": {"scheme": "soft_step", "order": 2, "epsilon": 2.220446049250313e-16, "substeps": 4},
    "shapes": ["circle", "box"], "joints": ["revolute", "distance"],
    "forces": ["linear_drag", "quadratic_drag", "point_force", "torque", "spring", "attraction", "sinusoidal_force"],
    "features": ["contacts", "filters", "kinematic", "fixed_rotation"],
}


class Engine:
    def __init__(self):
        self.simulation = None

    def answer(self, request):
        """The lines that answer a request, but quit."""
        if request["request"] == "hello":
            yield HELLO
        elif request["request"] == "load":
            settings = {"dt": request["settings"]["dt"], "substeps": request["settings"].get("substeps", 4)}
            self.simulation = plumb.Simulation.realtime(request["scene"], precision="double", sleeping=False, **settings)
            yield {"effective_settings": {**settings, "sleeping": "off"}}
        elif request["request"] == "run":
            spent = 0
            for _ in range(request["samples"]):
                before = time.perf_counter_ns()
                self.simulation.step(request["every"])
                spent += time.perf_counter_ns() - before
                yield {"t": self.simulation.time, "states": self.simulation.states.tolist()}
            yield {"done": True, "ns": spent}


def main():
    engine = Engine()
    for line in sys.stdin:
        request = json.loads(line)
        if request["request"] == "quit":
            return
        try:
            for reply in engine.answer(request):
                print(json.dumps(reply), flush=True)
        except plumb.Unsupported as error:
            print(json.dumps({"unsupported": str(error)}), flush=True)
        except plumb.Error as error:
            print(json.dumps({"error": {"kind": "run", "problem": str(error)}}), flush=True)


if __name__ == "__main__":
    main()
