"""Drops a box, casts a ray at it, saves, goes on, restores and goes on again: the same hash both times."""

import plumb

world = plumb.World()
world.create_body(plumb.Box(40, 2), type="static", position=(0, -1))
box = world.create_body(plumb.Box(1, 1), position=(0, 4), angle=0.3)
world.step(1 / 60, count=60)

hit = world.ray_cast((0, 10), (0, -20))
print(f"the ray hits at {hit['point'][1]:.6f} m")

saved = world.save()
world.step(1 / 60, count=60)
after = world.hash()
print(f"the box is at {box.position[1]:.6f} m, hash {after:016x}")

world.restore(saved)
world.step(1 / 60, count=60)
print("restored:", "the same hash" if world.hash() == after else "another hash")
