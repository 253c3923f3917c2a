#include "demos/window/theme.h"

#include <array>

namespace plumb::window {
namespace {

struct Style {
  Paint dark, light;
};

constexpr Colour kNothing{0, 0, 0, 0};

constexpr Paint shape(Colour fill, Colour line) { return {fill, line, 1.4}; }
constexpr Paint line(Colour colour, double width = 1.6) { return {kNothing, colour, width}; }

// In the order of DrawRole.
constexpr std::array<Style, 17> kStyles = {{
    // Static, Kinematic, Awake, Asleep, Sensor
    {shape({62, 70, 82}, {112, 122, 138}), shape({206, 211, 218}, {120, 128, 140})},
    {shape({38, 92, 128}, {94, 170, 214}), shape({170, 208, 236}, {36, 104, 156})},
    {shape({176, 104, 44}, {255, 176, 96}), shape({250, 196, 132}, {176, 92, 20})},
    {shape({74, 78, 110}, {132, 138, 184}), shape({198, 200, 226}, {104, 108, 160})},
    {shape({60, 160, 90, 50}, {90, 200, 120}), shape({60, 160, 90, 45}, {40, 130, 70})},
    // Contact, Normal, Impulse, Box, Centre, JointLine, Name
    {line({255, 82, 82}), line({208, 24, 24})},
    {line({88, 210, 196}), line({0, 128, 116})},
    {line({255, 214, 64}, 2.4), line({200, 120, 0}, 2.4)},
    {line({170, 122, 220, 170}, 1), line({130, 80, 190, 170}, 1)},
    {line({240, 240, 240}, 1.2), line({20, 20, 20}, 1.2)},
    {line({96, 196, 240}), line({0, 112, 160})},
    {line({230, 230, 230}), line({30, 30, 30})},
    // Highlight, Force, Aim, Trail, Velocity
    {shape({246, 210, 60}, {255, 244, 170}), shape({255, 224, 60}, {200, 130, 0})},
    {line({120, 220, 110}, 2.2), line({30, 130, 40}, 2.2)},
    {line({220, 220, 220, 170}, 1.4), line({60, 60, 60, 190}, 1.4)},
    {line({150, 160, 176, 130}, 1.2), line({110, 116, 128, 150}, 1.2)},
    {line({132, 150, 255}, 2.2), line({30, 88, 200}, 2.2)},
}};

// The colour of the truth, then those of the engines.
constexpr std::array<Colour, 12> kGhosts = {{{236, 72, 132},
                                             {72, 176, 240},
                                             {96, 190, 72},
                                             {180, 110, 250},
                                             {226, 140, 20},
                                             {40, 190, 170},
                                             {150, 100, 60},
                                             {120, 130, 250},
                                             {200, 60, 60},
                                             {130, 150, 30},
                                             {220, 90, 220},
                                             {90, 130, 150}}};

}  // namespace

Colour Theme::ground() const { return dark ? Colour{20, 23, 28} : Colour{250, 250, 248}; }
Colour Theme::grid() const { return dark ? Colour{32, 36, 43} : Colour{233, 234, 232}; }
Colour Theme::text() const { return dark ? Colour{220, 224, 230} : Colour{30, 34, 40}; }

Paint Theme::paint(DrawRole role) const {
  const Style& style = kStyles.at(static_cast<std::size_t>(role));
  return dark ? style.dark : style.light;
}

Colour Theme::ghost(int n) const { return kGhosts[static_cast<std::size_t>(n) % kGhosts.size()]; }

}  // namespace plumb::window
