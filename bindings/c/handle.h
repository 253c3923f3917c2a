#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bindings/c/include/plumb/plumb.h"
#include "engine/scene/error.h"
#ifndef PLUMB_NO_FILES
#include "engine/world/recorder.h"
#endif
#include "engine/world/world.h"

/// Events in the form of the C interface.
struct plumb_event_arrays {
  std::vector<plumb_touch_event> begin, end;
  std::vector<plumb_hit_event> hits;
  std::vector<plumb_sensor_event> sensor_begin, sensor_end;
  std::vector<plumb_joint> broken;
  std::vector<plumb_body> fell_asleep, woke;
  std::vector<plumb_load_event> loaded;
  std::vector<plumb_quarantine_event> quarantined;
};

/// A world of either precision, recorded or not.
struct plumb_world {
#ifdef PLUMB_NO_FILES
  std::variant<plumb::World, plumb::DoubleWorld> world;
#else
  std::variant<plumb::World, plumb::DoubleWorld, plumb::RecordedWorld<float>, plumb::RecordedWorld<double> >
      world;
#endif
  plumb_event_arrays events{};
  mutable std::vector<plumb_vec2> points{};         ///< of the shape or chain that was read last
  mutable std::vector<plumb_material> materials{};  ///< of that chain
  int moves = 0;                                    ///< how often the world inside took another place
};

namespace plumb::c {

/// Keeps the exception that is being handled as the thread's error.
plumb_status keep_error() noexcept;

/// Runs `body`; no exception leaves.
template <class Function>
plumb_status checked(Function&& body) noexcept {
  try {
    body();
    return PLUMB_OK;
  } catch (...) {
    return keep_error();
  }
}

/// Does the same for a function with a result; `otherwise` is the result of a failure.
template <class Result, class Function>
Result checked_or(Result otherwise, Function&& body) noexcept {
  try {
    return body();
  } catch (...) {
    keep_error();
    return otherwise;
  }
}

/// Throws Error (Value) for a null pointer.
template <class Type>
Type& require(Type* pointer, const char* subject) {
  if (pointer == nullptr) throw Error(Error::Kind::Value, subject, "pointer", "NULL", "must not be NULL");
  return *pointer;
}

/// Calls `body` with the world as `const BasicWorld<Real>&`.
template <class Function>
decltype(auto) read(const plumb_world* world, Function&& body) {
  return std::visit(
      [&]<class Held>(const Held& held) -> decltype(auto) {
        if constexpr (requires { *held; }) {
          return body(*held);
        } else {
          return body(held);
        }
      },
      require(world, "world").world);
}

/// Calls `body` with the world as `BasicWorld<Real>&` or `RecordedWorld<Real>&`.
template <class Function>
decltype(auto) change(plumb_world* world, Function&& body) {
  return std::visit(std::forward<Function>(body), require(world, "world").world);
}

/// Calls `body` with the world as `BasicWorld<Real>&`; a recorded one writes the state after it.
template <class Function>
void edit(plumb_world* world, Function&& body) {
  change(world, [&]<class Held>(Held& held) {
    if constexpr (requires { held.edit(body); }) {
      held.edit(body);
    } else {
      body(held);
    }
  });
}

template <class Function>
plumb_status read_checked(const plumb_world* world, Function&& body) noexcept {
  return checked([&] { read(world, body); });
}
template <class Result, class Function>
Result read_or(Result otherwise, const plumb_world* world, Function&& body) noexcept {
  return checked_or(otherwise, [&]() -> Result { return read(world, body); });
}
template <class Function>
plumb_status change_checked(plumb_world* world, Function&& body) noexcept {
  return checked([&] { change(world, body); });
}

inline plumb_vec2 out(Vec2d v) { return {v.x, v.y}; }
inline Vec2d in(plumb_vec2 v) { return {v.x, v.y}; }
inline plumb_body out(BodyId id) { return {id.index, id.generation}; }
inline plumb_shape out(ShapeId id) { return {id.index, id.generation}; }
inline plumb_joint out(JointId id) { return {id.index, id.generation}; }
inline plumb_chain out(ChainId id) { return {id.index, id.generation}; }
inline BodyId in(plumb_body id) { return {id.index, id.generation}; }
inline ShapeId in(plumb_shape id) { return {id.index, id.generation}; }
inline JointId in(plumb_joint id) { return {id.index, id.generation}; }
inline ChainId in(plumb_chain id) { return {id.index, id.generation}; }

inline plumb_body_state out(const BodyState& s) {
  return {out(s.position), s.angle, out(s.velocity), s.angular_velocity};
}
inline plumb_box_bounds out(const Aabb<double>& box) { return {out(box.lower), out(box.upper)}; }

inline constexpr plumb_body kNoBody{PLUMB_NO_INDEX, 0};
inline constexpr plumb_shape kNoShape{PLUMB_NO_INDEX, 0};
inline constexpr plumb_joint kNoJoint{PLUMB_NO_INDEX, 0};
inline constexpr plumb_chain kNoChain{PLUMB_NO_INDEX, 0};

inline Filter in(const plumb_filter& f) { return {f.category, f.mask, f.group}; }
inline plumb_filter out(const Filter& f) { return {f.category, f.mask, f.group}; }
inline Material in(const plumb_material& m) {
  return {m.friction, m.restitution, m.rolling_resistance, m.surface_speed};
}
inline plumb_material out(const Material& m) {
  return {m.friction, m.restitution, m.rolling_resistance, m.surface_speed};
}

/// Returns an enumerator of the engine for one of the C interface, which has the same order. Throws Error
/// (Value) for a number that is none of `count`.
template <class To, class From>
To in(From value, int count, const char* subject, const char* field) {
  const int number = static_cast<int>(value);
  if (number < 0 || number >= count) {
    throw Error(Error::Kind::Value, subject, field, std::to_string(number),
                "must be one of the enumeration's values, 0 to " + std::to_string(count - 1));
  }
  return static_cast<To>(number);
}

/// Throws Error (Value) for more than `most` elements of an array that a call reads: the number, as of an
/// uninitialised member, is refused before any element is looked at.
inline void require_countable(const char* subject, const char* field, std::size_t count,
                              std::size_t most = PTRDIFF_MAX) {
  if (count <= most) return;
  throw Error(Error::Kind::Value, subject, field, std::to_string(count),
              "must be at most " + std::to_string(most));
}
/// Largest number of shapes, points or hits in one call: indices are of 31 bits.
inline constexpr std::size_t kMostItems = 0x7FFFFFFF;

inline std::vector<Vec2d> in(const plumb_vec2* points, std::size_t count, const char* subject) {
  require_countable(subject, "point_count", count, kMostItems);
  std::vector<Vec2d> all;
  if (count > 0) require(points, "points");
  all.reserve(count);
  for (std::size_t i = 0; i < count; ++i) all.push_back(in(points[i]));
  return all;
}

ShapeGeometry in(const plumb_geometry& geometry);
ShapeDefinition in(const plumb_shape_definition& definition);
plumb_contact out(const ContactReading& reading);
plumb_world_definition out(const WorldDefinition& settings, plumb_precision precision);
plumb_quarantine_event out(const QuarantineEvent& event);

/// Throws Error (Unsupported) for a helper of a world that was moved since: recording moves it.
inline void require_unmoved(const plumb_world& world, int moves, const char* subject) {
  if (world.moves == moves) return;
  throw Error(Error::Kind::Unsupported, subject, "world", "",
              "was recorded since this was created; create it after plumb_world_record");
}

/// Writes the first `capacity` of `all` and returns the number of all.
template <class Type, class From>
std::size_t fill(const std::vector<From>& all, Type* to, std::size_t capacity) {
  const std::size_t count = std::min(all.size(), capacity);
  if (count > 0) require(to, "out");
  for (std::size_t i = 0; i < count; ++i) to[i] = out(all[i]);
  return all.size();
}

/// Writes bytes where there is room for all of them, and returns their number.
std::size_t fill_bytes(const std::vector<std::byte>& bytes, void* to, std::size_t capacity);

}  // namespace plumb::c
