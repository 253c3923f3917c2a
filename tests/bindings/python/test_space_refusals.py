"""plumb.space: what cannot be is refused at once, in words that name the object, the field and the value."""

import copy
import math
import pickle

import plumb
import pytest
from plumb import space as pm

NAN, INF = math.nan, math.inf


def refused(field, call, *words):
    with pytest.raises(plumb.InvalidValue) as caught:
        call()
    assert isinstance(caught.value, AssertionError)  # as in pymunk
    assert caught.value.field == field and caught.value.problem
    for word in (field, *words):
        assert word in str(caught.value)


def pair():
    space = pm.Space()
    a, b = pm.Body(1, 1), pm.Body(1, 1)
    b.position = 2, 0
    return space, a, b


@pytest.mark.parametrize("name", ["velocity_func", "position_func"])
def test_functions_that_would_not_be_called_are_refused(name):
    _, body, _ = pair()
    with pytest.raises(NotImplementedError, match=name):
        setattr(body, name, lambda *given: None)


@pytest.mark.parametrize("way", [copy.copy, copy.deepcopy, pickle.dumps])
def test_what_is_in_a_space_cannot_be_copied(way):
    space, a, b = pair()
    shape, joint = pm.Circle(a, 1), pm.PinJoint(a, b)
    space.add(a, b, shape, joint)
    for each in (space, a, shape, joint):
        with pytest.raises(NotImplementedError, match=f"{type(each).__name__}.*copied"):
            way(each)
    assert copy.copy(pm.Body(2, 3)).mass == 2


@pytest.mark.parametrize("wrong", [NAN, -0.1, 1.5, INF, "much", None])
def test_damping_out_of_range_is_refused(wrong):
    space, *_ = pair()
    refused("damping", lambda: setattr(space, "damping", wrong), repr(wrong))
    assert space.damping == 1
    space.step(0.1)


@pytest.mark.parametrize("name", ["max_force", "error_bias", "max_bias"])
@pytest.mark.parametrize("wrong", [NAN, -1, "strong"])
def test_limits_of_constraints_out_of_range_are_refused(name, wrong):
    space, a, b = pair()
    for inside in (False, True):
        joint = pm.PinJoint(a, b)
        before = getattr(joint, name)
        if inside:
            space.add(a, b, joint)
        refused(name, lambda: setattr(joint, name, wrong), "PinJoint", repr(wrong))
        assert getattr(joint, name) == before


def test_forces_that_are_not_numbers_are_refused():
    space, body, _ = pair()
    space.add(body)
    for wrong in ((NAN, 0), (0, INF)):
        with pytest.raises(plumb.InvalidValue, match="force"):
            body.force = wrong
    refused("force", lambda: setattr(body, "force", 5), "two numbers")
    refused("torque", lambda: setattr(body, "torque", NAN), "nan")
    body.force += 1, 2
    assert body.force == (1, 2) and body.torque == 0
    space.step(0.1)
    assert body.velocity == pytest.approx((0.1, 0.2))


def test_settings_of_a_space_are_refused_in_words():
    space, body, _ = pair()
    for wrong in (5, (1, 2, 3), None):
        refused("gravity", lambda: setattr(space, "gravity", wrong), "two numbers")
    with pytest.raises(plumb.InvalidValue, match="gravity's y is nan"):
        space.gravity = 0, NAN
    for wrong in (0, -1, 2.5, "10", 2501):
        refused("iterations", lambda: setattr(space, "iterations", wrong), "whole number from 1")
    for wrong in (3, -1, "dynamic", None):
        refused("body_type", lambda: setattr(body, "body_type", wrong), "Body.KINEMATIC")
        refused("body_type", lambda: pm.Body(1, 1, wrong))
    for name in ("sleep_time_threshold", "idle_speed_threshold"):
        for wrong in (NAN, -1, "long"):
            refused(name, lambda: setattr(space, name, wrong))
    space.sleep_time_threshold = INF
    space.iterations = 2500
    space.step(0.1)


def test_a_body_without_mass_is_named():
    space, body, _ = pair()
    nothing = pm.Body(0, 0)
    nothing.position = 3, 4
    space.add(body, nothing)
    refused("mass", lambda: space.step(0.1), "Body(0.0, 0.0, Body.DYNAMIC) at (3, 4)")
    nothing.mass = 1
    refused("moment", lambda: space.step(0.1), "Body(1.0, 0.0, Body.DYNAMIC) at (3, 4)")
