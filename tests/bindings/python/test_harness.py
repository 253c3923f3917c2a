"""compare, tune and hunt from Python: they are the program's answers, and its refusals are exceptions."""

import os
import pathlib
import stat
import sys

import plumb
import pytest
from plumb import harness

STARTERS = pathlib.Path(__file__).resolve().parents[3] / "docs/course/starters/python"
BALL = {"name": "ball", "position": [0, 10], "shapes": [{"type": "circle", "radius": 0.5}]}
FALL = {"plumb_case": 1, "name": "fall", "source": "10 - g t^2/2", "duration": 1,
        "expect": [{"of": "ball.y", "is": "10 - 9.81*t*t/2", "tolerance": 1e-6}], "scene": {"bodies": [BALL]}}

pytestmark = pytest.mark.skipif(not os.environ.get("PLUMB_PROGRAM"), reason="the program plumb is not built")


def test_compare_returns_a_result_for_each_case_and_engine(tmp_path):
    results = plumb.compare("free_fall/vacuum", "bounce/e_0", engines=["plumb", "plumb-precise"], dt=1 / 120, cost=False,
                            out=tmp_path)
    assert [(r["label"], r["engine"]) for r in results] == [
        (case, engine) for case in ("free_fall/vacuum", "bounce/e_0") for engine in ("plumb", "plumb-precise")]
    assert all(r["status"] == "ok" and r["dt"] == 1 / 120 and not r["unexpected"] for r in results)
    assert (tmp_path / "results.jsonl").exists() and (tmp_path / "report.html").exists()


def test_a_case_of_ones_own_is_a_dict_and_a_miss_is_a_result():
    assert not plumb.compare(FALL, engines="plumb", cost=False)[0]["unexpected"]
    wrong = FALL | {"expect": [{"of": "ball.y", "is": "10 - 9.8*t*t/2", "tolerance": 1e-6}]}
    missed = plumb.compare(wrong, engines="plumb", cost=False)[0]
    # 0.01 m/s^2 less is 5 mm after a second.
    assert missed["metrics"]["expected_miss"] == pytest.approx(0.005 / 1e-6, rel=1e-6)
    assert missed["unexpected"]


def test_tune_takes_a_scene_and_returns_the_cheapest_first():
    tuned = plumb.tune({"name": "fall", "bodies": [BALL]}, tolerance=1e-3, budget=3, duration=1, engines=["plumb", "plumb-precise"])
    reached = [answer["reaches"] for answer in tuned["answers"] if "reaches" in answer]
    assert reached and all(each["position_error"] <= 1e-3 for each in reached)
    costs = [each["ns_per_game_step"] for each in reached]
    assert costs == sorted(costs)


HEAVY = """import sys
sys.path += [{0!r}, {0!r} + "/solved"]
from chapter5 import Engine
from plumb_engine import main


class Heavy(Engine):
    def accelerate(self):
        super().accelerate()
        super().accelerate()


main(Heavy, None)
"""


def test_hunt_returns_findings_with_their_scenes(tmp_path):
    # Everything weighs twice as much as it should.
    (tmp_path / "heavy.py").write_text(HEAVY.format(str(STARTERS)))
    commands = {"heavy": f"{sys.executable} {tmp_path}/heavy.py"}
    kinds = plumb.hunt("flight", engines="heavy", commands=commands, seed=1, scenes=20, shrinks=1, jobs=1, minutes=1)
    assert kinds and all(kind["engines"] == ["heavy"] for kind in kinds)
    plumb.Simulation.realtime(kinds[0]["finding"]["case"]["scene"]).step()


def test_refusals_are_exceptions(monkeypatch, tmp_path):
    with pytest.raises(plumb.Error, match="nosuch"):
        plumb.compare("nosuch")
    with pytest.raises(plumb.Error, match="engine"):
        plumb.tune("bounce/e_0", tolerance=1e-3, engines="nosuch")
    monkeypatch.setenv("PLUMB_PROGRAM", str(tmp_path / "absent"))
    with pytest.raises(plumb.FileError, match="absent"):
        plumb.compare("bounce")


def test_names_that_look_like_options_are_refused():
    for call in (lambda: plumb.compare("--engine-command=x=y"), lambda: plumb.compare("bounce/e_0", "-x"), lambda: plumb.tune("-h"),
                 lambda: plumb.hunt("--list"), lambda: plumb.compare("")):
        with pytest.raises(plumb.InvalidValue, match="begins with no '-'"):
            call()


def test_refusals_of_the_program_have_their_class():
    for call, value in ((lambda: plumb.compare("nosuch"), "nosuch"), (lambda: plumb.compare("bounce/e_0", engines="none"), "none"),
                        (lambda: plumb.hunt("nosuch", scenes=1), "nosuch")):
        with pytest.raises(plumb.UnknownName) as caught:
            call()
        assert caught.value.value == value
    with pytest.raises(plumb.FileError, match="nosuch.json"):
        plumb.compare("nosuch.json")
    with pytest.raises(plumb.InvalidValue) as caught:
        plumb.compare("bounce/e_0", dt=-1.0)
    assert (caught.value.field, caught.value.value) == ("dt", "-1.0")


@pytest.mark.parametrize("printed", ["", "hello"])
def test_a_program_that_does_not_answer_is_an_error(monkeypatch, tmp_path, printed):
    (tmp_path / "plumb").write_text(f"#!/bin/sh\nprintf '{printed}'\n")
    (tmp_path / "plumb").chmod(stat.S_IRWXU)
    monkeypatch.setenv("PLUMB_PROGRAM", str(tmp_path / "plumb"))
    for call in (lambda: plumb.compare("bounce"), lambda: plumb.tune("bounce"), lambda: plumb.hunt(minutes=1)):
        with pytest.raises(plumb.Error, match=printed or "nothing"):
            call()


def test_the_program_is_looked_for_in_the_package_and_on_the_path(monkeypatch, tmp_path):
    monkeypatch.delenv("PLUMB_PROGRAM")
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(harness, "_brought", lambda: None)
    with pytest.raises(plumb.FileError, match="PLUMB_PROGRAM"):
        harness.program()
    (tmp_path / "plumb").write_text("#!/bin/sh\n")
    (tmp_path / "plumb").chmod(stat.S_IRWXU)
    assert harness.program() == str(tmp_path / "plumb")
