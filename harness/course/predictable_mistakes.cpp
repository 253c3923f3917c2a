#include "harness/course/predictable.h"

namespace plumb::course {

std::vector<Predictable> predictable_mistakes() {
  std::vector<Predictable> out = mistakes_of_motion();
  for (const auto& more :
       {mistakes_of_contacts(), mistakes_of_boxes(), mistakes_of_joints(), mistakes_of_kept_joints(),
        mistakes_of_order(), mistakes_of_axes(), mistakes_of_places(), mistakes_of_edits()})
    out.insert(out.end(), more.begin(), more.end());
  return out;
}

std::vector<Scaled> scaled_quantities() {
  return {
      {"gravity", "gravity_wrong", "1", "Gravity acts {} times as strongly as the scene says."},
      {"velocity in the position's change", "move_wrong", "1",
       "Each step moves a body by {} v dt: it should move by v dt."},
      {"restitution", "restitution_wrong", "13",
       "Bounces are those of a restitution {} times that of the scene: after a bounce the speed along the "
       "normal is "
       "-e times the one before."},
      {"impulse of a contact", "impulse_wrong", "134",
       "The impulse of a contact is {} times what it should be: it is -(1 + e) vn/(1/ma + 1/mb), with the "
       "terms of "
       "the spins from chapter 4 on."},
      {"radius", "radius_wrong", "13", "Circles touch as if their radius were {} times that of the scene."},
      {"size of a box", "size_wrong", "1", "Boxes touch as if they were {} times as large as in the scene."},
      {"share of an overlap in the bounce", "correction_adds_energy", "13",
       "An overlap adds speed: {} of it, over dt, is added to the speed at which two part. Correct "
       "positions, and leave "
       "velocities as they are."},
      {"share of an overlap that becomes velocity", "correction_adds_energy", "13",
       "An overlap adds speed: {} of it, over dt, is added to velocities in each step. Correct positions, "
       "and leave "
       "velocities as they are."},
      {"force", "force_wrong", "24",
       "Forces act {} times as strongly as the scene says: a step adds F dt/m."},
      {"drag", "drag_wrong", "2",
       "Drag is {} times what it should be: it is -c v, divided by the mass as any force."},
      {"friction", "friction_wrong", "4",
       "Friction acts with {} times the coefficient that the scene's rule gives: its impulse is at most mu "
       "times the one "
       "along the normal."},
      {"inertia of a box", "inertia_wrong", "45",
       "A box turns as if its inertia were {} times m (w^2 + h^2)/12."},
      {"inertia of a disc", "inertia_wrong", "4", "A disc turns as if its inertia were {} times m r^2/2."},
      {"spin by an impulse", "spin_change_wrong", "45",
       "The spin that an impulse gives is {} times what it should be: w changes by r x j/I."},
      {"torque", "torque_wrong", "4", "Torques act {} times as strongly as the scene says."},
      {"arm of a force", "arm_wrong", "4", "The torque of a force is that of an arm {} times as long."},
      {"spin in the angle's change", "turn_wrong", "4",
       "Each step turns a body by {} w dt: it should turn by w dt."},
      {"impulse of a joint", "joint_impulse_wrong", "5",
       "The impulse of a joint is {} times what it should be: it is -dC/dt over the effective mass."},
      {"length of a stick", "length_wrong", "5", "A stick is held at {} times its length."},
      {"correction of an overlap", "correction_wrong", "134",
       "Corrections of overlaps move bodies by {} of what they should."},
      {"correction of a joint", "joint_correction_wrong", "5",
       "Corrections of a joint's positions move bodies by {} of what they should."},
      {"stiffness of a spring", "stiffness_wrong", "2",
       "Springs are {} times as stiff as the scene says: the force is stiffness (length - rest_length)."},
      {"damping of a spring", "damping_wrong", "2",
       "A spring's damping is {} times what the scene says: it is damping times the speed at which the ends "
       "part."},
      {"rest length of a spring", "rest_length_wrong", "2",
       "A spring is at rest at {} times its rest length: the force is stiffness (length - rest_length)."},
      {"impulse of friction", "friction_impulse_wrong", "4",
       "The impulse of friction is {} times what stops the sliding, before it is limited."},
      {"rotation in an effective mass", "effective_mass_wrong", "45",
       "The effective mass has (r x n)^2/I {} times: it is 1/(1/ma + 1/mb + (ra x n)^2/Ia + (rb x n)^2/Ib)."},
      {"w x r", "point_velocity_wrong", "45",
       "The velocity of a point has w x r {} times: it is v + w x r, with w in radians a second."},
      {"angle of a point", "turned_wrong", "45",
       "Points turn with {} times the body's angle: cos and sin take the angle in radians."},
      {"width of a face", "clipped_wrong", "4",
       "The side that touches is clipped at {} times the half width of the face: it reaches half of the "
       "width to "
       "each side of the box's centre."},
      {"share of a joint's error without dt", "bias_without_dt", "5",
       "Velocities close a joint as if {} of its error were a speed: a share s of the error C is closed in a "
       "step by the speed s C/h."},
  };
}

}  // namespace plumb::course
