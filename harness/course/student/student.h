#pragma once

#include <memory>
#include <string>

#include "reference/backend.h"

namespace plumb::course {

/// Design of an engine, apart from mistakes; correct engines have different designs.
struct Manner {
  int sweeps = 40;            ///< iterations over joints and contacts, per step
  bool once = false;          ///< contacts are solved once per step
  bool after_move = false;    ///< contacts are found and solved after bodies moved; overlaps are removed
  bool by_positions = false;  ///< joints are closed by positions; velocities from displacements
  double share = 0.5;         ///< fraction of an overlap that a step removes by positions
  bool deep = false;          ///< a circle with its centre inside a box is pushed out at the nearest side
  double slop = 0.001;        ///< m of overlap that is not removed, so that resting bodies stay in contact
  bool clips = false;    ///< boxes touch along the axis of least overlap, at the ends of the clipped side
  bool extends = false;  ///< a side that lies beyond the face's end is extended to it, not dropped
  bool against = false;  ///< the two points of a clipped side are answered from the other end
  bool deepest_first = false;  ///< the deeper of the two points is answered first
  bool turning_push = false;  ///< an overlap is corrected at the point of contact, which turns bodies as well
  double joint_share = 0.5;   ///< fraction of a joint's error that a correction removes
  int corrections = 0;        ///< corrections of joints per step; 0: a quarter of the sweeps
  bool turns = true;          ///< contacts rotate bodies; engines of the first three chapters may not
  bool circles_touch_at_0 = false;  ///< circles are in contact if their distance is exactly 0
  bool boxes_touch_at_0 = false;    ///< the same for boxes
  bool by_rows = false;             ///< a hinge's gap is closed along x, then along y; else along the gap
  bool joints_first = false;        ///< joints are corrected before overlaps
  bool per_point = false;           ///< the points of two boxes share the correction of their overlap
  bool in_turn = false;  ///< each pair's overlap is found when the pairs before it have been corrected
  double fed = 0;        ///< fraction of a joint's error that velocities (not positions) close in a step
};

/// A learner's engine, as the course builds it: circles and boxes, sequential impulses, hinges and sticks. It
/// makes the requested mistake ("" for none); world.cpp has the names. `scheme` is semi-implicit Euler,
/// explicit Euler or velocity Verlet.
std::unique_ptr<reference::Backend> make_student(
    std::string mistake, reference::Scheme scheme = reference::Scheme::SemiImplicitEuler, Manner manner = {});

}  // namespace plumb::course
