#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bindings/c/include/plumb/plumb.h"

/// Functions called from JavaScript (plumb.memory.mjs), over the C interface. Structures pass as numbers
/// through one buffer, in the order of the structure's members: no layout of memory is known on the other
/// side. Results of several numbers lie in the same buffer.
namespace plumb::javascript {

extern std::vector<double> numbers;
extern std::vector<unsigned char> bytes;

/// Reads the buffer from its start.
class Reader {
 public:
  double number() { return numbers[at_++]; }
  bool flag() { return number() != 0; }
  int integer() { return static_cast<int>(number()); }
  std::uint32_t bits() { return static_cast<std::uint32_t>(number()); }
  std::uint64_t wide() {
    const std::uint64_t low = bits();
    return low | std::uint64_t{bits()} << 32;
  }
  plumb_vec2 point() {
    const double x = number();
    return {x, number()};
  }
  std::vector<plumb_vec2> points() {
    std::vector<plumb_vec2> all(bits());
    for (plumb_vec2& each : all) each = point();
    return all;
  }

 private:
  std::size_t at_ = 0;
};

/// Writes the buffer from its start.
class Writer {
 public:
  Writer() { numbers.clear(); }
  Writer& add(double value) {
    numbers.push_back(value);
    return *this;
  }
  Writer& add(plumb_vec2 v) { return add(v.x).add(v.y); }
  /// Writes 64 bits as two numbers, the low half first.
  Writer& wide(std::uint64_t bits) {
    return add(static_cast<double>(bits & 0xFFFFFFFFu)).add(static_cast<double>(bits >> 32));
  }
  Writer& add(const plumb_filter& f) { return wide(f.category).wide(f.mask).add(f.group); }
  Writer& add(const plumb_material& m) {
    return add(m.friction).add(m.restitution).add(m.rolling_resistance).add(m.surface_speed);
  }
  template <class Handle>
  Writer& ids(const std::vector<Handle>& handles) {
    for (const Handle handle : handles) id(handle);
    return *this;
  }
  template <class Handle>
  Writer& id(Handle handle) {
    return add(handle.index).add(handle.generation);
  }
  double* done() const { return numbers.data(); }
};

plumb_material material(Reader& r);
plumb_filter filter(Reader& r);
/// Reads a geometry; `points` holds the points that it names.
plumb_geometry geometry(Reader& r, std::vector<plumb_vec2>& points);
/// Reads a filter; its condition is asked in JavaScript.
plumb_query_filter query(Reader& r);

/// Returns all elements of one of the interface's functions that fill arrays.
template <class Type, class Fill>
std::vector<Type> all_of(Fill&& fill) {
  std::vector<Type> all(fill(static_cast<Type*>(nullptr), std::size_t{0}));
  fill(all.data(), all.size());
  return all;
}

/// A shape's definition and the points that it names.
struct ShapeInput {
  plumb_shape_definition definition = plumb_default_shape();
  std::vector<plumb_vec2> points;
};
void read(Reader& r, ShapeInput& shape);

}  // namespace plumb::javascript

#define PLUMB_EXPORT(name) __attribute__((export_name(name)))
#define PLUMB_IMPORT(name) __attribute__((import_module("plumb"), import_name(name)))
/// Parameters of a function of a world and a handle.
#define PLUMB_HANDLE plumb_world *w, std::uint32_t index, std::uint32_t generation
