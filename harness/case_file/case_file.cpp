#include "harness/case_file/case_file.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/suggest.h"
#include "engine/core/text.h"
#include "engine/scene/error.h"
#include "engine/scene/json.h"
#include "harness/case_file/expected_states.h"
#include "harness/case_file/expression.h"
#include "harness/case_file/member.h"
#include "harness/text_file.h"

namespace plumb::harness::case_file {
namespace {

using scenarios::Expectation;
using scenarios::Problem;
using Law = Expectation::Law;
namespace fs = std::filesystem;

constexpr double kLongest = 1e6;  // s, of a run: a longer duration counts as a typing error

struct LawName {
  const char* name;
  Law law;
};
constexpr LawName kLaws[] = {{"energy", Law::Energy},
                             {"momentum", Law::Momentum},
                             {"angular_momentum", Law::AngularMomentum},
                             {"joints", Law::Joints},
                             {"no_overlap", Law::NoOverlap}};

/// Reads one case file.
class Reader {
 public:
  Reader(const std::string& path, const Member& root) : folder_(fs::path(path).parent_path()), root_(root) {
    root.only({"plumb_case", "name", "summary", "source", "scene", "duration", "parameters", "expect",
               "impacts", "must_pass"});
    if (root.at("plumb_case").number() != 1) root.at("plumb_case").fail(Error::Kind::Value, "must be 1");
    out_.name = root.has("name") ? root.at("name").text() : fs::path(path).stem().string();
    if (out_.name.empty() || out_.name.find_first_of("/[]") != std::string::npos)
      root.at("name").fail(Error::Kind::Name, "must not be empty nor contain '/', '[' or ']'");
    out_.summary = root.has("summary") ? root.at("summary").text() : "from the file " + plumb::quoted(path);
    out_.problem.truth.source = root.at("source").text();
    read_scene(root.at("scene"));
    out_.problem.duration = root.at("duration").number();
    if (!(out_.problem.duration > 0) || out_.problem.duration > kLongest)
      root.at("duration").fail(Error::Kind::Value, "must be a number of seconds above 0, at most 1e6");
  }

  CaseFile read() {
    names_.emplace(out_.problem.scene);
    if (root_.has("parameters"))
      root_.at("parameters").each_member([&](const std::string& name, const Member& value) {
        const Expression formula = expression(value);
        if (formula.varies()) value.fail(Error::Kind::Value, "must not depend on t or on a body's state");
        value.naming([&] { names_->add(name, formula.at(0, starts())); });
      });
    if (root_.has("impacts"))
      root_.at("impacts").each(
          [&](const Member& time) { out_.problem.truth.impacts.push_back(instant(time)); });
    if (root_.has("must_pass"))
      root_.at("must_pass").each([&](const Member& name) { out_.problem.must_pass.push_back(name.text()); });
    motions_.resize(out_.problem.scene.bodies.size());
    root_.at("expect").each([&](const Member& entry) { expect(entry); });
    if (out_.problem.expected.empty())
      root_.at("expect").fail(Error::Kind::Value,
                              "must not be empty: a case without expectations cannot fail");
    set_truth();
    return std::move(out_);
  }

 private:
  struct Motion {
    std::vector<Expression> parts;  // x, y, angle, vx, vy, w
  };

  void read_scene(const Member& scene) {
    if (scene.is_text()) {
      const std::string path = (folder_ / scene.text()).string();
      scene.naming(
          [&] { out_.problem.scene = scene_from_json(read_text(path, "it is named by a case file")); });
    } else {
      scene.naming([&] { out_.problem.scene = scene_from_json(scene.dump()); });
    }
  }

  std::vector<BodyState> starts() const {
    std::vector<BodyState> states;
    for (const Body& body : out_.problem.scene.bodies) states.push_back(initial_state(body));
    return states;
  }

  Expression expression(const Member& value) const {
    std::optional<Expression> out;
    const std::string text = value.is_text() ? value.text() : shortest(value.number());
    value.naming([&] { out.emplace(text, *names_); });
    return *out;
  }

  double instant(const Member& value) const {
    const double time = value.number();
    if (!(time >= 0) || time > out_.problem.duration)
      value.fail(Error::Kind::Value, "must be a time from 0 to the duration");
    return time;
  }

  void expect(const Member& entry) {
    constexpr const char* kKinds[] = {"of", "law", "states", "motion"};
    int kinds = 0;
    for (const char* kind : kKinds) kinds += entry.has(kind) ? 1 : 0;
    if (kinds != 1)
      entry.fail(Error::Kind::Value, "must have one of the members 'of', 'law', 'states' and 'motion'");
    if (entry.has("of")) {
      expect_figure(entry);
    } else if (entry.has("law")) {
      expect_law(entry);
    } else if (entry.has("states")) {
      expect_states(entry);
    } else {
      expect_motion(entry);
    }
  }

  void put(Expectation expectation, const Member& entry) {
    if (entry.has("name")) expectation.name = entry.at("name").text();
    out_.problem.expected.push_back(std::move(expectation));
  }

  // Reads the times of an entry: single times, or from one time until another.
  void read_times(const Member& entry, Expectation& expectation) const {
    if (entry.has("at")) {
      if (entry.at("at").is_list()) {
        entry.at("at").each([&](const Member& time) { expectation.times.push_back(instant(time)); });
      } else {
        expectation.times.push_back(instant(entry.at("at")));
      }
      if (expectation.times.empty()) entry.at("at").fail(Error::Kind::Value, "must have a time");
      std::sort(expectation.times.begin(), expectation.times.end());
    }
    if (entry.has("from")) expectation.from = instant(entry.at("from"));
    if (entry.has("until")) expectation.until = instant(entry.at("until"));
    if (entry.has("at") && (entry.has("from") || entry.has("until")))
      entry.fail(Error::Kind::Value, "must have either 'at', or 'from' and 'until'");
    if (expectation.until < expectation.from)
      entry.at("until").fail(Error::Kind::Value, "must not be before from");
  }

  void expect_figure(const Member& entry) {
    entry.only({"of", "is", "at_least", "at_most", "tolerance", "at", "from", "until", "name"});
    const Expression figure = expression(entry.at("of"));
    Expectation expectation{.name = entry.at("of").text_or_dump()};
    read_times(entry, expectation);
    const bool limits = entry.has("at_least") || entry.has("at_most");
    if (entry.has("is") == limits)
      entry.fail(Error::Kind::Value, "must have either 'is', or 'at_least' and 'at_most'");
    const auto optional = [&](const char* key) {
      return entry.has(key) ? std::optional(expression(entry.at(key))) : std::nullopt;
    };
    const auto is = optional("is"), least = optional("at_least"), most = optional("at_most");
    const Expression tolerance =
        limits && !entry.has("tolerance") ? Expression("0", *names_) : expression(entry.at("tolerance"));
    if (!tolerance.varies()) check_tolerance(entry, tolerance.at(0, starts()), limits);
    expectation.miss = [=](double time, std::span<const BodyState> states) {
      const double value = figure.at(time, states);
      double miss = is ? std::abs(value - is->at(time, states)) : std::isnan(value) ? NAN : 0;
      if (least) miss = std::max(miss, least->at(time, states) - value);
      if (most) miss = std::max(miss, value - most->at(time, states));
      return Expectation::Miss{miss, tolerance.at(time, states)};
    };
    put(std::move(expectation), entry);
  }

  static void check_tolerance(const Member& entry, double value, bool may_be_zero) {
    if (value > 0 || (may_be_zero && value == 0)) return;
    entry.at("tolerance").fail(Error::Kind::Value, "must be above 0");
  }

  void expect_law(const Member& entry) {
    entry.only({"law", "tolerance", "name"});
    const std::string name = entry.at("law").text();
    const auto* law =
        std::find_if(std::begin(kLaws), std::end(kLaws), [&](const LawName& l) { return l.name == name; });
    if (law == std::end(kLaws)) {
      std::vector<std::string> names;
      for (const LawName& known : kLaws) names.emplace_back(known.name);
      entry.at("law").fail(Error::Kind::Name, "is no law" + did_you_mean(name, names));
    }
    Expectation expectation{.name = name, .law = law->law, .tolerance = entry.at("tolerance").number()};
    check_tolerance(entry, expectation.tolerance, false);
    scenarios::Conserved& conserved = out_.problem.conserved;
    if (law->law == Law::Energy) conserved.energy = true;
    if (law->law == Law::Momentum) conserved.momentum_x = conserved.momentum_y = true;
    if (law->law == Law::AngularMomentum) conserved.angular_momentum = true;
    put(std::move(expectation), entry);
  }

  StateTolerances tolerances_of(const Member& entry) const {
    const Member given = entry.at("tolerance");
    StateTolerances out;
    if (given.is_number()) {
      check_tolerance(entry, given.number(), false);
      out.fill(given.number());
      return out;
    }
    given.only({"position", "angle", "velocity", "angular_velocity"});
    for (std::size_t kind = 0; kind < kStateKinds.size(); ++kind) {
      if (!given.has(kStateKinds[kind])) continue;
      out[kind] = given.at(kStateKinds[kind]).number();
      if (!(*out[kind] > 0)) given.at(kStateKinds[kind]).fail(Error::Kind::Value, "must be above 0");
    }
    return out;
  }

  void expect_states(const Member& entry) {
    entry.only({"states", "tolerance", "name"});
    const StateTolerances tolerances = tolerances_of(entry);
    const Member states = entry.at("states");
    std::vector<StateRow> rows;
    if (states.is_text()) {
      const std::string path = (folder_ / states.text()).string();
      states.naming([&] { rows = states_from_csv(read_text(path, "it is named by a case file"), path); });
    } else {
      rows = states_from(states);
    }
    if (rows.empty()) states.fail(Error::Kind::Value, "must have a state");
    for (Expectation& expectation : states.naming(
             [&] { return expectations_of(rows, out_.problem.scene, out_.problem.duration, tolerances); }))
      put(std::move(expectation), entry);
  }

  void expect_motion(const Member& entry) {
    entry.only({"motion", "x", "y", "angle", "vx", "vy", "w", "tolerance", "from", "until", "name"});
    const std::string name = entry.at("motion").text();
    const auto body = find_body(out_.problem.scene, name);
    if (!body) {
      std::vector<std::string> names;
      for (const Body& each : out_.problem.scene.bodies) names.push_back(each.name);
      entry.at("motion").fail(Error::Kind::Name, "is no body of the scene" + did_you_mean(name, names));
    }
    const StateTolerances tolerances = tolerances_of(entry);
    Motion motion;
    bool any = false;
    for (std::size_t c = 0; c < kStateComponents.size(); ++c) {
      const char* key = kStateComponents[c];
      if (!entry.has(key)) continue;
      any = true;
      const Expression formula = expression(entry.at(key));
      const auto tolerance = tolerances[kind_of(c)];
      if (!tolerance)
        entry.at("tolerance")
            .fail(Error::Kind::Value,
                  fmt::format("must have a member {}, as {} is given", kStateKinds[kind_of(c)], key));
      Expectation expectation{.name = formula_name(name) + "." + key};
      read_times(entry, expectation);
      const bool rate = c >= 3;
      const std::vector<double> impacts = rate ? out_.problem.truth.impacts : std::vector<double>{};
      expectation.miss = [formula, c, body = *body, tolerance = *tolerance, impacts](
                             double time, std::span<const BodyState> states) {
        for (const double impact : impacts)
          if (std::abs(time - impact) <= kImpactWindow) return Expectation::Miss{0, tolerance};
        return Expectation::Miss{std::abs(component(states[body], c) - formula.at(time, states)), tolerance};
      };
      put(std::move(expectation), entry);
      motion.parts.push_back(formula);
    }
    if (!any) entry.fail(Error::Kind::Value, "must have one of the members x, y, angle, vx, vy and w");
    if (motion.parts.size() == kStateComponents.size() && !entry.has("from") && !entry.has("until"))
      motions_[*body] = std::move(motion);
  }

  // If the file gives the motions of all moving bodies, they are the truth of the whole scene: runs then have
  // errors, and sweeps can use them.
  void set_truth() {
    const std::vector<Body>& bodies = out_.problem.scene.bodies;
    for (std::size_t i = 0; i < bodies.size(); ++i)
      if (motions_[i].parts.empty() && bodies[i].type != BodyType::Static) return;
    out_.problem.truth.exact = [motions = motions_, start = starts()](double time, std::span<BodyState> out) {
      for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = start[i];
        if (motions[i].parts.empty()) continue;
        const auto part = [&](std::size_t c) { return motions[i].parts[c].at(time, start); };
        out[i] = {{part(0), part(1)}, part(2), {part(3), part(4)}, part(5)};
      }
    };
  }

  fs::path folder_;
  const Member& root_;
  CaseFile out_;
  std::optional<Names> names_;
  std::vector<Motion> motions_;  // by body; empty unless the file gives all six
};

}  // namespace

CaseFile read_case(const std::string& path) {
  const std::string text = read_text(path, "give a case file as JSON, see docs/cases.md");
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    throw Error(Error::Kind::Syntax, "case file " + plumb::quoted(path), "", "", "is not JSON",
                1 + static_cast<int>(std::count(text.begin(), end, '\n')));
  }
  const Member root(json, path);
  if (!json.is_object() || !json.contains("plumb_case"))
    root.fail(Error::Kind::Syntax, "must be an object with the member plumb_case, see docs/cases.md");
  return Reader(path, root).read();
}

bool is_case(const std::string& path) {
  try {
    if (!fs::is_regular_file(path)) return false;
    // Looks for the key in the text, because a file with a syntax error may be meant as a case; the error
    // then says so.
    return read_text(path).find("\"plumb_case\"") != std::string::npos;
  } catch (const std::exception&) {
    return false;
  }
}

std::vector<std::string> cases_in(const std::string& folder) {
  std::vector<std::string> out;
  std::error_code code;
  if (!fs::is_directory(folder, code)) return out;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, code)) {
    const std::string path = entry.path().string();
    if (path.ends_with(".json") && is_case(path)) out.push_back(path);
  }
  std::sort(out.begin(), out.end());
  return out;
}

scenarios::Instance case_instance(const std::string& path) {
  static std::deque<scenarios::Scenario> kept;
  CaseFile file = read_case(path);
  const std::vector<scenarios::Scenario>& catalogue = scenarios::all();
  if (std::any_of(catalogue.begin(), catalogue.end(),
                  [&](const auto& other) { return other.name == file.name; }))
    throw Error(Error::Kind::Name, "case file " + plumb::quoted(path), "name", printable(file.name),
                "is already the name of a scenario; choose another");
  scenarios::Scenario& scenario = kept.emplace_back();
  scenario.name = file.name;
  scenario.summary = file.summary;
  scenario.build = [problem = std::move(file.problem)](std::string_view, int) { return problem; };
  return {&scenario, "", 1};
}

}  // namespace plumb::harness::case_file
