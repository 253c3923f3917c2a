"""Chapter 5's other way to hold a joint, on the solved chapter 5: bodies move freely, positions are corrected until
the joints are closed, and velocities are displacements over the step. `--spin-lost` makes a mistake on purpose: a
hundredth of the displacement is lost in each step."""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../docs/course/starters/python/solved"))
import chapter5  # noqa: E402
from plumb_engine import main  # noqa: E402

KEPT = 0.99 if "--spin-lost" in sys.argv else 1.0
chapter5.SHARE = 1.0  # all of an error, in each correction


class Engine(chapter5.Engine):
    hello = {**chapter5.Engine.hello, "name": "by positions"}

    def step(self):
        before = [(body.position, body.angle) for body in self.bodies]
        self.accelerate()
        self.move()
        for _ in range(chapter5.CORRECTIONS):
            for joint in self.joints:
                joint.correct()
        for body, (position, angle) in zip(self.bodies, before):
            if body.inverse_mass > 0 and self.joints:
                body.velocity = (body.position - position) * (KEPT / self.dt)
                body.spin = (body.angle - angle) * (KEPT / self.dt)
        contacts = self.find_contacts()
        for contact in contacts:
            self.prepare(contact)
        for _ in range(chapter5.SWEEPS):
            for contact in contacts:
                self.solve(contact)
        self.push_apart()
        self.steps += 1


if __name__ == "__main__":
    sys.argv[1:] = []
    main(Engine, {})
