"""A pole on a cart, as learning agents see it: a vector environment in the shape of Gymnasium's, its worlds on threads.

Where the package gymnasium is installed it is one of its VectorEnv, with spaces; without it the members are the same.
"""

import math
import time

import numpy as np
import plumb

try:
    from gymnasium import spaces
    from gymnasium.vector import AutoresetMode, VectorEnv
except ImportError:
    spaces, VectorEnv = None, object

TRACK = 2.4  # m, to either side
FALLEN = 0.4  # rad
STRENGTH = 20.0  # N, of the cart's motor
FRAME = 1 / 50  # s


class CartPole(VectorEnv):
    """Observations are (worlds, 4): position (m), velocity (m/s), angle (rad), its rate (rad/s). Actions: forces, N.

    An episode terminates when the cart leaves the track or the pole falls, and is truncated after `limit` steps; the
    step after that takes its world back to a start, with a reward of 0 (Gymnasium's next-step autoreset).
    """

    def __init__(self, worlds=64, threads=1, limit=500):
        world = plumb.World(precision="double", sleeping=False)
        rail = world.create_body(type="static")
        cart = world.create_body(plumb.ShapeDefinition(plumb.Box(0.4, 0.2), mask=0), mass=(1, 0.02, (0, 0)))
        pole = world.create_body(plumb.ShapeDefinition(plumb.Box(0.05, 1), mask=0), position=(0, 0.5),
                                 mass=(0.1, 0.1 / 12, (0, 0)))
        world.create_joint(rail, cart, plumb.Prismatic((1, 0)))
        world.create_joint(cart, pole, plumb.Revolute(anchor_b=(0, -0.5)))
        self.batch = plumb.Batch(world, worlds, [cart, pole], threads=threads)
        self.num_envs, self.limit = worlds, limit
        self.steps, self.ended = np.zeros(worlds, int), np.zeros(worlds, bool)
        self.random = np.random.default_rng()
        if spaces:
            self.metadata = {"autoreset_mode": AutoresetMode.NEXT_STEP}
            self.single_action_space = spaces.Box(-STRENGTH, STRENGTH, (), np.float64)
            self.action_space = spaces.Box(-STRENGTH, STRENGTH, (worlds,), np.float64)
            self.single_observation_space = spaces.Box(-np.inf, np.inf, (4,), np.float64)
            self.observation_space = spaces.Box(-np.inf, np.inf, (worlds, 4), np.float64)

    def reset(self, *, seed=None, options=None):
        """Takes all worlds back to a start, each with a push of its own; returns the observations and {}."""
        if seed is not None:
            self.random = np.random.default_rng(seed)
        self.batch.reset()
        self.steps[:], self.ended[:] = 0, False
        return self.observe(self.advance(self.pushes())), {}

    def step(self, forces):
        """Steps all worlds; returns observations, rewards, terminated, truncated, each an array, and {}."""
        begin = self.ended.copy()
        self.batch.reset(begin.tolist())
        self.steps = np.where(begin, 0, self.steps + 1)
        seen = self.observe(self.advance(np.where(begin, self.pushes(), np.clip(forces, -STRENGTH, STRENGTH))))
        terminated = ~begin & ((abs(seen[:, 0]) > TRACK) | (abs(seen[:, 2]) > FALLEN))
        truncated = ~begin & ~terminated & (self.steps >= self.limit)
        self.ended = terminated | truncated
        return seen, np.where(begin | terminated, 0.0, 1.0), terminated, truncated, {}

    def close(self, **_):
        """Frees nothing: worlds go with the environment."""

    def pushes(self):
        return self.random.uniform(-1, 1, self.num_envs)

    def advance(self, forces):
        actions = np.zeros((self.num_envs, 2, 3))
        actions[:, 0, 0] = forces
        return self.batch.step(actions, dt=FRAME)

    @staticmethod
    def observe(states):
        cart, pole = states[:, 0], states[:, 1]
        return np.stack([cart[:, 0], cart[:, 3], pole[:, 2], pole[:, 5]], axis=1)


if __name__ == "__main__":
    for threads in (1, 2):
        env = CartPole(worlds=256, threads=threads)
        seen, _ = env.reset(seed=1)
        ends, begin = 0, time.perf_counter()
        for _ in range(500):  # 10 s
            force = -seen @ np.array([-1.0, -2.0, 30.0, 6.0])
            seen, reward, terminated, truncated, info = env.step(force)
            ends += terminated.sum()
        spent = time.perf_counter() - begin
        print(f"{threads} thread{'s' if threads > 1 else ''}: {ends} of {len(seen)} poles fell in {500 * FRAME:.0f} s, all within "
              f"{math.degrees(abs(seen[:, 2]).max()):.1f} degrees; {500 * len(seen) / spent / 1e3:.0f} thousand steps a second")
