#pragma once

#include <string>
#include <vector>

#include "demos/core/demo.h"
#include "demos/window/painter.h"

namespace plumb::window {

/// Another engine's motion, which can be drawn over plumb's.
struct Ghost {
  std::string name;
  bool shown = false;
  std::string remark{};  ///< why it is not there, or what to know about it
};

/// What goes along with a demo: what it is compared with.
class Companion {
 public:
  virtual ~Companion() = default;

  virtual std::string about() const = 0;  ///< a line or two for the panel
  virtual std::vector<demos::Figure> figures(const demos::Demo& demo) = 0;
  virtual const std::vector<Ghost>& ghosts() const = 0;
  virtual void show_ghost(std::size_t ghost, bool shown) = 0;  ///< from the next step or picture on
  virtual void draw(Painter& out, const demos::Demo& demo) = 0;
};

}  // namespace plumb::window
