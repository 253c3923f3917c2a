#include "reference/simbody/tree.h"

#include <Simbody.h>

#include <exception>
#include <stdexcept>
#include <utility>

namespace plumb::reference::simbody {
namespace {

constexpr int kMostSteps = 1000000;  // to one sample

SimTK::Vec3 in_plane(const double (&v)[2]) { return {v[0], v[1], 0}; }

// Parents come first, so their angles, whole turns included, are known.
std::vector<TreeState> states_of(const std::vector<TreeLink>& links,
                                 const std::vector<SimTK::MobilizedBody>& mobiles,
                                 const SimTK::State& state) {
  std::vector<TreeState> out(links.size());
  for (std::size_t i = 0; i < links.size(); ++i) {
    const SimTK::Vec3 place = mobiles[i].getBodyOriginLocation(state),
                      rate = mobiles[i].getBodyOriginVelocity(state);
    const double base = links[i].parent < 0 ? 0 : out[static_cast<std::size_t>(links[i].parent)].angle;
    out[i] = {place[0], place[1], base + mobiles[i].getOneQ(state, 0),
              rate[0],  rate[1],  mobiles[i].getBodyAngularVelocity(state)[2]};
  }
  return out;
}

}  // namespace

struct Tree::Parts {
  Parts(std::vector<TreeLink> given, TreeForces laws)
      : links(std::move(given)), forces_of_links(std::move(laws)), matter(system), forces(system) {}

  std::vector<TreeLink> links;
  TreeForces forces_of_links;
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter;
  SimTK::GeneralForceSubsystem forces;
  std::vector<SimTK::MobilizedBody> mobiles;  // by link
  std::unique_ptr<SimTK::RungeKuttaMersonIntegrator> integrator;
};

namespace {

template <class Parts>
class Laws final : public SimTK::Force::Custom::Implementation {
 public:
  explicit Laws(const Parts& parts) : parts_(parts) {}

  void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& on_bodies,
                 SimTK::Vector_<SimTK::Vec3>&, SimTK::Vector&) const override {
    std::vector<TreeWrench> wrenches(parts_.links.size());
    parts_.forces_of_links(state.getTime(), states_of(parts_.links, parts_.mobiles, state), wrenches);
    for (std::size_t i = 0; i < wrenches.size(); ++i)
      on_bodies[parts_.mobiles[i].getMobilizedBodyIndex()] += SimTK::SpatialVec(
          SimTK::Vec3(0, 0, wrenches[i].torque), SimTK::Vec3(wrenches[i].fx, wrenches[i].fy, 0));
  }

  SimTK::Real calcPotentialEnergy(const SimTK::State&) const override { return 0; }  // not asked for

 private:
  const Parts& parts_;
};

template <class Work>
auto translated(Work work) {
  try {
    return work();
  } catch (const std::exception& error) {
    throw std::runtime_error(error.what());
  }
}

}  // namespace

Tree::Tree(std::vector<TreeLink> links, TreeForces forces, double tolerance)
    : parts_(std::make_unique<Parts>(std::move(links), std::move(forces))) {
  translated([&] {
    Parts& parts = *parts_;
    SimTK::Force::Custom(parts.forces, new Laws<Parts>(parts));  // the subsystem owns it
    for (const TreeLink& link : parts.links) {
      const SimTK::Body::Rigid rigid(SimTK::MassProperties(
          link.mass, SimTK::Vec3(0), SimTK::Inertia(link.inertia, link.inertia, link.inertia)));
      SimTK::MobilizedBody& parent = link.parent < 0
                                         ? static_cast<SimTK::MobilizedBody&>(parts.matter.updGround())
                                         : parts.mobiles[static_cast<std::size_t>(link.parent)];
      if (link.hinged) {
        parts.mobiles.push_back(SimTK::MobilizedBody::Pin(parent,
                                                          SimTK::Transform(in_plane(link.parent_anchor)),
                                                          rigid, SimTK::Transform(in_plane(link.anchor))));
      } else {
        parts.mobiles.push_back(
            SimTK::MobilizedBody::Planar(parent, SimTK::Transform(), rigid, SimTK::Transform()));
      }
    }
    SimTK::State state = parts.system.realizeTopology();
    for (std::size_t i = 0; i < parts.links.size(); ++i) {
      for (int c = 0; c < (parts.links[i].hinged ? 1 : 3); ++c) {
        parts.mobiles[i].setOneQ(state, c, parts.links[i].q[c]);
        parts.mobiles[i].setOneU(state, c, parts.links[i].u[c]);
      }
    }
    parts.integrator = std::make_unique<SimTK::RungeKuttaMersonIntegrator>(parts.system);
    parts.integrator->setAccuracy(tolerance);
    parts.integrator->setConstraintTolerance(tolerance);
    parts.integrator->setInternalStepLimit(kMostSteps);
    parts.integrator->initialize(state);
  });
}

Tree::~Tree() = default;

void Tree::advance(double time) {
  translated([&] {
    while (parts_->integrator->getTime() < time)
      if (parts_->integrator->stepTo(time) == SimTK::Integrator::ReachedStepLimit)
        throw std::runtime_error("takes more than a million steps to a sample");
  });
}

std::vector<TreeState> Tree::states() const {
  const SimTK::State& state = parts_->integrator->getState();
  parts_->system.realize(state, SimTK::Stage::Velocity);
  return states_of(parts_->links, parts_->mobiles, state);
}

}  // namespace plumb::reference::simbody
