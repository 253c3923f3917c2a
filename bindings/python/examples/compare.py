"""Holds two engines against a closed form, and asks for the cheapest settings that reach it."""

import plumb

SPRING = {
    "plumb_case": 1, "name": "ball_on_spring", "source": "x = rest + A cos(omega t)", "duration": 2,
    "expect": [{"of": "ball.x", "is": "1 + 0.5*cos(5*t)", "tolerance": 0.01}],  # m
    "scene": {"gravity": [0, 0],
              "bodies": [{"name": "ball", "position": [1.5, 0], "mass": 2, "shapes": [{"type": "circle", "radius": 0.1}]}],
              "forces": [{"type": "spring", "body_a": "world", "body_b": "ball", "rest_length": 1, "stiffness": 50}]},
}

for result in plumb.compare(SPRING, engines=["plumb", "plumb-precise"], cost=False):
    miss = 1000 * 0.01 * result["metrics"]["expected_miss"]
    print(f"{result['engine']:14} {miss:.2f} mm off" if miss > 0.005 else f"{result['engine']:14} exact to 0.01 mm")

answer = plumb.tune(SPRING, engines="plumb", budget=5)["answers"][0]
print("one step a frame is enough" if answer["steps_per_game_step"] == 1 else "more steps a frame are needed")
