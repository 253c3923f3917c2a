#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace plumb::harness {

/// Distance of a run from the truth and from the laws of physics: the largest figures over all bodies and
/// every step's sample. Absent if the figure has no meaning for the scene.
struct Metrics {
  std::optional<double> position_error;  ///< m
  std::optional<double> angle_error;     ///< rad
  std::optional<double> velocity_error;  ///< m/s; samples within one dt of an exact impact are left out
  std::optional<double> angular_velocity_error;  ///< rad/s; the same samples are left out
  std::optional<double> energy_drift;            ///< relative to the energy scale; see `EnergyMeter`
  std::optional<double> momentum_drift;          ///< relative to the largest sum of the bodies' |m v|
  std::optional<double> angular_momentum_drift;  ///< relative to the largest sum of the bodies' |L|
  std::optional<double> joint_gap;               ///< m, largest violation of a joint's rigid constraints
  std::optional<double> penetration;             ///< m, deepest penetration of two shapes
  std::optional<double> expected_miss;  ///< largest miss of a case file, in multiples of the tolerance
};

/// A metric by name, for tables and files.
struct MetricField {
  std::string_view name;
  std::string_view unit;  ///< empty: relative
  std::optional<double> Metrics::*value;
  bool against_truth = false;  ///< a distance from the truth, not from a law
};

inline constexpr std::array<MetricField, 10> kMetricFields{{
    {"position_error", "m", &Metrics::position_error, true},
    {"angle_error", "rad", &Metrics::angle_error, true},
    {"velocity_error", "m/s", &Metrics::velocity_error, true},
    {"angular_velocity_error", "rad/s", &Metrics::angular_velocity_error, true},
    {"energy_drift", "", &Metrics::energy_drift},
    {"momentum_drift", "", &Metrics::momentum_drift},
    {"angular_momentum_drift", "", &Metrics::angular_momentum_drift},
    {"joint_gap", "m", &Metrics::joint_gap},
    {"penetration", "m", &Metrics::penetration},
    {"expected_miss", "", &Metrics::expected_miss},
}};

}  // namespace plumb::harness
