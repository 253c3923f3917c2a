#include "bench/field/builder.h"

#include "bench/field/heap.h"

namespace plumb::field {
namespace {

/// Adds the time and the allocations of its own lifetime to a cost.
class Meter {
 public:
  Meter(Cost& cost, clockid_t clock)
      : cost_(cost),
        clock_(clock),
        allocations_(heap::allocations()),
        bytes_(heap::live_bytes()),
        start_(seconds_of(clock)) {}
  ~Meter() {
    cost_.seconds += seconds_of(clock_) - start_;
    cost_.allocations += heap::allocations() - allocations_;
    cost_.bytes += heap::live_bytes() - bytes_;
  }
  Meter(const Meter&) = delete;
  Meter& operator=(const Meter&) = delete;

 private:
  Cost& cost_;
  clockid_t clock_;
  std::int64_t allocations_, bytes_;
  double start_;
};

}  // namespace

double seconds_of(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Counts Inventory::counts() const {
  Counts out;
  for (const BodyRecord& body : bodies) {
    if (!body.alive) continue;
    ++out.bodies;
    out.shapes += static_cast<int>(body.shapes.size());
  }
  for (const JointRecord& joint : joints) out.joints += joint.alive;
  return out;
}

template <class Call>
auto Builder::metered(const Call& call) {
  const Meter meter(cost_, clock_);
  return call();
}

int Builder::create_body(const BodyDefinition& body, std::span<const ShapeDefinition> shapes) {
  BodyRecord record{{}, body, {shapes.begin(), shapes.end()}, {}, true};
  if (body.type == BodyType::Dynamic) record.mass = mass_of(shapes);
  record.handle = metered([&] { return world_.create_body(body, shapes, record.mass); });
  inventory_.bodies.push_back(std::move(record));
  return static_cast<int>(inventory_.bodies.size()) - 1;
}

int Builder::create_body(const BodyDefinition& body, const ShapeDefinition& shape) {
  return create_body(body, std::span(&shape, 1));
}

int Builder::create_body(const BodyDefinition& body, const std::vector<ShapeDefinition>& shapes) {
  return create_body(body, std::span(shapes));
}

void Builder::destroy_body(int body) {
  BodyRecord& record = inventory_.bodies.at(body);
  metered([&] { world_.destroy_body(record.handle); });
  record.alive = false;
  for (JointRecord& joint : inventory_.joints)
    if (joint.a == body || joint.b == body) joint.alive = false;
}

void Builder::create_revolute(int a, int b, const RevoluteDefinition& joint) {
  const BodyHandle first = inventory_.bodies.at(a).handle, second = inventory_.bodies.at(b).handle;
  metered([&] { world_.create_revolute(first, second, joint); });
  inventory_.joints.push_back({a, b, joint, true});
}

void Builder::set_velocity(int body, Vec2d velocity, double spin) {
  const BodyHandle handle = inventory_.bodies.at(body).handle;
  metered([&] { world_.set_velocity(handle, velocity, spin); });
}

void Builder::step(int count) {
  metered([&] {
    for (int i = 0; i < count; ++i) world_.step();
  });
}

std::vector<BodyState> Builder::states() const {
  std::vector<BodyState> out(inventory_.bodies.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    if (inventory_.bodies[i].alive) out[i] = world_.state(inventory_.bodies[i].handle);
  return out;
}

}  // namespace plumb::field
