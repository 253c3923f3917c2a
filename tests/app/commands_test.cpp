#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "engine/scene/json.h"
#include "reference/backend.h"
#include "scenarios/scenario.h"
#include "tests/app/program.h"

namespace plumb::app {
namespace {

using Json = nlohmann::json;

TEST(List, NamesEveryScenario) {
  const std::string text = plumb({"list"}).out;
  const Json json = Json::parse(plumb({"list", "--format", "json"}).out);
  ASSERT_EQ(json.size(), scenarios::all().size());
  for (std::size_t i = 0; i < json.size(); ++i) {
    const scenarios::Scenario& scenario = scenarios::all()[i];
    EXPECT_NE(text.find(scenario.name), std::string::npos);
    EXPECT_EQ(json[i]["name"], scenario.name);
    EXPECT_EQ(json[i]["sizes"], Json(scenario.sizes));
  }
}

TEST(List, ShowsTheCasesThatAFilterLets) {
  const Ran ran = plumb({"list", "--filter", "COULOMB", "--truth", "closed_form"});
  EXPECT_NE(ran.out.find("ramp_block"), std::string::npos);
  EXPECT_EQ(ran.out.find("vertical_stack"), std::string::npos);
  const Json json = Json::parse(plumb({"list", "--truth", "equilibrium", "--format", "json"}).out);
  ASSERT_FALSE(json.empty());
  for (const Json& scenario : json)
    for (const Json& one : scenario["cases"]) EXPECT_EQ(one["truth"], "equilibrium");
  EXPECT_EQ(plumb({"list", "--filter", "perpetual motion"}).code, 2);
  EXPECT_EQ(plumb({"list", "--truth", "guessed"}).code, 2);
}

TEST(New, WritesAScenarioOnceAndNothingElse) {
  const Folder folder;
  const Ran ran = plumb({"new", "scenario", "rolling_ring", "--folder", folder.path()});
  EXPECT_EQ(ran.code, 0) << ran.err;
  std::ifstream file(folder.path("rolling_ring.cpp"));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(text.find(".name = \"rolling_ring\""), std::string::npos);
  EXPECT_EQ(text.find("new_scenario_name"), std::string::npos);
  EXPECT_EQ(plumb({"new", "scenario", "rolling_ring", "--folder", folder.path()}).code, 2);
  EXPECT_EQ(plumb({"new", "scenario", "Rolling/Ring", "--folder", folder.path()}).code, 2);
  EXPECT_EQ(plumb({"new", "scenario", "ring", "--folder", folder.path("nowhere")}).code, 2);
}

TEST(Engines, NamesEveryEngineAndWhyOneIsMissing) {
  const std::string text = plumb({"engines"}).out;
  const Json json = Json::parse(plumb({"engines", "--format", "json"}).out);
  ASSERT_GT(json.size(), reference::backends().size()) << "those from npm are listed too";
  for (const Json& engine : json) {
    EXPECT_NE(text.find(engine["name"].get<std::string>()), std::string::npos);
    const std::string reason = engine["reason"];
    EXPECT_EQ(engine["installed"].get<bool>(), reason.empty());
    if (engine["installed"]) {
      EXPECT_FALSE(engine["version"].get<std::string>().empty());
    }
  }
}

TEST(Explain, ListsStagesWithReasonsAndShares) {
  const Json json = Json::parse(plumb({"explain", "pendulum_chain[5]", "--format", "json"}).out);
  EXPECT_EQ(json["driver"], "world<double>");
  double share = 0;
  for (const Json& stage : json["stages"]) {
    EXPECT_FALSE(stage["why"].get<std::string>().empty());
    if (!stage["active"]) {
      EXPECT_EQ(stage["share"], 0);
    }
    share += stage["share"].get<double>();
  }
  EXPECT_NEAR(share, 1, 1e-9);
  EXPECT_EQ(
      Json::parse(plumb({"explain", "free_fall/vacuum", "--precise", "--format", "json"}).out)["driver"],
      "precise");
  EXPECT_EQ(Json::parse(plumb({"explain", "free_fall/vacuum", "--engine", "plumb-float", "--format", "json"})
                            .out)["driver"],
            "world<float>");
  const Ran text = plumb({"explain", "pendulum_chain[5]"});
  for (const Json& stage : json["stages"])
    EXPECT_NE(text.out.find(stage["name"].get<std::string>()), std::string::npos);
}

TEST(Run, CsvHasALineABodyAndSample) {
  const Ran ran = plumb({"run", "free_fall/vacuum", "--rate", "10", "--duration", "2"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  const auto lines = lines_of(ran.out);
  const std::size_t bodies = scenarios::select("free_fall/vacuum")[0].build().scene.bodies.size();
  ASSERT_EQ(lines.size(), 1 + 21 * bodies);
  EXPECT_EQ(lines[0], "t,body,x,y,angle,vx,vy,w");
  EXPECT_EQ(lines[1].substr(0, 2), "0,");
  EXPECT_EQ(lines[lines.size() - 1].substr(0, 2), "2,");
}

TEST(Run, JsonHasALineASampleAndStartsWithTheScene) {
  const Ran ran = plumb({"run", "free_fall/vacuum", "--format", "json", "--duration", "1"});
  const auto lines = lines_of(ran.out);
  ASSERT_EQ(lines.size(), 61u);
  const Scene scene = scenarios::select("free_fall/vacuum")[0].build().scene;
  const Json first = Json::parse(lines[0]);
  EXPECT_EQ(first["t"], 0);
  ASSERT_EQ(first["bodies"].size(), scene.bodies.size());
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Json& body = first["bodies"][i];
    EXPECT_EQ(body["name"], scene.bodies[i].name);
    EXPECT_EQ(body["x"], scene.bodies[i].position.x);
    EXPECT_EQ(body["y"], scene.bodies[i].position.y);
    EXPECT_EQ(body["vx"], scene.bodies[i].velocity.x);
    EXPECT_EQ(body["vy"], scene.bodies[i].velocity.y);
    EXPECT_EQ(body["w"], scene.bodies[i].angular_velocity);
    EXPECT_EQ(body["angle"], scene.bodies[i].angle);
  }
  for (std::size_t k = 0; k < lines.size(); ++k)
    EXPECT_DOUBLE_EQ(Json::parse(lines[k])["t"], static_cast<double>(k) / 60);
}

// A spring of 1e9 N/m that is let go stretched is beyond what these engines follow at this step. A state that
// is no number is no data: the run fails, and what is on stdout are numbers.
TEST(Run, AStateThatIsNotFiniteIsAFailureAndNotData) {
  const std::string scene = R"({"name": "stiff",
    "bodies": [{"name": "left", "position": [0, 0], "mass": 1, "inertia": 1,
                "shapes": [{"type": "circle", "radius": 0.1}]},
               {"name": "right", "position": [1.5, 0], "mass": 1, "inertia": 1,
                "shapes": [{"type": "circle", "radius": 0.1}]}],
    "forces": [{"type": "spring", "body_a": "left", "body_b": "right", "stiffness": 1e9, "rest_length": 1}]})";
  for (const std::string engine : {"bullet", "bullet-double"}) {
    for (const std::string format : {"csv", "json"}) {
      const Ran ran =
          plumb({"run", "-", "--engine", engine, "--duration", "2", "--format", format}, {}, scene);
      if (ran.err.find("not installed") != std::string::npos) continue;
      EXPECT_EQ(ran.code, 1) << engine << ran.err;
      EXPECT_NE(ran.err.find("not finite"), std::string::npos) << ran.err;
      EXPECT_NE(ran.err.find("engine '" + engine + "'"), std::string::npos) << ran.err;
      EXPECT_FALSE(ran.out.empty()) << "what came before is there";
      for (const char* no_number : {"nan", "inf", "null"})
        EXPECT_EQ(ran.out.find(no_number), std::string::npos) << engine << " writes " << no_number;
    }
  }
}

TEST(Run, TwiceGivesTheSameBits) {
  for (const char* engine : {"plumb", "plumb-float", "plumb-precise"}) {
    const std::vector<std::string> arguments = {"run", "pendulum_chain[5]", "--engine", engine};
    const Ran first = plumb(arguments);
    EXPECT_EQ(first.code, 0) << first.err;
    EXPECT_GT(first.out.size(), 1000u);
    EXPECT_EQ(first.out, plumb(arguments).out) << engine;
  }
}

TEST(Run, ASceneThatWasPrintedRunsTheSame) {
  const Folder folder;
  for (const char* name :
       {"free_fall/drag", "elastic_collision/oblique", "off_centre_torque/thruster", "pendulum_chain[2]"}) {
    const Ran scene = plumb({"scene", name});
    EXPECT_EQ(scene.code, 0) << scene.err;
    const std::string file = folder.write("scene.json", scene.out);
    for (const char* engine : {"plumb", "plumb-precise"}) {
      const Ran from_file = plumb({"run", file, "--engine", engine});
      EXPECT_EQ(from_file.code, 0) << from_file.err;
      EXPECT_EQ(from_file.out, plumb({"run", name, "--engine", engine}).out) << name << " on " << engine;
    }
    EXPECT_EQ(plumb({"run", "-"}, {}, scene.out).out, plumb({"run", name}).out) << name << " from stdin";
    EXPECT_EQ(plumb({"scene", file}).out, scene.out) << name;
    EXPECT_EQ(scene_from_json(scene.out), scenarios::select(name)[0].build().scene);
  }
}

TEST(Run, SettingsChangeTheMotion) {
  const Ran verlet = plumb({"run", "free_fall/drag", "--duration", "1"});
  const Ran euler = plumb({"run", "free_fall/drag", "--duration", "1", "--set", "integrator=explicit_euler"});
  const Ran one = plumb({"run", "free_fall/drag", "--duration", "1", "--substeps", "1"});
  EXPECT_EQ(euler.code, 0) << euler.err;
  EXPECT_NE(verlet.out, euler.out);
  EXPECT_NE(verlet.out, one.out);
}

TEST(Bench, ListsABenchmarkAScenarioEngineAndSize) {
  const Ran ran = plumb({"bench", "--benchmark_list_tests"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  std::size_t expected = 0;
  for (const auto& scenario : scenarios::all())
    expected += scenarios::select(scenario.name).size() * reference::backends().size();
  EXPECT_EQ(lines_of(ran.out).size(), expected);
  const Ran json = plumb({"bench", "--benchmark_filter=free_fall/vacuum/plumb/", "--benchmark_format=json",
                          "--benchmark_min_time=0.01"});
  EXPECT_GT(Json::parse(json.out)["benchmarks"][0]["real_time"].get<double>(), 0);
}

}  // namespace
}  // namespace plumb::app
