"""A pole on a cart, as learning agents see it: the shape of a Gymnasium environment, for many worlds at once."""

import math

import numpy as np
import plumb

TRACK = 2.4  # m, to either side
FALLEN = 0.4  # rad


class CartPole:
    """Observations are (worlds, 4): position (m), velocity (m/s), angle (rad), its rate (rad/s). Actions: forces, N."""

    def __init__(self, worlds=64, threads=1):
        world = plumb.World(precision="double", sleeping=False)
        rail = world.create_body(type="static")
        cart = world.create_body(plumb.ShapeDefinition(plumb.Box(0.4, 0.2), mask=0), mass=(1, 0.02, (0, 0)))
        pole = world.create_body(plumb.ShapeDefinition(plumb.Box(0.05, 1), mask=0), position=(0, 0.5),
                                 mass=(0.1, 0.1 / 12, (0, 0)))
        world.create_joint(rail, cart, plumb.Prismatic((1, 0)))
        world.create_joint(cart, pole, plumb.Revolute(anchor_b=(0, -0.5)))
        self.batch = plumb.Batch(world, worlds, [cart, pole], threads=threads)

    def reset(self, seed=None):
        self.batch.reset()
        push = np.zeros((len(self.batch), 2, 3))
        push[:, 0, 0] = np.random.default_rng(seed).uniform(-1, 1, len(self.batch))
        return self.observe(self.batch.step(push, dt=1 / 50)), {}

    def step(self, forces):
        actions = np.zeros((len(self.batch), 2, 3))
        actions[:, 0, 0] = forces
        seen = self.observe(self.batch.step(actions, dt=1 / 50))
        terminated = (abs(seen[:, 0]) > TRACK) | (abs(seen[:, 2]) > FALLEN)
        return seen, np.where(terminated, 0.0, 1.0), terminated, np.zeros_like(terminated), {}

    @staticmethod
    def observe(states):
        cart, pole = states[:, 0], states[:, 1]
        return np.stack([cart[:, 0], cart[:, 3], pole[:, 2], pole[:, 5]], axis=1)


if __name__ == "__main__":
    env = CartPole()
    seen, _ = env.reset(seed=1)
    for _ in range(500):  # 10 s
        force = -seen @ np.array([-1.0, -2.0, 30.0, 6.0])
        seen, reward, terminated, truncated, info = env.step(np.clip(force, -20, 20))
    print(f"{int((~terminated).sum())} of {len(terminated)} poles stand after {500 / 50:.0f} s, "
          f"within {math.degrees(abs(seen[:, 2]).max()):.1f} degrees")
