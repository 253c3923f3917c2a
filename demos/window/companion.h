#pragma once

#include <string>
#include <vector>

#include "demos/core/demo.h"
#include "demos/window/painter.h"

namespace plumb::window {

/// Motion of another engine, which can be drawn over plumb's.
struct Ghost {
  std::string name;
  bool shown = false;
  std::string remark{};  ///< the reason for its absence, or a note
};

/// References that a demo is compared with.
class Companion {
 public:
  virtual ~Companion() = default;

  virtual std::string about() const = 0;  ///< one or two lines for the panel
  virtual std::vector<demos::Figure> figures(const demos::Demo& demo) = 0;
  virtual const std::vector<Ghost>& ghosts() const = 0;
  virtual void show_ghost(std::size_t ghost, bool shown) = 0;  ///< takes effect at the next step or picture
  virtual void draw(Painter& out, const demos::Demo& demo) = 0;
};

}  // namespace plumb::window
