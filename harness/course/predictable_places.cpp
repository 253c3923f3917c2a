#include <fmt/format.h>

#include "harness/course/predictable.h"

// The mistakes of student/misplaced.cpp: each point rotated in each wrong way, each law that changes the
// wrong quantity, and each corner of a box that is used in place of another.
namespace plumb::course {
namespace {

struct Points {
  const char *points, *chapters, *what;
  bool may_stay;  ///< "not rotated" is not in another list
};

constexpr Points kPoints[] = {
    {"a force's point", "4", "the point of a force", false},
    {"a spring's anchors", "4", "a spring's anchors", false},
    {"the point where a circle touches a box", "4", "the point where a circle touches a box", true},
    {"a box", "45", "the sides and corners of a box", true},
    {"a static box", "4", "the sides and corners of static boxes", true},
    {"a box's sides", "45", "the directions of a box's sides", true},
    {"a box's corners", "45", "the corners of a box", true},
    {"a box's extent", "4", "the sides along which a box's extent is taken", false},
    {"a box's extent in the overlap", "4", "the sides along which a box's extent is taken", false},
    {"the axes of two boxes", "4", "the axes along which two boxes are compared", false},
    {"a joint's anchors", "5", "the anchors of a joint", false},
    {"a joint's first anchor", "5", "a joint's anchor on its first body", false},
    {"a joint's second anchor", "5", "a joint's anchor on its second body", false},
};

struct Turn {
  const char *how, *name, *says;
};

constexpr const char* kStay = "not";
constexpr Turn kTurns[] = {
    {kStay, "not_turned", "not with the body"},
    {"by the first angle", "first_angle_kept", "by the angle of the start, so turn them again in each step"},
    {"backwards", "turned_backwards", "against the body, as by minus its angle"},
    {"overwriting x", "turn_overwrites_x",
     "with the new x in the formula of y, so keep the old x until both are known"},
    {"exchanging sin and cos", "sin_and_cos_exchanged", "with sin and cos exchanged"},
    {"without the minus", "turn_sign_lost", "without the minus in x"},
};

struct Law {
  const char *law, *chapters, *what;
};

constexpr Law kLaws[] = {{"gravity", "1", "Gravity"},
                         {"force", "2", "A force"},
                         {"drag", "2", "Drag"},
                         {"spring", "2", "A spring"}};

struct Act {
  const char *how, *name, *says;
};

constexpr Act kActs[] = {
    {"position by dt", "force_moves_position", "moves the body itself"},
    {"position by dt/m", "force_moves_position", "moves the body itself"},
    {"position by dt^2/m", "force_moves_position", "moves the body itself"},
    {"velocity", "force_without_dt", "changes the velocity without dt and without the mass"},
    {"velocity by 1/m", "force_without_dt", "changes the velocity without dt"},
};

constexpr const char* kCorners[] = {"lower left", "lower right", "upper right", "upper left"};

}  // namespace

std::vector<Predictable> mistakes_of_places() {
  std::vector<Predictable> out;
  for (const Points& points : kPoints)
    for (const Turn& turn : kTurns) {
      if (turn.how == kStay && !points.may_stay) continue;
      out.push_back(
          {fmt::format("{}~{}", points.points, turn.how), turn.name, points.chapters,
           fmt::format("Turned wrongly: {}, {}. Turned by the angle a, (x, y) becomes (x cos a - y sin a, "
                       "x sin a + y cos a).",
                       points.what, turn.says),
           true});
    }
  for (const Law& law : kLaws)
    for (const Act& act : kActs)
      out.push_back({fmt::format("{}>{}", law.law, act.how), act.name, law.chapters,
                     fmt::format("{} {}: a step adds F dt/m to the velocity, and v dt to the position.",
                                 law.what, act.says),
                     true});
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      if (i == j) continue;
      out.push_back(
          {fmt::format("corner {} as {}", i, j), "corner_missing", "4",
           fmt::format("A box has three different corners: its {} one is missing, and its {} one is there "
                       "twice. They are at plus and minus half of the width, with plus and minus half of "
                       "the height.",
                       kCorners[i], kCorners[j]),
           true, true});
    }
  return out;
}

}  // namespace plumb::course
