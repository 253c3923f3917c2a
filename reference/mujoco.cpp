//! cmake: include(mujoco/library.cmake)
//! link: plumb_mujoco
//! missing: MuJoCo was not found; install libmujoco-dev and build again

// MuJoCo in double, for mechanisms: trees of hinges become joint angles, so that joints cannot open. Contacts
// are left to other engines, because MuJoCo's contacts are soft and have no coefficient of restitution.
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/text.h"
#include "engine/scene/error.h"
#include "reference/backend.h"
#include "reference/support/applied_forces.h"
#include "reference/support/mechanism.h"
#include "reference/support/range.h"
#include "reference/support/settings.h"

namespace plumb::reference {
namespace {

constexpr const char* kName = "mujoco";

enum class Stepper { RungeKutta4, Euler };

struct MujocoSettings {
  int substeps = 1;
  double substep = 0;  ///< s
  Stepper stepper = Stepper::RungeKutta4;
};

/// Writes the mechanism as MJCF with all bodies at angle 0, so that its coordinates equal the scene's. The
/// XML reader allows at most a hundred nested elements per file, so long chains continue in included files.
class Writer {
 public:
  Writer(const Scene& scene, const std::vector<Link>& links, const MujocoSettings& settings)
      : scene_(scene), links_(links), children_(links.size()) {
    for (std::size_t i = 0; i < links.size(); ++i) {
      if (links[i].parent >= 0) children_[static_cast<std::size_t>(links[i].parent)].push_back(i);
    }
    const std::string head = fmt::format(
        "<mujoco><compiler angle='radian' inertiafromgeom='false'/>"
        "<option timestep='{}' gravity='{} {} 0' integrator='{}'><flag contact='disable'/></option>"
        "<worldbody>",
        settings.substep, scene.gravity.x, scene.gravity.y,
        settings.stepper == Stepper::RungeKutta4 ? "RK4" : "Euler");
    files_.push_back(head);
    for (std::size_t i = 0; i < links.size(); ++i) {
      if (links[i].parent < 0) write(i, 0, 0);
    }
    files_[0] += "</worldbody></mujoco>";
  }

  /// The first one includes the others, by `name_of_file`.
  const std::vector<std::string>& files() const { return files_; }
  static std::string name_of_file(std::size_t file) { return fmt::format("part{}.xml", file); }

 private:
  static constexpr int kDeepest = 64;

  void write(std::size_t i, std::size_t file, int depth) {
    const Link& link = links_[i];
    const Body& body = scene_.bodies[link.body];
    const Vec2d at = link.hinged ? link.parent_anchor - link.anchor : Vec2d{};
    // Only the inertia about z matters; for a body with fixed rotation any value does.
    const double inertia = body.fixed_rotation ? body.mass : inertia_of(body);
    files_[file] += fmt::format(
        "<body name='{0}' pos='{1} {2} 0'><inertial pos='0 0 0' mass='{3}' diaginertia='{4} {4} {4}'/>", i,
        at.x, at.y, body.mass, inertia);
    if (!link.hinged) files_[file] += "<joint type='slide' axis='1 0 0'/><joint type='slide' axis='0 1 0'/>";
    if (!body.fixed_rotation)
      files_[file] += fmt::format("<joint type='hinge' axis='0 0 1' pos='{} {} 0'/>",
                                  link.hinged ? link.anchor.x : 0, link.hinged ? link.anchor.y : 0);
    for (const std::size_t child : children_[i]) {
      if (depth < kDeepest) {
        write(child, file, depth + 1);
        continue;
      }
      const std::size_t next = files_.size();
      files_.emplace_back("<mujocoinclude>");
      files_[file] += fmt::format("<include file='{}'/>", name_of_file(next));
      write(child, next, 0);
      files_[next] += "</mujocoinclude>";
    }
    files_[file] += "</body>";
  }

  const Scene& scene_;
  const std::vector<Link>& links_;
  std::vector<std::vector<std::size_t>> children_;
  std::vector<std::string> files_;
};

struct DeleteModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DeleteData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using Model = std::unique_ptr<mjModel, DeleteModel>;
using Data = std::unique_ptr<mjData, DeleteData>;

Model load(const std::vector<std::string>& xml) {
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  for (std::size_t i = 0; i < xml.size(); ++i) {
    const std::string name = Writer::name_of_file(i);
    mj_makeEmptyFileVFS(files.get(), name.c_str(), static_cast<int>(xml[i].size()));
    std::memcpy(files->filedata[mj_findFileVFS(files.get(), name.c_str())], xml[i].data(), xml[i].size());
  }
  std::array<char, 500> problem{};
  Model model(mj_loadXML(Writer::name_of_file(0).c_str(), files.get(), problem.data(),
                         static_cast<int>(problem.size())));
  mj_deleteVFS(files.get());
  if (!model) throw Error(Error::Kind::Run, "engine 'mujoco'", "scene", "", problem.data());
  return model;
}

class MujocoSimulator final : public Simulator {
 public:
  MujocoSimulator(const Scene& scene, const MujocoSettings& settings)
      : scene_(scene),
        settings_(settings),
        links_(links_of(scene_)),
        model_(load(Writer(scene_, links_, settings_).files())),
        data_(mj_makeData(model_.get())),
        link_of_(scene_.bodies.size(), -1),
        forces_(scene_) {
    for (std::size_t i = 0; i < links_.size(); ++i) {
      link_of_[links_[i].body] = static_cast<int>(i);
      mujoco_body_.push_back(mj_name2id(model_.get(), mjOBJ_BODY, std::to_string(i).c_str()));
      set_start(links_[i], mujoco_body_.back());
    }
    // By default warnings go to a file and errors end the program. Warnings are read from `data_` instead.
    mju_user_warning = [](const char*) {};
    mju_user_error = [](const char* problem) {
      throw Error(Error::Kind::Run, "engine 'mujoco'", "", "", problem);
    };
  }

  double advance(int steps) override {
    // MuJoCo evaluates forces through a global callback.
    acting_ = forces_.empty() ? nullptr : this;
    mjcb_passive = forces_.empty() ? nullptr : add_forces;
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < steps * settings_.substeps; ++i) {
      step_start_ = time();
      mj_step(model_.get(), data_.get());
      ++substeps_done_;
    }
    const auto end = std::chrono::steady_clock::now();
    mjcb_passive = nullptr;
    for (const mjtWarning bad : {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC}) {
      diverged_ = diverged_ || data_->warning[bad].number > 0;
    }
    return std::chrono::duration<double, std::nano>(end - start).count();
  }

  double time() const override { return static_cast<double>(substeps_done_) * settings_.substep; }

  void read(std::span<BodyState> out) const override {
    // Recomputes poses and velocities: a step updates only the coordinates in `data_`.
    mj_fwdPosition(model_.get(), data_.get());
    mj_fwdVelocity(model_.get(), data_.get());
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) out[i] = state_of_body(i, time());
  }

 private:
  void set_start(const Link& link, int body) {
    const Body& from = scene_.bodies[link.body];
    int at = model_->body_jntadr[body];
    const auto set = [&](double position, double velocity) {
      data_->qpos[model_->jnt_qposadr[at]] = position;
      data_->qvel[model_->jnt_dofadr[at]] = velocity;
      ++at;
    };
    if (!link.hinged) {
      set(from.position.x, from.velocity.x);
      set(from.position.y, from.velocity.y);
    }
    if (!from.fixed_rotation) set(link.angle, link.angle_speed);
  }

  BodyState state_of(std::size_t i) const {
    if (diverged_) {
      constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
      return {{kNone, kNone}, kNone, {kNone, kNone}, kNone};
    }
    const int body = mujoco_body_[i];
    const mjtNum* at = data_->xipos + 3 * body;
    mjtNum motion[6];
    mj_objectVelocity(model_.get(), data_.get(), mjOBJ_BODY, body, motion, 0);
    return {{at[0], at[1]}, angle_of(i), {motion[3], motion[4]}, motion[2]};
  }

  BodyState state_of_body(std::size_t body, double now) const {
    if (link_of_[body] >= 0) return state_of(static_cast<std::size_t>(link_of_[body]));
    BodyState state = initial_state(scene_.bodies[body]);
    state.position += now * state.velocity;
    state.angle += now * state.angular_velocity;
    return state;
  }

  /// Hinges count whole turns, so their sum along the tree does as well.
  double angle_of(std::size_t i) const {
    double sum = 0;
    for (int link = static_cast<int>(i); link >= 0; link = links_[static_cast<std::size_t>(link)].parent) {
      const int body = mujoco_body_[static_cast<std::size_t>(link)];
      if (scene_.bodies[links_[static_cast<std::size_t>(link)].body].fixed_rotation) {
        sum += scene_.bodies[links_[static_cast<std::size_t>(link)].body].angle;
        continue;
      }
      const int hinge = model_->body_jntadr[body] + model_->body_jntnum[body] - 1;
      sum += data_->qpos[model_->jnt_qposadr[hinge]];
    }
    return sum;
  }

  /// Adds forces at every stage of a step, so that laws that depend on the motion keep the method's order.
  static void add_forces(const mjModel* model, mjData* data) {
    MujocoSimulator& self = *acting_;
    const double start = self.step_start_, end = start + self.settings_.substep;
    self.forces_.apply_at(
        data->time, start, end, [&](std::size_t body) { return self.state_of_body(body, data->time); },
        [&](std::size_t body, const Wrench<double>& wrench) {
          if (self.link_of_[body] < 0) return;
          const mjtNum push[3] = {wrench.force.x, wrench.force.y, 0}, turn[3] = {0, 0, wrench.torque};
          const int link = self.mujoco_body_[static_cast<std::size_t>(self.link_of_[body])];
          mj_applyFT(model, data, push, turn, data->xipos + 3 * link, link, data->qfrc_passive);
        });
  }

  static inline thread_local MujocoSimulator* acting_ = nullptr;

  Scene scene_;
  MujocoSettings settings_;
  std::vector<Link> links_;
  Model model_;
  Data data_;
  std::vector<int> link_of_;      // by body of the scene, or -1
  std::vector<int> mujoco_body_;  // by link
  AppliedForces forces_;
  double step_start_ = 0;
  std::int64_t substeps_done_ = 0;
  bool diverged_ = false;
};

class MujocoBackend final : public Backend {
 public:
  std::string_view name() const override { return kName; }
  std::string_view summary() const override {
    return "MuJoCo: joint angles as coordinates; without contacts";
  }
  Identity identity() const override { return {.version = mj_versionString(), .precision = "double"}; }

  std::vector<Option> options() const override {
    return {{"integrator", "rk4", "rk4 or euler (semi-implicit)"}};
  }
  std::vector<Knob> knobs() const override { return {{"integrator", {"euler", "rk4"}, false}}; }

  Method method(const StepSettings& settings) const override {
    const MujocoSettings chosen = read_settings(settings);
    const bool fourth = chosen.stepper == Stepper::RungeKutta4;
    return {.scheme = fourth ? Scheme::RungeKutta4 : Scheme::SemiImplicitEuler,
            .order = fourth ? 4 : 1,
            .substep = chosen.substep,
            .epsilon = std::numeric_limits<double>::epsilon()};
  }

  std::string unsupported(const Scene& scene, const StepSettings& settings) const override {
    read_settings(settings);
    if (std::string reason = not_a_mechanism(scene); !reason.empty()) return reason;
    for (const Body& body : scene.bodies) {
      if (body.type == BodyType::Dynamic && body.mass < mjMINVAL)
        return "body " + plumb::quoted(body.name) + ": mass " + shortest(body.mass) +
               " kg is below MuJoCo's least, " + shortest(mjMINVAL) + " kg";
    }
    return out_of_range(scene, kDoubleRange);
  }

  Settings effective_settings(const Scene& scene, const StepSettings& settings) const override {
    const MujocoSettings chosen = read_settings(settings);
    Settings out{{"dt", shortest(settings.dt)},
                 {"substeps", std::to_string(chosen.substeps)},
                 {"integrator", chosen.stepper == Stepper::RungeKutta4 ? "rk4" : "euler"},
                 {"joints", "coordinates: hinges by their angle, free bodies by x, y and angle"},
                 {"contacts", "off; scenes in which shapes may touch are rejected"},
                 {"forces",
                  chosen.stepper == Stepper::RungeKutta4 ? "at every stage" : "at the start of each substep"},
                 {"linear_damping", "0"},
                 {"angular_damping", "0"},
                 {"sleeping", "off"},
                 {"filters", "the scene's"},
                 {"linear_slop", "0 m"},
                 {"continuous", "off"},
                 {"max_rotation", "none"},
                 {"inertia", "the scene's"},
                 {"precision", "double"}};
    append_contact_rules(out, scene);
    return out;
  }

  std::unique_ptr<Simulator> create(const Scene& scene, const StepSettings& settings) const override {
    return std::make_unique<MujocoSimulator>(scene, read_settings(settings));
  }

 private:
  static MujocoSettings read_settings(const StepSettings& settings) {
    check_steps(kName, settings, Stepping::Fixed);
    const OptionReader given(kName, settings, MujocoBackend().options());
    MujocoSettings out;
    out.substeps = settings.substeps.value_or(1);
    out.substep = settings.dt / out.substeps;
    out.stepper =
        given.choice<Stepper>("integrator", {{"rk4", Stepper::RungeKutta4}, {"euler", Stepper::Euler}});
    return out;
  }
};

const Registration registration{std::make_unique<MujocoBackend>()};

}  // namespace
}  // namespace plumb::reference
