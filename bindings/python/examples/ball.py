"""A ball bounces on the ground."""

import plumb

world = plumb.World()  # gravity 9.81 m/s^2 downwards
world.create_body(plumb.Box(40, 2), type="static", position=(0, -1))
ball = world.create_body(plumb.ShapeDefinition(plumb.Circle(0.5), restitution=0.8), position=(0, 4))

for _ in range(8):
    world.step(1 / 60, count=15)
    print(f"{world.time:.2f} s: {ball.position[1]:.2f} m")
