"""The Python module: joints are read back as they were created, changed, and passed back."""

import math

import plumb
import pytest

# Every argument of every kind, none at its default.
KINDS = [
    plumb.Distance(length=2.0, anchor_a=(0.1, 0.2), anchor_b=(0.3, 0.4), spring=(3.0, 0.5), range=(1.0, 3.0),
                   motor=(0.5, 9.0)),
    plumb.Revolute(anchor_a=(0.1, 0.2), anchor_b=(0.3, 0.4), reference_angle=0.3, limits=(-1.0, 1.0), motor=(2.0, 50.0),
                   spring=(3.0, 0.5), target_angle=0.25),
    plumb.Prismatic((0.6, 0.8), anchor_a=(0.1, 0.2), anchor_b=(0.3, 0.4), reference_angle=0.3, limits=(-1.0, 1.0),
                    motor=(2.0, 50.0), spring=(3.0, 0.5), target_translation=0.25),
    plumb.Weld(anchor_a=(0.1, 0.2), anchor_b=(0.3, 0.4), reference_angle=0.3, linear_spring=(3.0, 0.5),
               angular_spring=(4.0, 0.25)),
    plumb.Wheel((0.6, 0.8), anchor_a=(0.1, 0.2), anchor_b=(0.3, 0.4), spring=(3.0, 0.5), limits=(-1.0, 1.0),
                motor=(2.0, 50.0)),
    plumb.Motor(target_position=(0.1, 0.2), target_angle=0.3, max_force=4.0, max_torque=5.0, spring=(3.0, 0.5)),
    plumb.Mouse((0.1, 0.2), max_force=4.0, anchor_b=(0.3, 0.4), spring=(3.0, 0.5)),
    plumb.Gear(2.0, 0.5),
    plumb.Pulley((0.1, 5.0), (3.0, 5.0), anchor_a=(0.1, 0.2), anchor_b=(0.3, 0.4), ratio=2.0, length=15.0),
    plumb.Ratchet(0.2, 0.5),
    plumb.Friction(4.0, 5.0, anchor_a=(0.1, 0.2), anchor_b=(0.3, 0.4)),
]


def name_of(kind):
    return type(kind).__name__


@pytest.mark.parametrize("kind", KINDS, ids=name_of)
def test_a_joint_is_read_back_as_it_was_created(kind):
    world = plumb.World(gravity=(0, 0))
    a, b = (world.create_body(plumb.Circle(0.5), position=(x, 0)) for x in (0, 2))
    joint = world.create_joint(a, b, kind)
    assert type(joint.kind) is type(kind)
    assert repr(joint.kind) == repr(kind)  # names and values of all arguments
    # The text creates the same again, with the values that this file gives.
    again = eval(repr(kind))
    assert repr(again) == repr(kind)
    joint.change(again)
    joint.change(joint.kind.replace())
    assert repr(joint.kind) == repr(kind)


def test_arguments_are_attributes():
    hinge = KINDS[1]
    assert (hinge.anchor_a, hinge.limits, hinge.motor, hinge.spring) == ((0.1, 0.2), (-1, 1), (2, 50), (3, 0.5))
    assert (hinge.reference_angle, hinge.target_angle) == (0.3, 0.25)
    assert plumb.Revolute().motor is None and plumb.Pulley((0, 1), (1, 1)).length is None
    assert (KINDS[6].target, KINDS[6].max_force, KINDS[7].ratio, KINDS[9].tooth) == ((0.1, 0.2), 4, 2, 0.2)
    assert repr(plumb.Gear()) == "plumb.Gear(ratio=-1.0, phase=0.0)"
    with pytest.raises(AttributeError):
        hinge.motor = (1, 1)


def test_a_definition_is_read_changed_and_passed_back():
    world = plumb.World(gravity=(0, 0))
    post = world.create_body(type="static")
    arm = world.create_body(plumb.Box(1, 0.2))
    joint = world.create_joint(post, arm, plumb.Revolute(motor=(2, 50)))
    before = joint.kind
    joint.change(before.replace(motor=(-3, 50)))
    assert (joint.kind.motor, joint.kind.anchor_b, before.motor) == ((-3, 50), (0, 0), (2, 50))
    world.step(count=60)
    assert arm.angular_velocity == pytest.approx(-3, rel=1e-5)
    joint.change(joint.kind.replace(motor=None))
    assert joint.kind.motor is None
    with pytest.raises(TypeError):
        joint.kind.replace(engine=(1, 1))
    assert math.isinf(plumb.Distance(range=(1, math.inf)).range[1])
