#include "bench/field/report.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/environment.h"

namespace plumb::field {
namespace {

using Ink = harness::Style::Ink;

// Engines with which times are compared: the first one that was measured.
constexpr const char* kYardsticks[] = {"box2d-v3", "box2d"};

double least(const Measurement& m) { return *std::ranges::min_element(m.step_seconds); }
double most(const Measurement& m) { return *std::ranges::max_element(m.step_seconds); }

double least_share(const Measurement& m) { return *std::ranges::min_element(m.cpu_share); }

/// Returns the speed relative to the yardstick; nullopt if there is none.
std::optional<double> speed_ratio(const Measurement& m, const Measurement* yardstick) {
  if (yardstick == nullptr || !m.failure.empty()) return std::nullopt;
  return median(yardstick->step_seconds) / median(m.step_seconds);
}

double nanoseconds_a_body(const Measurement& m) {
  return m.asked.bodies == 0 ? 0 : median(m.step_seconds) * 1e9 / m.asked.bodies;
}

std::string metres(double value) {
  if (value == 0) return "0";
  if (value < 1e-4) return fmt::format("{:.2g} um", value * 1e6);
  if (value < 1) return fmt::format("{:.3g} mm", value * 1e3);
  return fmt::format("{:.3g} m", value);
}

struct Column {
  std::string head;
  std::string (*cell)(const Measurement&, const Measurement* yardstick);
  bool (*told)(const Measurement&) = [](const Measurement&) { return true; };
};

/// Formats a time in three digits.
std::string time_cell(const Measurement& m, const Measurement*) {
  const double time = median(m.step_seconds);
  const auto [scale, unit] = time < 1e-6   ? std::pair{1e9, "ns"}
                             : time < 1e-3 ? std::pair{1e6, "us"}
                                           : std::pair{1e3, "ms"};
  const double value = time * scale;
  return fmt::format("{:.{}f} {}", value, value < 10 ? 2 : value < 100 ? 1 : 0, unit);
}

std::string range_cell(const Measurement& m, const Measurement*) {
  const double middle = median(m.step_seconds);
  return fmt::format("{:+.0f}/{:+.0f} %", 100 * (least(m) / middle - 1), 100 * (most(m) / middle - 1));
}

/// Adds "~" if the repetitions of the two overlap, because noise then hides which one is faster.
std::string ratio_cell(const Measurement& m, const Measurement* yardstick) {
  const auto ratio = speed_ratio(m, yardstick);
  if (!ratio) return "";
  const bool apart = &m == yardstick || least(m) > most(*yardstick) || most(m) < least(*yardstick);
  return fmt::format("{}{:.2f}x", apart ? "" : "~", *ratio);
}

bool has_pairs(const Measurement& m) {
  return m.quality.near > 0 || m.quality.overlapping > 0 || m.counted.touching > 0;
}
bool has_overlaps(const Measurement& m) { return m.quality.deepest > 0; }
bool has_joints(const Measurement& m) { return m.asked.joints > 0; }
bool has_limits(const Measurement& m) { return m.quality.worst_limit > 0; }
bool has_bodies(const Measurement& m) { return m.asked.bodies > 0; }

const std::vector<Column>& columns() {
  using M = const Measurement&;
  using Y = const Measurement*;
  static const std::vector<Column> all{
      {"step", time_cell},
      {"spread", range_cell, [](M m) { return m.step_seconds.size() > 1; }},
      {"cpu", [](M m, Y) { return fmt::format("{:.0f} %", 100 * least_share(m)); },
       [](M m) { return least_share(m) < 0.95; }},
      {"speed", ratio_cell},
      {"ns/body", [](M m, Y) { return fmt::format("{:.0f}", nanoseconds_a_body(m)); }, has_bodies},
      {"touching", [](M m, Y) { return fmt::format("{}", m.counted.touching); }, has_pairs},
      {"near", [](M m, Y) { return fmt::format("{}", m.quality.near); }, has_pairs},
      {"height", [](M m, Y) { return m.height ? fmt::format("{:.2f} %", 100 * *m.height) : ""; },
       [](M m) { return m.height.has_value(); }},
      {"deepest", [](M m, Y) { return metres(m.quality.deepest); }, has_overlaps},
      {"overlap", [](M m, Y) { return metres(m.quality.mean_depth); }, has_overlaps},
      {"joint max", [](M m, Y) { return metres(m.quality.worst_joint); }, has_joints},
      {"mean", [](M m, Y) { return metres(m.quality.mean_joint); }, has_joints},
      {"limit", [](M m, Y) { return fmt::format("{:.1f} deg", m.quality.worst_limit * 57.29577951308232); },
       has_limits},
      {"escaped", [](M m, Y) { return fmt::format("{}", m.escaped); }, [](M m) { return m.escaped > 0; }},
      {"speed rms", [](M m, Y) { return fmt::format("{:.2g}", m.speed.rms); }, has_bodies},
      {"max m/s", [](M m, Y) { return fmt::format("{:.2g}", m.speed.max); }, has_bodies},
      {"energy", [](M m, Y) { return fmt::format("{:.3g} J", m.quality.kinetic_energy); }, has_bodies},
      {"B/body", [](M m, Y) { return fmt::format("{:.0f}", m.bytes_a_body); },
       [](M m) { return m.bytes_a_body > 0; }},
      {"allocs", [](M m, Y) { return fmt::format("{:.3g}", m.allocations_a_step); }},
  };
  return all;
}

bool worked(const Measurement& m) { return m.failure.empty(); }

/// Formats the fractions of a step's stages, one per line; empty if they were not measured.
std::string stages_text(const Measurement& m) {
  double sum = 0;
  for (const auto& [name, ns] : m.stages) sum += ns;
  if (!(sum > 0)) return "";
  std::string out = fmt::format("  stages of {}, by the wall clock\n", m.engine->name);
  for (const auto& [name, ns] : m.stages)
    out += fmt::format("    {:<12} {:>10.2f} us {:>6.1f} %\n", name, ns / 1e3, 100 * ns / sum);
  return out;
}

std::string title(const Measurement& m, const harness::Style& style) {
  return fmt::format("{}  {} bodies, {} shapes, {} joints; {} steps{}\n",
                     style.paint(m.scene->name, Ink::Bold), m.asked.bodies, m.asked.shapes, m.asked.joints,
                     m.steps, m.continuous ? "" : "; continuous collision off");
}

}  // namespace

const Measurement* yardstick_of(std::span<const Measurement> all, const Scene& scene) {
  for (const char* name : kYardsticks)
    for (const Measurement& m : all)
      if (m.engine->name == name && m.scene->name == scene.name && worked(m)) return &m;
  return nullptr;
}

std::string table(std::span<const Measurement> row, const harness::Style& style) {
  const auto first = std::ranges::find_if(row, worked);
  std::string out =
      first == row.end() ? style.paint(row.front().scene->name, Ink::Bold) + "\n" : title(*first, style);
  const Measurement* yardstick = yardstick_of(row, *row.front().scene);
  std::size_t names = 8;
  for (const Measurement& m : row) names = std::max(names, m.engine->name.size());
  const int indent = static_cast<int>(names) + 2;
  std::vector<std::string> lines(row.size() + 1, std::string(names + 2, ' '));
  for (std::size_t i = 0; i < row.size(); ++i)
    lines[i + 1] = harness::pad_right("  " + row[i].engine->name, indent);
  for (const Column& column : columns()) {
    if (std::ranges::none_of(row, [&](const Measurement& m) { return worked(m) && column.told(m); }))
      continue;
    std::vector<std::string> cells{column.head};
    for (const Measurement& m : row) cells.push_back(worked(m) ? column.cell(m, yardstick) : "");
    std::size_t width = 0;
    for (const std::string& cell : cells) width = std::max(width, cell.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
      lines[i] += "  " + harness::pad_left(cells[i], static_cast<int>(width));
  }
  out += style.paint(lines[0], Ink::Dim) + "\n";
  for (std::size_t i = 0; i < row.size(); ++i)
    out += (worked(row[i]) ? lines[i + 1]
                           : harness::pad_right("  " + row[i].engine->name, indent + 2) +
                                 style.paint(row[i].failure, Ink::Red)) +
           "\n";
  for (const Measurement& m : row) out += stages_text(m);
  return out + "\n";
}

std::string settings_text(std::span<const Measurement> all, const harness::Style& style) {
  const harness::Environment where = harness::environment();
  std::string out = harness::wrap(fmt::format("{}; {}; {} {}; plumb {} ({})", where.cpu, where.os,
                                              where.compiler, where.flags, where.plumb_version, where.commit),
                                  style.width, 2) +
                    "\n";
  std::vector<std::string> told;
  for (const Measurement& m : all) {
    if (!worked(m) || std::ranges::find(told, m.engine->name) != told.end()) continue;
    told.push_back(m.engine->name);
    std::string line = fmt::format("{} {}:", m.engine->name, m.engine->version);
    for (const auto& [name, value] : m.settings)
      if (name != "continuous" || value == "none") line += fmt::format(" {} {};", name, value);
    line.back() = '.';
    out += harness::wrap(line, style.width, 2) + "\n";
  }
  return out;
}

std::string csv_header() {
  return "scene,engine,version,failure,bodies,shapes,joints,steps,continuous,repetitions,step_ns,step_ns_min,"
         "step_ns_max,cpu_share,speed,touching,near,overlapping,deepest_m,mean_overlap_m,height,worst_joint_"
         "m,mean_"
         "joint_m,"
         "worst_limit_rad,escaped,speed_rms_m_s,speed_max_m_s,kinetic_energy_j,bytes_a_body,allocations_a_"
         "step\n";
}

std::string csv_row(const Measurement& m, const Measurement* yardstick) {
  const std::string start = fmt::format("{},{},{}", m.scene->name, m.engine->name, m.engine->version);
  if (!worked(m)) {
    std::string failure = m.failure;
    std::ranges::replace(failure, '"', '\'');
    return fmt::format("{},\"{}\"{}\n", start, failure, std::string(26, ','));
  }
  const Quality& q = m.quality;
  const auto ratio = speed_ratio(m, yardstick);
  return fmt::format(
      "{},,{},{},{},{},{},{},{:.1f},{:.1f},{:.1f},{:.3f},{},{},{},{},{:.6g},{:.6g},{},{:.6g},{:.6g},{:.6g},"
      "{},{:.6g},{:.6g},{:.6g},{:.1f},{:.4g}\n",
      start, m.asked.bodies, m.asked.shapes, m.asked.joints, m.steps, m.continuous ? "on" : "off",
      m.step_seconds.size(), median(m.step_seconds) * 1e9, least(m) * 1e9, most(m) * 1e9, least_share(m),
      ratio ? fmt::format("{:.4g}", *ratio) : "", m.counted.touching, q.near, q.overlapping, q.deepest,
      q.mean_depth, m.height ? fmt::format("{:.6g}", *m.height) : "", q.worst_joint, q.mean_joint,
      q.worst_limit, m.escaped, m.speed.rms, m.speed.max, q.kinetic_energy, m.bytes_a_body,
      m.allocations_a_step);
}

namespace {

nlohmann::ordered_json quality_json(const Measurement& m) {
  const Quality& q = m.quality;
  nlohmann::ordered_json out{{"touching", m.counted.touching}, {"near", q.near},
                             {"overlapping", q.overlapping},   {"deepest_m", q.deepest},
                             {"mean_overlap_m", q.mean_depth}, {"worst_joint_m", q.worst_joint},
                             {"mean_joint_m", q.mean_joint},   {"worst_limit_rad", q.worst_limit},
                             {"escaped", m.escaped},           {"speed_rms_m_s", m.speed.rms},
                             {"speed_max_m_s", m.speed.max},   {"kinetic_energy_j", q.kinetic_energy}};
  if (m.height) out["height"] = *m.height;
  return out;
}

nlohmann::ordered_json result_json(const Measurement& m, const Measurement* yardstick) {
  nlohmann::ordered_json out{
      {"scene", m.scene->name}, {"engine", m.engine->name}, {"version", m.engine->version}};
  if (!worked(m)) {
    out["failure"] = m.failure;
    return out;
  }
  out["bodies"] = m.asked.bodies;
  out["shapes"] = m.asked.shapes;
  out["joints"] = m.asked.joints;
  out["steps"] = m.steps;
  out["continuous"] = m.continuous;
  out["step_s"] = median(m.step_seconds);
  out["repetitions_s"] = m.step_seconds;
  out["cpu_share"] = m.cpu_share;
  if (const auto ratio = speed_ratio(m, yardstick)) out["speed"] = *ratio;
  out["bytes_a_body"] = m.bytes_a_body;
  out["allocations_a_step"] = m.allocations_a_step;
  out["quality"] = quality_json(m);
  for (const auto& [name, value] : m.settings) out["settings"][name] = value;
  for (const auto& [name, ns] : m.stages) out["stages_ns"][name] = ns;
  return out;
}

}  // namespace

std::string json(std::span<const Measurement> all, const Plan& plan) {
  const harness::Environment where = harness::environment();
  nlohmann::ordered_json out{{"plumb", where.plumb_version},
                             {"commit", where.commit},
                             {"compiler", where.compiler},
                             {"flags", where.flags},
                             {"build_type", where.build_type},
                             {"cpu", where.cpu},
                             {"os", where.os},
                             {"date", where.date},
                             {"dt_s", plan.settings.dt},
                             {"substeps", plan.settings.substeps},
                             {"quick", plan.quick},
                             {"clock", plan.clock == CLOCK_MONOTONIC ? "wall" : "cpu"},
                             {"yardstick", kYardsticks}};
  out["results"] = nlohmann::ordered_json::array();
  for (const Measurement& m : all) out["results"].push_back(result_json(m, yardstick_of(all, *m.scene)));
  return out.dump(2) + "\n";
}

}  // namespace plumb::field
