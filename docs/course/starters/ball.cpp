// A physics engine to start from: one ball that falls and bounces off walls. Build it and run it through the course:
//
//     g++ -std=c++17 -O2 docs/course/starters/ball.cpp -o ball && plumb check -- ./ball
//
// plumb sends one JSON object a line, and wants one back: docs/protocol.md. Chapter 1 passes; the rest is yours.
// nlohmann-json reads it (Debian: nlohmann-json3-dev).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

using Json = nlohmann::json;

struct Vec { double x = 0, y = 0; };
Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y}; }
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y}; }
Vec operator*(double s, Vec a) { return {s * a.x, s * a.y}; }
double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y; }
Vec vec(const Json& pair) { return {pair[0], pair[1]}; }

struct Wall { Vec low, high; double restitution; };
struct Body { Vec position, velocity; double angle, spin; };
struct Engine {
  double dt = 0, radius = 0, restitution = 0;
  long steps = 0;
  std::size_t ball = 0;
  Vec gravity;
  std::vector<Body> bodies;
  std::vector<Wall> walls;

  // Returns what this engine cannot do about the scene; nothing where it can.
  std::string load(const Json& scene, const Json& settings) {
    *this = Engine{};
    dt = settings["dt"], gravity = vec(scene["gravity"]);
    int moving = 0;
    for (const Json& body : scene["bodies"]) {
      const bool moves = body["type"] == "dynamic";
      if (moves) ball = bodies.size();
      moving += moves;
      bodies.push_back({vec(body["position"]), vec(body["velocity"]), body["angle"], body["angular_velocity"]});
      for (const Json& shape : body["shapes"]) {
        if (shape["type"] != (moves ? "circle" : "box"))
          return "the ball is a circle, and all else is boxes that stand still: go on with chapter 3";
        if (body["angle"] != 0 || shape["angle"] != 0 || shape["friction"] != 0)
          return "nothing is tilted or rough: go on with chapter 4";
        if (moves) radius = shape["radius"], restitution = shape["restitution"];
        if (moves) continue;
        const Vec half = 0.5 * Vec{shape["width"], shape["height"]}, at = vec(body["position"]) + vec(shape["position"]);
        walls.push_back({at - half, at + half, shape["restitution"]});
      }
    }
    return moving == 1 ? "" : "only one body may move: go on with chapter 2";
  }

  void step() {
    Body& b = bodies[ball];
    b.velocity = b.velocity + dt * gravity;     // the velocity first,
    b.position = b.position + dt * b.velocity;  // then the position with the new velocity
    b.angle += dt * b.spin;
    for (const Wall& wall : walls) bounce(b, wall);
    ++steps;
  }

  void bounce(Body& b, const Wall& wall) {
    // The point of the box that is nearest to the ball's centre, and the way from there to the centre.
    const Vec nearest{std::clamp(b.position.x, wall.low.x, wall.high.x),
                      std::clamp(b.position.y, wall.low.y, wall.high.y)};
    const Vec way = b.position - nearest;
    const double distance = std::sqrt(dot(way, way));
    if (distance >= radius || distance == 0) return;
    const Vec normal = 1 / distance * way;
    b.position = b.position + (radius - distance) * normal;  // out of the wall
    const double closing = dot(b.velocity, normal);
    if (closing >= 0) return;  // it moves away already
    const bool rests = -closing <= 2 * std::sqrt(dot(gravity, gravity)) * dt;  // only what gravity added
    const double bounciness = rests ? 0 : std::max(restitution, wall.restitution);
    b.velocity = b.velocity - (1 + bounciness) * closing * normal;
  }

  Json states() const {
    Json rows = Json::array();
    for (const Body& b : bodies)
      rows.push_back({b.position.x, b.position.y, b.angle, b.velocity.x, b.velocity.y, b.spin});
    return rows;
  }
};

void send(const Json& message) { std::cout << message.dump() << std::endl; }

int main() {
  const Json method{{"scheme", "semi_implicit_euler"}, {"order", 1}, {"epsilon", 2.220446049250313e-16}};
  Engine engine;
  for (std::string line; std::getline(std::cin, line);) {
    const Json message = Json::parse(line);
    const std::string request = message["request"];
    if (request == "quit") return 0;
    if (request == "hello")
      send({{"protocol", 1}, {"name", "ball"}, {"version", "1"}, {"precision", "double"}, {"method", method},
            {"shapes", {"circle", "box"}}, {"features", Json::array({"contacts"})}});
    if (request == "load") {
      const std::string reason = engine.load(message["scene"], message["settings"]);
      const Json ready{{"effective_settings", {{"dt", engine.dt}, {"resting_speed", "2 g dt"}}}};
      send(reason.empty() ? ready : Json{{"unsupported", reason}});
    }
    if (request != "run") continue;
    const auto start = std::chrono::steady_clock::now();
    for (int sample = 0; sample < message["samples"]; ++sample) {
      for (int step = 0; step < message["every"]; ++step) engine.step();
      send({{"t", static_cast<double>(engine.steps) * engine.dt}, {"states", engine.states()}});
    }
    const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - start;
    send({{"done", true}, {"ns", spent.count()}});
  }
}
